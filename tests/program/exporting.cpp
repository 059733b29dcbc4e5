// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin export, and runs that start from its files.
#include "io/ovf.hpp"
#include "program_test.hpp"

#include <algorithm>
#include <utility>

namespace cayspin::program::test {
namespace {

namespace fs = std::filesystem;

class Exporting : public ProgramTest {
 protected:
  Arguments const to_ovf{"export", "out.h5", "--ovf", "ovf"};

  /// Returns the program's output.
  std::string export_frames(Arguments const& more) const { return output_of(joined(to_ovf, more)); }

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

TEST_F(Exporting, WritesTheLastFrameWithItsBitsAndMesh) {
  run(chain_scene(), set("lattice.spacing=[0.5,2.0]"));
  EXPECT_EQ(export_frames({}), "ovf/out_000003.ovf\n");
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
  EXPECT_EQ(export_frames({"--frames", "all", "--format", "text"}),
            "ovf/out_000000.ovf to ovf/out_000003.ovf: 4 files\n");
  for (std::int64_t number = 0; number < 4; ++number)
    EXPECT_EQ(io::read_ovf(in_folder("ovf/out_00000" + std::to_string(number) + ".ovf")).values,
              frame(number));
  EXPECT_EQ(export_frames({"--frames", "1", "--overwrite", "--format", "binary4"}),
            "ovf/out_000001.ovf\n");
  auto single = frame(1);
  for (auto& value : single) value = static_cast<float>(value);
  EXPECT_EQ(io::read_ovf(in_folder("ovf/out_000001.ovf")).values, single);
}

TEST_F(Exporting, CountsFramesFromTheEnd) {
  run(chain_scene());
  EXPECT_EQ(export_frames({"--frames=-1"}), "ovf/out_000003.ovf\n");
  EXPECT_EQ(export_frames({"--frames", "-4"}), "ovf/out_000000.ovf\n");
  EXPECT_EQ(io::read_ovf(in_folder("ovf/out_000000.ovf")).values, frame(0));
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
  expect_refused(joined(to_ovf, {"--frames", "all"}), "ovf/out_000002.ovf: it exists");
  EXPECT_EQ(files(), 1U);
  export_frames({"--frames", "all", "--overwrite"});
  EXPECT_EQ(files(), 4U);
}

TEST_F(Exporting, WrongUsesAreOneLine) {
  run(chain_scene());
  for (std::string const wrong : {"4", "-5", "first", "1.5"})
    expect_refused(joined(to_ovf, {"--frames=" + wrong}),
                   "accepted: last, all, 0 to 3, or -1 to -4 from the end of out.h5");
  expect_refused(joined(to_ovf, {"--format", "binary"}), "accepted: text, binary4, binary8");
  EXPECT_FALSE(exists("ovf"));
  write("ovf", "a file");
  expect_refused(to_ovf, "ovf: cannot create the folder");
  expect_refused({"export", "out.h5"}, "--ovf");
  expect_refused({"export", "none.h5", "--ovf", "ovf"}, "none.h5: cannot open");
}

TEST_F(Exporting, FilesOfOtherKindsAreNamed) {
  auto const refused = [&](std::string const& file, std::string const& kind) {
    auto const message = file + ": it is " + kind + "; accepted: the trajectory file of a run";
    expect_refused({"export", file, "--ovf", "ovf"}, message);
    expect_refused({"modes", file, "--output", "new.h5"}, message);
    EXPECT_FALSE(exists("new.h5"));
  };
  auto const not_to_continue = [&](std::string const& file, std::string const& kind) {
    expect_refused({"run", "chain.toml", "--output", "new.h5", "--restart", file},
                   file + ": it is " + kind);
    expect_refused(joined({"run", "chain.toml", "--output", "new.h5", "--restart", file},
                          set("ensemble.replicas=2")),
                   file + ": it is " + kind + "; accepted: the file of an ensemble");
  };
  output_of({"sweep", "chain.toml", "--quiet", "--output", "sweep.h5", "--over",
             "system.damping=0.1,0.2"});
  expect_status(0, joined({"run", "chain.toml", "--quiet", "--output", "ensemble.h5"},
                          set("ensemble.replicas=2")));
  expect_status(0, {"modes", "spin.toml", "--quiet", "--count", "1"});
  for (auto const& [file, kind] :
       {std::pair{"sweep.h5", "the file of a sweep"}, {"modes.h5", "the file of modes"}}) {
    refused(file, kind);
    not_to_continue(file, kind);
  }
  refused("ensemble.h5", "the file of an ensemble");
}

TEST_F(Exporting, FullDiskLeavesNoFile) {
  run(chain_scene());
  expect_refused(to_ovf, "ovf/out_000003.ovf: cannot write the file: File too large",
                 {.file_limit = 1500});
  EXPECT_EQ(files(), 0U);
}

// A start from a file is normalised, whatever the file's format, so both runs start with bitwise
// equal spins.
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
      output_of({"export", "first.h5", "--ovf", ".", "--format", format, "--overwrite"});
      EXPECT_EQ(run_from("first_000003.ovf"), expected) << precision << " " << format;
    }
  }
}

TEST_F(Exporting, OvfOfAnotherLatticeIsRefusedAtItsKey) {
  run(chain_scene());
  export_frames({});
  expect_refused({"check", "scene.toml", "--set", "initial={file='ovf/out_000003.ovf'}", "--set",
                  "lattice.shape=[20,4]"},
                 "initial.file: ovf/out_000003.ovf: its mesh has 20 x 3 x 1 "
                 "nodes; accepted: 20 x 4 x 1, the lattice's");
}

}  // namespace
}  // namespace cayspin::program::test
