// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The keys of [output] that add files or change how /spins is stored.
#include "program_test.hpp"

#include <algorithm>

namespace cayspin::program::test {
namespace {

using OutputFiles = ProgramTest;

TEST_F(OutputFiles, StandBesideTheTrajectoryWhenAskedFor) {
  run(chain_scene());
  EXPECT_FALSE(exists("out.xdmf"));
  EXPECT_FALSE(exists("out.txt"));
  run(chain_scene(), set("output.xdmf=true", "output.table=true", "lattice.spacing=[0.5,2.0]",
                         "output.scalars_every=1"));
  EXPECT_TRUE(contains_all(text_of("out.xdmf"),
                           {"frame 3", "Dimensions=\"1 3 20\"", ">1 2 0.5<", "out.h5:/spins"}));
  EXPECT_EQ(std::ranges::count(text_of("out.txt"), '\n'), 27);
}

// /dev/full represents a full disk.
TEST_F(OutputFiles, StandardOutputThatCannotBeWrittenIsAnError) {
  run(chain_scene());
  for (std::string const command :
       {"check chain.toml", "check chain.toml --json", "info out.h5", "info out.h5 --json",
        "methods", "methods --json", "export out.h5 --ovf frames"}) {
    expect_status(2, {"-c", "exec '" CAYSPIN_PROGRAM "' " + command + " > /dev/full"},
                  {.program = "/bin/sh"});
  }
}

TEST_F(OutputFiles, AreKeptUnlessOverwritten) {
  write("chain.txt", "kept");
  expect_refused({"run", "chain.toml", "--quiet", "--set", "output.table=true"},
                 "chain.txt: cannot write the file: it exists");
  EXPECT_EQ(text_of("chain.txt"), "kept");
  EXPECT_FALSE(exists("chain.h5"));
}

TEST_F(OutputFiles, CompressionChangesNoBit) {
  Arguments const lattice = set("lattice.shape=[32,32,8]", "initial.random.seed=4");
  auto const size = [&](Arguments const& more) {
    run(chain_scene(), joined(more, lattice));
    return std::pair{std::filesystem::file_size(in_folder("out.h5")), last_spins("out.h5")};
  };
  auto const plain = size({});
  auto const compressed = size(set("output.compression=9", "output.chunk=2"));
  EXPECT_EQ(compressed.second, plain.second);
  EXPECT_LT(compressed.first, plain.first);
}

TEST_F(OutputFiles, AreNamedByCheck) {
  auto const output =
      output_of(joined({"check", "chain.toml"}, set("output.xdmf=true", "output.table=true",
                                                    "output.compression=3", "output.sync=true")));
  EXPECT_TRUE(contains(output,
                       "to chain.h5, compressed at level 3, described by an XDMF file, samples "
                       "also in a text table, each frame protected against power cuts"));
}

TEST_F(OutputFiles, ThatAreReadAreNamedByCheck) {
  EXPECT_TRUE(contains(output_of({"check", "chain.toml", "--set", "output.file=chain.toml"}),
                       "as it stands: chain.toml: the command reads it, and would replace it; "));
}

TEST_F(OutputFiles, SyncChangesNoBitAndLeavesNoJournal) {
  run(chain_scene());
  auto const plain = last_spins("out.h5");
  run(chain_scene(), set("output.sync=true"));
  EXPECT_EQ(last_spins("out.h5"), plain);
  EXPECT_FALSE(exists("out.h5.journal"));
}

TEST_F(OutputFiles, SyncIsRefusedInASweep) {
  expect_refused({"sweep", "chain.toml", "--over", "system.damping=0.1,0.2", "--set",
                  "output.sync=true", "--output", "swept.h5"},
                 "output.sync: true: a sweep is not protected against power cuts");
}

}  // namespace
}  // namespace cayspin::program::test
