// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Every wrong use and wrong scene gets one line on standard error and status 2, and no file.
#include "../scene/hdf5_file.hpp"
#include "program_test.hpp"

namespace cayspin::program::test {
namespace {

namespace fs = std::filesystem;

struct WrongUse {
  char const* name;
  Arguments arguments;
  char const* named;  // text that the line must contain

  friend std::ostream& operator<<(std::ostream& stream, WrongUse const& use) {
    return stream << use.name;
  }
};

// The arguments are appended to "run chain.toml". tests/scene checks the messages of single keys.
std::vector<WrongUse> wrong_scenes() {
  return {
      {"UnknownKey", set("lattice.spacng=1"), "spacing"},
      {"ZeroSpinSomewhere", set("initial={expression=['i-7','0','0']}"), "initial.expression"},
      {"ShapeBeyondMemory", set("lattice.shape=[100000,100000,10]"), "memory"},
      {"ExpressionWithPole", set("field.applied=['1/(t-0.25)',0,0]"), "field.applied"},
      {"ExchangeThatOverflows", set("field.exchange=1e308"), "field: its largest value is not"},
      {"SpacingThatOverflows", set("lattice.spacing=1e-200"), "a larger lattice.spacing"},
      {"StartFileThatIsNone", set("initial={file='chain.toml'}"),
       "chain.toml: cannot open the file: it is not an HDF5 file"},
      {"BadOverride", set("lattice"), "key.path=VALUE"},
      {"UnknownSpace", {"--space", "abacus"}, another_space.c_str()},
      {"UnknownPrecision", {"--precision", "half"}, "single"},
      {"ZeroThreads", {"--threads", "0"}, "--threads"},
      {"ThreadsNotANumber", {"--threads", "two"}, "--threads"},
      {"TwoThreads", {"--threads", "1", "--threads", "2"}, "--threads: given as 1 and as 2"},
      {"TwoSpaces", {"--space", default_space.c_str(), "--space", "abacus"}, "--space: given as "},
      {"UnknownOption", {"--fast"}, "--fast (see cayspin help run)\n"},
      {"TwoScenes", {"other.toml"}, "other.toml"},
      {"RestartFromNoTrajectory", {"--restart", "small.h5"}, "small.h5"},
      {"MissingFolder", {"--output", "none/out.h5"}, "none"},
      {"OutputIsAFolder",
       {"--output", "."},
       ".: cannot write the file: it exists and is not a regular"},
      {"OutputWithoutName",
       {"--output", ""},
       "cayspin: --output: the file name is empty; accepted: the name of a file\n"},
  };
}

class WrongScene : public ProgramTest, public testing::WithParamInterface<WrongUse> {};

TEST_P(WrongScene, IsOneLineAndStatusTwo) {
  io::test::write_dataset(in_folder("small.h5"), "/spins", {1, 1, 2, 3}, {1, 0, 0, 0, 1, 0});
  expect_refused(joined({"run", "chain.toml"}, GetParam().arguments), GetParam().named);
  EXPECT_FALSE(exists("chain.h5"));
}

INSTANTIATE_TEST_SUITE_P(Program, WrongScene, testing::ValuesIn(wrong_scenes()),
                         [](auto const& use) { return std::string(use.param.name); });

std::vector<WrongUse> wrong_commands() {
  return {
      {"NoCommand", {}, "no command: accepted: run, "},
      {"UnknownCommand", {"simulate", "chain.toml"}, "unknown command simulate: accepted: run, "},
      {"CommandOfOthers", {"gneb", "chain.toml"}, "unknown command gneb, here it is cayspin path"},
      {"HelpForTwo", {"help", "run", "extra"}, "help run extra: accepted: help, help COMMAND"},
      {"NewWithoutName", {"new", "film", "--output", ""}, "--output: the file name is empty"},
      {"ModesWithoutName", {"modes", "chain.toml", "--output", ""}, "--output: the file name is"},
      {"CountOfWaves",
       {"modes", "chain.toml", "--count", "2", "--wave-vector", "0,0,0"},
       "--count excludes --wave-vector"},
      {"ToleranceOfWaves",
       {"modes", "chain.toml", "--tolerance", "1e-8", "--wave-vector", "0,0,0"},
       "--tolerance excludes --wave-vector"},
      {"HessianOfWaves",
       {"modes", "chain.toml", "--hessian", "--wave-vector", "0,0,0"},
       "--hessian excludes --wave-vector"},
      {"PointsWithoutWaves",
       {"modes", "chain.toml", "--points", "4"},
       "--points requires --wave-vector"},
      {"NoScene", {"run"}, "SCENE"},
      {"SceneMissing", {"run", "none.toml"}, "none.toml"},
      {"SceneIsAFolder", {"run", "."}, ".: is a folder"},
      {"SceneIsNotToml", {"run", "broken.toml"}, "broken.toml:2"},
      {"NoOutput", {"run", "spin.toml"}, "--output"},
      {"CheckOfWrongScene", {"check", "chain.toml", "--set", "system.damping=-1"}, "damping"},
      {"CheckWithOutput", {"check", "chain.toml", "--output", "a.h5"}, "--output"},
      {"InfoWithoutFile", {"info"}, "FILE"},
      {"InfoOfMissingFile", {"info", "none.h5"}, "none.h5"},
      {"InfoOfAnotherFile", {"info", "chain.toml"}, "chain.toml"},
      {"InfoOfOtherHdf5", {"info", "small.h5"}, "small.h5"},
      {"TradeInUnknownPrecision", {"trade", "chain.toml", "--precision", "half"}, "single"},
      {"TradeOfNoSeconds",
       {"trade", "chain.toml", "--seconds", "0"},
       "cayspin: --seconds 0; accepted: a number > 0\n"},
      {"AdviseForNoError",
       {"advise", "chain.toml", "--error", "0"},
       "cayspin: --error 0; accepted: a number from 1e-13 to 1\n"},
      {"AdviseForNan", {"advise", "chain.toml", "--error", "nan"}, "--error nan; accepted: "},
      {"AdviseForNoTime",
       {"advise", "chain.toml", "--error", "1e-3", "--budget", "0"},
       "cayspin: --budget 0; accepted: a number of seconds > 0, or "},
      {"AdviseForLessThanNoTime",
       {"advise", "chain.toml", "--error", "1e-3", "--budget", "-2min"},
       "cayspin: --budget -120; accepted: a number of seconds > 0, or "},
      {"MethodsWithArgument", {"methods", "euler"}, "euler"},
  };
}

class WrongCommand : public ProgramTest, public testing::WithParamInterface<WrongUse> {};

TEST_P(WrongCommand, IsOneLineAndStatusTwo) {
  write("broken.toml", "[system]\nkind = \n");
  io::test::write_dataset(in_folder("small.h5"), "/spins", {1, 1, 1, 3}, {1, 0, 0});
  expect_refused(GetParam().arguments, GetParam().named);
}

INSTANTIATE_TEST_SUITE_P(Program, WrongCommand, testing::ValuesIn(wrong_commands()),
                         [](auto const& use) { return std::string(use.param.name); });

#if !defined(CAYSPIN_HOST_DEVICE)  // with it, cayspin-reproduce is not built
INSTANTIATE_TEST_SUITE_P(
    Siblings, WrongCommand,
    testing::Values(WrongUse{"UnknownPartOfThePaper", {"reproduce", "table9"}, "table1"},
                    WrongUse{"UnknownOptionOfReproduce", {"reproduce", "--fast"}, "--fast"}),
    [](auto const& use) { return std::string(use.param.name); });
#endif

using MissingSibling = ProgramTest;

TEST_F(MissingSibling, IsOneLineAndStatusTwo) {
  auto const folder = in_folder("bin");
  fs::create_directory(folder);
  fs::copy_file(CAYSPIN_PROGRAM, folder / "cayspin");
  // The program's shared library, if it has one.
  fs::create_directory_symlink(fs::path(CAYSPIN_PROGRAM).parent_path().parent_path() / "lib",
                               in_folder("lib"));
  expect_refused({"reproduce"}, (folder / "cayspin-reproduce").string(),
                 {.program = folder / "cayspin"});
}

/// Files that a command reads must not be replaced by its output.
struct ReadFiles : ProgramTest {
  void expect_kept(std::string const& file, Arguments const& arguments) const {
    auto const before = text_of(file);
    expect_refused(joined(arguments, {"--overwrite"}),
                   file + ": the command reads it, and would replace it; accepted: another file");
    EXPECT_EQ(text_of(file), before) << file;
  }
};

TEST_F(ReadFiles, AreNotReplacedByTheOutputOfAnyCommand) {
  for (std::string const command : {"run", "relax", "modes"})
    for (std::string const output : {"chain.toml", "./chain.toml"})
      expect_kept("chain.toml", {command, "chain.toml", "--output", output});
  expect_kept("chain.toml", joined({"run", "chain.toml"}, set("output.file='chain.toml'")));
  expect_kept("chain.toml", {"sweep", "chain.toml", "--output", "chain.toml", "--over",
                             "system.damping=0.1,0.2"});
  fs::create_symlink("chain.toml", in_folder("link.toml"));
  expect_kept("chain.toml", {"run", "chain.toml", "--output", "link.toml"});
  EXPECT_TRUE(fs::is_symlink(in_folder("link.toml")));

  run(chain_scene());
  expect_kept("out.h5", {"modes", "out.h5", "--output", "out.h5"});
  Arguments const from_file = set("initial={file='out.h5'}");
  for (std::string const command : {"run", "relax", "modes"})
    expect_kept("out.h5", joined({command, "chain.toml", "--output", "out.h5"}, from_file));
  expect_kept("out.h5", joined({"sweep", "chain.toml", "--output", "out.h5", "--over",
                                "system.damping=0.1,0.2"},
                               from_file));
  expect_kept("out.h5", joined({"run", "chain.toml", "--output", "out.h5"},
                               set("lattice.occupied={file='out.h5'}")));
  expect_kept("out.h5",
              {"run",
               write("stages.toml", chain_scene() + "[[stage]]\n[stage.field]\nexchange = "
                                                    "{ file = 'out.h5' }\n[stage."
                                                    "integrator]\nsteps = 5\n"),
               "--output", "out.h5"});
}

// A run also writes its table, and it begins its output as a .partial file.
TEST_F(ReadFiles, AreNotReplacedByFilesBesideTheOutput) {
  write("chain.txt", chain_scene());
  expect_kept("chain.txt", joined({"run", "chain.txt"}, set("output.table=true")));
  expect_status(0, joined({"run", "chain.txt", "--quiet"}, set("output.table=false")));
  write("chain.h5.partial", chain_scene());
  expect_kept("chain.h5.partial", {"run", "chain.h5.partial", "--output", "chain.h5"});
}

TEST_F(ReadFiles, MayHaveTheOutputBeside) {
  run(chain_scene());
  expect_status(0, joined({"run", "chain.toml", "--quiet", "--output", "new.h5"},
                          set("initial={file='out.h5'}")));
  expect_status(0, joined({"run", "chain.toml", "--quiet", "--overwrite", "--output", "new.h5"},
                          set("initial={file='out.h5'}")));
}

using ExistingOutput = ProgramTest;

TEST_F(ExistingOutput, IsKeptUnlessOverwritten) {
  write("chain.h5", "precious");
  expect_refused({"run", "chain.toml"}, "--overwrite");
  EXPECT_EQ(fs::file_size(in_folder("chain.h5")), 8u);

  output_of({"run", "chain.toml", "--overwrite"});
  EXPECT_EQ(info_of("chain.h5").frames, 4);
}

}  // namespace
}  // namespace cayspin::program::test
