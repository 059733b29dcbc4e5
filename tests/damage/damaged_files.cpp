// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Random damage to HDF5 files: each reading ends with a one-line error or returns what was written.
// Files without checksums may give other values. CAYSPIN_DAMAGED_FILES sets the approximate number
// of files of each test, CAYSPIN_SEED the seed.
#include "damaged_bytes.hpp"
#include "inertia_file.hpp"
#include "io/scene.hpp"
#include "support/reads_in_child.hpp"
#include "trajectory/trajectory_test.hpp"

#include <fmt/format.h>

namespace cayspin::inline v0_2::io {
namespace {

using cayspin::test::Chance;
using cayspin::test::damaged;
using cayspin::test::number_from;

std::string const scene_head = R"([lattice]
shape = [4, 3, 2]
[integrator]
method = "rkmk4"
dt = 0.1
steps = 10
)";

// Returns what read_info() reports about a trajectory, as text to compare.
std::string all_of(TrajectoryInfo const& info) {
  auto const& header = info.header;
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {}", info.format, info.complete, info.frames,
                  info.samples, header.scene_text, header.resolved_scene, header.cayspin_version,
                  header.git_commit, header.kokkos_version, header.space, header.threads,
                  header.precision, info.cost.evaluations);
  text += fmt::format(" {} {}", info.cost.wall_seconds, info.cost.step_seconds);
  for (auto const extent : header.shape) text += fmt::format(" {}", extent);
  text += fmt::format(" {}", header.cell_sites);
  text += fmt::format(" {} {} {} {} {}", header.units.si, header.units.time, header.units.length,
                      header.units.field, header.units.energy);
  for (std::size_t i = 0; i < info.frame_steps.size(); ++i) {
    auto const& [energy, defect, m] = info.frame_scalars[i];
    text += fmt::format("\n{} {} {} {} {} {} {}", info.frame_steps[i], info.frame_times[i], energy,
                        defect, m[0], m[1], m[2]);
  }
  for (auto const& mean : info.frame_sublattices)
    text += fmt::format("\n{} {} {}", mean[0], mean[1], mean[2]);
  return text;
}

std::string all_of(std::vector<double> const& values) {
  return {reinterpret_cast<char const*>(values.data()), sizeof(double) * values.size()};
}

std::string all_of(std::vector<InertiaTensor> const& tensors) {
  return {reinterpret_cast<char const*>(tensors.data()), sizeof(InertiaTensor) * tensors.size()};
}

struct Reading {
  char const* name;
  std::string (*read)(std::filesystem::path const&);
};

std::string spins_of_start(std::filesystem::path const& path) {
  std::vector<std::string> overrides;
  if (read_info(path).header.cell_sites == 2)
    overrides = {"lattice.shape=[4, 3, 1]", "lattice.crystal='bcc'"};
  auto const scene = parse_scene("[system]\nkind = \"llg\"\ndamping = 0.1\n" + scene_head +
                                     "[initial]\nfile = \"" + path.string() + "\"\n",
                                 "scene.toml", overrides);
  check_files(scene);
  return all_of(initial_spins(scene));
}

std::string tensors(std::filesystem::path const& path) {
  auto scene = parse_scene("[system]\nkind = \"rigid_body\"\ninertia = { file = \"" +
                               path.string() + "\" }\n" +
                               "[lattice]\nshape = [24]\n[initial]\nuniform = [0, 0, 1]\n"
                               "[integrator]\nmethod = \"rkmk4\"\ndt = 0.1\nsteps = 10\n",
                           "scene.toml");
  check_files(scene);
  return all_of(inertia(scene));
}

constexpr Reading of_trajectories[] = {
    {"info", [](auto const& path) { return all_of(read_info(path)); }},
    {"last spins",
     [](auto const& path) {
       return all_of(read_spins(path, {4, 3, 2}));
     }},
    {"first spins",
     [](auto const& path) {
       return all_of(read_spins(path, {4, 3, 2}, 0));
     }},
    {"initial.file", spins_of_start}};
constexpr Reading of_inertia[] = {{"inertia.file", tensors}};

class Damage : public TrajectoryTest {
 protected:
  void damage(std::filesystem::path const& path, std::span<Reading const> readings, bool checked,
              long files) {
    auto const bytes = read_bytes(path);
    auto const copy = folder_ / "damaged.h5";
    std::vector<std::string> whole;
    for (auto const& reading : readings) whole.push_back(reading.read(path));
    for (long file = 0; file < files; ++file) {
      auto const changed = damaged(bytes, chance_);
      write_bytes(copy, changed);
      for (std::size_t i = 0; i < readings.size(); ++i) {
        auto& counts = counts_[readings[i].name];
        std::string found;
        try {
          found = readings[i].read(copy);
        } catch (std::runtime_error const& error) {
          std::string const message = error.what();
          EXPECT_EQ(message.find('\n'), std::string::npos) << message;
          auto const fault = message.find("it is damaged (reading it");
          ++counts[fault == std::string::npos ? "refused" : message.substr(fault + 15)];
          continue;
        }
        bool const same = found == whole[i];
        ++counts[same ? "right" : checked ? "WRONG" : "changed, without a checksum"];
        if (same || !checked) continue;
        auto const kept = std::filesystem::temp_directory_path() / "cayspin_wrong.h5";
        write_bytes(kept, changed);
        ADD_FAILURE() << readings[i].name << ": file " << file << " of " << path << ", kept as "
                      << kept;
      }
    }
  }

  // Writes a file like those of `run`, with a given layout.
  std::filesystem::path trajectory(std::string const& name, std::string const& precision,
                                   TrajectoryStorage const& storage, int frames,
                                   std::int64_t cell_sites = 1) {
    auto const path = folder_ / name;
    auto header = small_header(precision);
    header.cell_sites = cell_sites;
    TrajectoryFile file(path, header, false, storage);
    for (int frame = 0; frame < frames; ++frame) {
      for (int sample = 0; sample < 3; ++sample)
        file.write_scalars(3 * frame + sample, 0.1 * frame, numbered_scalars(frame));
      if (precision == "double")
        file.write_frame(frame, 0.1 * frame, numbered_scalars(frame),
                         numbered_spins<double>(header, frame).data());
      else
        file.write_frame(frame, 0.1 * frame, numbered_scalars(frame),
                         numbered_spins<float>(header, frame).data());
    }
    file.finish({7, 2, 1});
    return path;
  }

  Chance chance_{static_cast<std::uint64_t>(number_from("CAYSPIN_SEED", 1))};
  long files_ = number_from("CAYSPIN_DAMAGED_FILES", 100);
  cayspin::test::OutcomeCounts counts_;
};

TEST_F(Damage, TrajectoriesAreRefusedOrReadAsTheyWere) {
  damage(trajectory("plain.h5", "double", {}, 5), of_trajectories, true, files_ / 5);
  damage(trajectory("many.h5", "double", {}, 90), of_trajectories, true, files_ / 5);
  damage(trajectory("single.h5", "single", {}, 5), of_trajectories, true, files_ / 5);
  damage(trajectory("packed.h5", "double", {.compression = 6}, 20), of_trajectories, true,
         files_ / 5);
  damage(trajectory("planes.h5", "double", {.chunk = 1}, 5), of_trajectories, true, files_ / 5);
  damage(trajectory("crystal.h5", "double", {}, 5, 2), of_trajectories, true, files_ / 5);
  cayspin::test::print_and_expect_both(counts_);
}

// Without checksums the values may be wrong, but nothing crashes.
TEST_F(Damage, InertiaOfAnotherMakerNeverCrashes) {
  auto const path = folder_ / "inertia.h5";
  cayspin::test::write_inertia(path, 24);
  damage(path, of_inertia, false, files_);
  cayspin::test::print_and_expect_both(counts_);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
