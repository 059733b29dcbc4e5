// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "start_of_modes.hpp"

#include "command.hpp"
#include "file_as_start.hpp"
#include "io/notes.hpp"
#include "io/path.hpp"
#include "io/relax.hpp"
#include "io/trajectory.hpp"
#include "simulation/failure.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

namespace cayspin::program {
namespace {

namespace fs = std::filesystem;

bool is_hdf5(fs::path const& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 8> first{};
  file.read(first.data(), first.size());
  return file && std::string_view(first.data(), first.size()) == "\x89HDF\r\n\x1a\n";
}

/// Parses the scene in a file. Its start is the file, unless the overrides change it.
io::Scene scene_in(fs::path const& file, std::string const& text,
                   std::vector<std::string> const& overrides) {
  std::vector all{as_start(file)};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return io::parse_scene_to_relax(text, file, all);
}

/// Replaces the start of a scene by a state of `file`. `header`: that of the file. `read`: returns
/// the spins.
template <class Read>
void start_at(io::Scene& scene, fs::path const& file, io::TrajectoryHeader const& header,
              Read const& read) {
  auto const* const start = std::get_if<io::FileStart>(&scene.initial);
  if (start == nullptr || start->path != fs::absolute(file))
    throw UsageError("--frame: --set changes the start; accepted: one of them");
  if (scene.lattice.shape != header.shape || std::ssize(scene.lattice.basis) != header.cell_sites)
    throw UsageError(
        fmt::format("{}: its lattice is {}, that of the scene is {}; accepted: the same shape",
                    file.string(), sites_text(header.shape, header.cell_sites),
                    sites_text(scene.lattice.shape, std::ssize(scene.lattice.basis))));
  scene.initial = io::GivenStart{std::make_shared<std::vector<double> const>(read())};
}

/// Returns the number of a frame that --frame names, counted from 0. `count`: the number of frames
/// in the file. `more`: further words that --frame accepts.
std::int64_t number_of(std::string const& text, std::int64_t count, std::string_view more,
                       fs::path const& file) {
  if (text == "last") return count - 1;
  std::int64_t number = 0;
  auto const [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || stop != text.data() + text.size() || number < -count ||
      number >= count)
    throw UsageError(fmt::format(
        "--frame {}: accepted for {}: {}, last{}", text, file.string(),
        count == 1 ? "0" : fmt::format("0 to {}, -1 to -{} from the end", count - 1, count), more));
  return number < 0 ? count + number : number;
}

StartOfModes in_path(fs::path const& file, std::vector<std::string> const& overrides,
                     std::optional<std::string> const& frame) {
  auto const path = io::read_path(file);
  auto const images = std::ssize(path.energy);
  bool const has_saddle = !path.saddles.empty();
  if (!frame)
    throw UsageError(
        fmt::format("{}: it is the file of a path; accepted: --frame with an image, 0 "
                    "to {}{}",
                    file.string(), images - 1, has_saddle ? ", or saddle" : ""));
  StartOfModes start{scene_in(file, path.header.scene_text, overrides)};
  if (*frame == "saddle" && has_saddle) {
    start.is_saddle = true;
    start_at(start.scene, file, path.header, [&] { return io::read_saddle(file, path.header); });
    return start;
  }
  auto const number = number_of(*frame, images, has_saddle ? ", saddle" : "", file);
  start.is_saddle = std::ranges::any_of(
      path.saddles, [&](io::SaddleOfPath const& saddle) { return saddle.image == number; });
  start_at(start.scene, file, path.header,
           [&] { return io::read_spins(file, path.header.shape, number, path.header.cell_sites); });
  return start;
}

StartOfModes in_trajectory(fs::path const& file, std::vector<std::string> const& overrides,
                           std::optional<std::string> const& frame) {
  auto const info = io::read_info(file);
  if (info.frames == 0)
    throw std::runtime_error(fmt::format("{}: it holds no frame", file.string()));
  auto const number = number_of(frame.value_or("last"), info.frames, "", file);
  StartOfModes start{scene_in(file, info.header.scene_text, overrides)};
  auto& scene = start.scene;
  auto const fields = io::fields_in_turn(scene);
  scene.field = fields[std::min(static_cast<std::size_t>(number) + 1, fields.size()) - 1];
  scene.field.applied_in_turn.clear();
  if (frame)
    start_at(scene, file, info.header, [&] {
      return io::read_spins(file, info.header.shape, number, info.header.cell_sites);
    });
  return start;
}

/// Calls work() and returns its result. Errors in the spins of `file`, which scene_in() made the
/// start, name the file as it was typed.
template <class Work>
auto with_typed_name(fs::path const& file, Work const& work) {
  try {
    return work();
  } catch (io::SceneError const& error) {
    auto const fault = fault_of_start(error, file);
    if (!fault) throw;
    throw std::runtime_error(fmt::format("{}: {}", file.string(), *fault));
  }
}

}  // namespace

StartOfModes start_of_modes(fs::path const& file, std::vector<std::string> const& overrides,
                            std::optional<std::string> const& frame) {
  if (is_hdf5(file))
    return io::is_path(file) ? in_path(file, overrides, frame)
                             : in_trajectory(file, overrides, frame);
  StartOfModes start{io::with_shape_of_start(io::read_scene_to_relax(file, overrides))};
  if (frame)
    throw UsageError(
        fmt::format("--frame: {} is a scene; accepted: a trajectory file, or the file of a path",
                    file.string()));
  if (!start.scene.field.applied_in_turn.empty())
    throw io::scene_error(start.scene, "field.applied",
                          "a list of fields has one equilibrium for each field; accepted: three "
                          "numbers, or the file that cayspin relax writes");
  return start;
}

void check_files(io::Scene const& scene, fs::path const& file) {
  with_typed_name(file, [&] { io::check_files(scene); });
}

std::vector<double> start_spins(io::Scene const& scene, fs::path const& file) {
  return with_typed_name(file, [&] { return io::initial_spins(scene); });
}

}  // namespace cayspin::program
