// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin export, and runs that start from what it wrote.
#include "program_test.hpp"

#include <cayspin/io/ovf.hpp>

#include <algorithm>

namespace cayspin::program::test {
namespace {

namespace fs = std::filesystem;

class Exporting : public ProgramTest {
 protected:
  Outcome export_frames(Arguments const& more) const {
    Arguments arguments{"export", "out.h5", "--ovf", "ovf"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(arguments);
  }

  void expect_refused(Arguments const& more, std::string const& part) const {
    auto const outcome = export_frames(more);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(is_one_line(outcome.errors));
    EXPECT_TRUE(contains(outcome.errors, part));
  }

  std::vector<double> frame(std::int64_t number) const {
    auto const spins = read_dataset("out.h5", "/spins");
    auto const size = static_cast<std::ptrdiff_t>(spins.values.size()) / spins.extents.at(0);
    auto const begin = spins.values.begin() + number * size;
    return {begin, begin + size};
  }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(in_folder("ovf")), {}));
  }
};

Arguments const spaced{"--set", "lattice.spacing=[0.5,2.0]"};

TEST_F(Exporting, WritesTheLastFrameWithItsBitsAndMesh) {
  run(chain_scene(), spaced);
  auto const outcome = export_frames({});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors, "");
  EXPECT_EQ(outcome.output, "ovf/out_000003.ovf\n");
  auto const field = io::read_ovf(in_folder("ovf/out_000003.ovf"));
  EXPECT_EQ(field.values, frame(3));
  EXPECT_EQ(field.mesh.nodes, (std::array<std::int64_t, 3>{20, 3, 1}));
  EXPECT_EQ(field.mesh.step, (std::array<double, 3>{0.5, 2, 1}));
  EXPECT_EQ(field.mesh.base, (std::array<double, 3>{0.25, 1, 0.5}));
  EXPECT_EQ(field.description.at(0), "Total simulation time: 0.5");
  EXPECT_EQ(field.description.at(1), "Step: 25");
  EXPECT_EQ(files(), 1U);
}

TEST_F(Exporting, WritesAllFramesOrOne) {
  run(chain_scene());
  EXPECT_EQ(export_frames({"--frames", "all", "--format", "text"}).output,
            "ovf/out_000000.ovf to ovf/out_000003.ovf: 4 files\n");
  for (std::int64_t number = 0; number < 4; ++number)
    EXPECT_EQ(io::read_ovf(in_folder("ovf/out_00000" + std::to_string(number) + ".ovf")).values,
              frame(number));
  EXPECT_EQ(export_frames({"--frames", "1", "--overwrite", "--format", "binary4"}).output,
            "ovf/out_000001.ovf\n");
  auto single = frame(1);
  for (auto& value : single) value = static_cast<float>(value);
  EXPECT_EQ(io::read_ovf(in_folder("ovf/out_000001.ovf")).values, single);
}

TEST_F(Exporting, SinglePrecisionKeepsItsBitsInFourBytes) {
  run(chain_scene(), {"--precision", "single"});
  export_frames({});
  auto const path = in_folder("ovf/out_000003.ovf");
  EXPECT_EQ(io::read_ovf(path).values, frame(3));
  EXPECT_LT(fs::file_size(path), 60 * 3 * 4 + 1000U);
}

TEST_F(Exporting, ExistingFilesStayUnlessOverwritten) {
  run(chain_scene());
  export_frames({"--frames", "2"});
  expect_refused({"--frames", "all"}, "ovf/out_000002.ovf: it exists");
  EXPECT_EQ(files(), 1U);
  EXPECT_EQ(export_frames({"--frames", "all", "--overwrite"}).status, 0);
  EXPECT_EQ(files(), 4U);
}

TEST_F(Exporting, WrongUsesAreOneLine) {
  run(chain_scene());
  for (std::string const wrong : {"4", "-1", "first", "1.5"})
    expect_refused({"--frames=" + wrong}, "accepted: last, all, or 0 to 3");
  expect_refused({"--format", "binary"}, "accepted: text, binary4, binary8");
  EXPECT_FALSE(fs::exists(in_folder("ovf")));
  write("ovf", "a file");
  expect_refused({}, "ovf: cannot create the folder");
  auto const no_folder = start({"export", "out.h5"});
  EXPECT_EQ(no_folder.status, 2);
  EXPECT_TRUE(is_one_line(no_folder.errors));
  EXPECT_TRUE(
      contains(start({"export", "none.h5", "--ovf", "ovf"}).errors, "none.h5: cannot open"));
}

TEST_F(Exporting, FullDiskLeavesNoFile) {
  run(chain_scene());
  auto const outcome = start({"export", "out.h5", "--ovf", "ovf"}, {.file_limit = 1500});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(
      contains(outcome.errors, "ovf/out_000003.ovf: cannot write the file: File too large"));
  EXPECT_EQ(files(), 0U);
}

// The start is normalised whatever file it comes from, so both runs begin with the same bits.
TEST_F(Exporting, RunsFromOvfAreRunsFromTheTrajectory) {
  for (std::string const precision : {"double", "single"}) {
    run(chain_scene(), {"--precision", precision});
    fs::rename(in_folder("out.h5"), in_folder("first.h5"));
    auto const run_from = [&](std::string const& file) {
      run(chain_scene(), {"--precision", precision, "--set", "initial={file='" + file + "'}"});
      return std::pair{frame(0), frame(3)};
    };
    auto const expected = run_from("first.h5");
    for (std::string const format : {"text", "binary8"}) {
      start({"export", "first.h5", "--ovf", ".", "--format", format, "--overwrite"});
      EXPECT_EQ(run_from("first_000003.ovf"), expected) << precision << " " << format;
    }
  }
}

TEST_F(Exporting, OvfOfAnotherLatticeIsRefusedAtItsKey) {
  run(chain_scene());
  export_frames({});
  auto const outcome = start({"check", "scene.toml", "--set", "initial={file='ovf/out_000003.ovf'}",
                              "--set", "lattice.shape=[20,4]"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors,
                       "initial.file: ovf/out_000003.ovf: its mesh has 20 x 3 x 1 "
                       "nodes; accepted: 20 x 4 x 1, the lattice's"));
}

}  // namespace
}  // namespace cayspin::program::test
