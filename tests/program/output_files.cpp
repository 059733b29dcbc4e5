// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The keys of [output] that add files or change how /spins is stored.
#include "program_test.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace cayspin::program::test {
namespace {

class OutputFiles : public ProgramTest {
 protected:
  std::string text_of(std::string const& name) const {
    std::ifstream stream(in_folder(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(OutputFiles, StandBesideTheTrajectoryWhenAskedFor) {
  run(chain_scene());
  EXPECT_FALSE(std::filesystem::exists(in_folder("out.xdmf")));
  EXPECT_FALSE(std::filesystem::exists(in_folder("out.txt")));
  run(chain_scene(), {"--set", "output.xdmf=true", "--set", "output.table=true", "--set",
                      "lattice.spacing=[0.5,2.0]", "--set", "output.scalars_every=1"});
  auto const xdmf = text_of("out.xdmf");
  for (auto const* const part : {"frame 3", "Dimensions=\"1 3 20\"", ">1 2 0.5<", "out.h5:/spins"})
    EXPECT_TRUE(contains(xdmf, part));
  EXPECT_EQ(std::ranges::count(text_of("out.txt"), '\n'), 27);
}

// A device that takes nothing stands for a disk that is full.
TEST_F(OutputFiles, StandardOutputThatCannotBeWrittenIsAnError) {
  write("chain.toml", chain_scene());
  run(chain_scene());
  for (std::string const command : {"check chain.toml", "check chain.toml --json", "info out.h5",
                                    "methods", "export out.h5 --ovf frames"}) {
    auto const outcome = start({"-c", "exec '" CAYSPIN_PROGRAM "' " + command + " > /dev/full"},
                               {.program = "/bin/sh"});
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_TRUE(is_one_line(outcome.errors)) << command << ": " << outcome.errors;
  }
}

TEST_F(OutputFiles, AreKeptUnlessOverwritten) {
  write("chain.toml", chain_scene());
  write("chain.txt", "kept");
  auto const outcome = start({"run", "chain.toml", "--quiet", "--set", "output.table=true"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "chain.txt: cannot write the file: it exists"));
  EXPECT_EQ(text_of("chain.txt"), "kept");
  EXPECT_FALSE(std::filesystem::exists(in_folder("chain.h5")));
}

TEST_F(OutputFiles, CompressionChangesNoBit) {
  Arguments const lattice{"--set", "lattice.shape=[32,32,8]", "--set", "initial.random.seed=4"};
  auto const size = [&](Arguments more) {
    more.insert(more.end(), lattice.begin(), lattice.end());
    run(chain_scene(), more);
    return std::pair{std::filesystem::file_size(in_folder("out.h5")), last_spins("out.h5")};
  };
  auto const plain = size({});
  auto const compressed = size({"--set", "output.compression=9", "--set", "output.chunk=2"});
  EXPECT_EQ(compressed.second, plain.second);
  EXPECT_LT(compressed.first, plain.first);
}

TEST_F(OutputFiles, AreNamedByCheck) {
  write("chain.toml", chain_scene());
  auto const outcome =
      start({"check", "chain.toml", "--set", "output.xdmf=true", "--set", "output.table=true",
             "--set", "output.compression=3", "--set", "output.sync=true"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.output,
                       "to chain.h5, compressed at level 3, described by an XDMF "
                       "file, samples also in a text table, each frame safe from power cuts"));
}

TEST_F(OutputFiles, SyncChangesNoBitAndLeavesNoJournal) {
  run(chain_scene());
  auto const plain = last_spins("out.h5");
  run(chain_scene(), {"--set", "output.sync=true"});
  EXPECT_EQ(last_spins("out.h5"), plain);
  EXPECT_FALSE(std::filesystem::exists(in_folder("out.h5.journal")));
}

TEST_F(OutputFiles, SyncIsRefusedInASweep) {
  write("chain.toml", chain_scene());
  auto const outcome = start({"sweep", "chain.toml", "--over", "system.damping=0.1,0.2", "--set",
                              "output.sync=true", "--output", "swept.h5"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "output.sync: true: a sweep is not kept from power cuts"));
}

}  // namespace
}  // namespace cayspin::program::test
