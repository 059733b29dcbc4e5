// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin sweep: all combinations are in one file, however often the sweep was interrupted.
#include "io/sweep.hpp"
#include "program_test.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace cayspin::program::test {
namespace {

namespace fs = std::filesystem;

class Sweeping : public ProgramTest {
 protected:
  static Arguments sweep_into(char const* file, Arguments const& more) {
    return joined({"sweep", "chain.toml", "--output", file}, more);
  }
  /// Returns arguments for six runs.
  static Arguments arguments(char const* file, Arguments const& more = {}) {
    return joined(sweep_into(file, {"--over", "system.damping=0.1,0.3", "--over",
                                    "field.applied=[0.3,-0.2,0.1],[0,0,0.5],['0.1*cos(t)',0,0]"}),
                  more);
  }
  io::SweepInfo sweep_in(char const* file) const { return io::read_sweep(in_folder(file)); }

  std::vector<double> spins(char const* file, std::int64_t run) const {
    return read_dataset(file, "/runs/" + io::swept_run_name(run) + "/spins").values;
  }
};

TEST_F(Sweeping, RunsEveryCombination) {
  EXPECT_TRUE(contains_all(output_of(arguments("all.h5", {"--jobs", "1", "--threads", "1"})),
                           {"6 of 6  run 0005", "all.h5: 6 runs"}));
  EXPECT_FALSE(exists("all.h5.runs"));
  auto const sweep = sweep_in("all.h5");
  EXPECT_TRUE(sweep.complete);
  EXPECT_TRUE(sweep.one_file);
  ASSERT_EQ(sweep.runs.size(), 6u);
  for (std::int64_t run = 0; run < 6; ++run) {
    Arguments one{"run", "chain.toml", "--quiet", "--overwrite", "--output", "one.h5"};
    for (auto const& override : sweep.header.overrides(run)) one = joined(one, set(override));
    expect_status(0, one);
    EXPECT_EQ(spins("all.h5", run), read_dataset("one.h5", "/spins").values) << run;
    auto const alone = info_of("one.h5");
    auto const& swept = sweep.runs[static_cast<std::size_t>(run)];
    EXPECT_EQ(swept.status, 0);
    EXPECT_EQ(swept.step, 25);
    EXPECT_EQ(swept.time, 0.5);
    EXPECT_EQ(swept.scalars.energy, alone.frame_scalars.back().energy);
    EXPECT_EQ(swept.scalars.magnetization, alone.frame_scalars.back().magnetization);
    EXPECT_EQ(swept.cost.evaluations, 100);
    EXPECT_EQ(read_dataset("all.h5", "/parameters/system.damping")
                  .values.at(static_cast<std::size_t>(run)),
              run < 3 ? 0.1 : 0.3);
  }
}

TEST_F(Sweeping, GivesTheSameBitsSideBySide) {
  output_of(arguments("one.h5", {"--jobs", "1", "--quiet"}));
  output_of(arguments("two.h5", {"--jobs", "2", "--quiet", "--threads", "2"}));
  for (std::int64_t run = 0; run < 6; ++run)
    EXPECT_EQ(spins("one.h5", run), spins("two.h5", run)) << run;
}

TEST_F(Sweeping, LeavesNoCheckpoints) {
  output_of(sweep_into("adaptive.h5", {"--quiet", "--over", "integrator.tolerance=1e-4,1e-5",
                                       "--set", "integrator.method='tsit5'"}));
  EXPECT_TRUE(sweep_in("adaptive.h5").complete);
  EXPECT_FALSE(exists("adaptive.h5.runs"));
}

TEST_F(Sweeping, RunsHaveOneThreadInTheSpaceSerial) {
  auto const all = sweep_into("serial.h5", {"--quiet", "--jobs", "1", "--space", another_space,
                                            "--over", "integrator.steps=20,30"});
  if (another_space == "serial") expect_refused(joined(all, {"--threads", "2"}), "--threads 2: ");
  output_of(all);
  EXPECT_TRUE(sweep_in("serial.h5").complete);
}

TEST_F(Sweeping, GoesOnAfterAKill) {
  // The runs with 200000 and 200001 steps take so long that the kill comes during one of them.
  auto const all = [](char const* file) {
    return sweep_into(
        file, {"--jobs", "2", "--over", "integrator.steps=20,30,200000,200001", "--threads", "1",
               "--set", "output.every=500000", "--precision", "single"});
  };
  auto const file = in_folder("killed.h5");
  auto const sweep_process = begin(all("killed.h5"));
  EXPECT_TRUE(eventually([&] {
    return fs::exists(io::swept_run_file(file, 2)) && fs::exists(io::swept_run_file(file, 3));
  }));
  EXPECT_EQ(end(sweep_process, SIGKILL), 128 + SIGKILL) << "it ended before it was killed";
  auto const torn = io::read_sweep(file);  // the index is readable
  EXPECT_FALSE(torn.complete);
  auto const early = io::read_info(io::swept_run_file(file, 0)).cost.wall_seconds;
  EXPECT_GT(early, 0);
  expect_refused(all("killed.h5.runs/none/killed.h5"), "does not exist");

  std::ofstream(io::swept_run_file(file, 0).string() + ".trial") << "left by a kill";
  // The sweep continues even if a reader has the file open.
  hid_t const reader = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  auto const output = output_of(all("killed.h5"));
  H5Fclose(reader);
  EXPECT_TRUE(contains(output, "1 of 2  run 000"));
  output_of(all("whole.h5"));
  auto const sweep = io::read_sweep(file);
  EXPECT_TRUE(sweep.complete);
  EXPECT_EQ(sweep.runs[0].cost.wall_seconds, early) << "it ran again";
  for (std::int64_t run = 0; run < 4; ++run)
    EXPECT_EQ(spins("killed.h5", run), spins("whole.h5", run)) << run;
  EXPECT_FALSE(exists("killed.h5.runs"));
  EXPECT_FALSE(exists("killed.h5.runs.partial"));
}

// Flips a bit of the last spin in a run's file.
void damage_spins(fs::path const& file, std::vector<double> const& spins) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  std::string const bytes{std::istreambuf_iterator<char>(stream), {}};
  std::string const last(reinterpret_cast<char const*>(&spins.back()), sizeof(double));
  auto const place = bytes.rfind(last);
  ASSERT_NE(place, bytes.npos);
  stream.seekp(static_cast<std::streamoff>(place));
  stream.put(static_cast<char>(bytes[place] ^ 1));
}

TEST_F(Sweeping, RefusesADamagedRunUntilItIsDeleted) {
  auto const all = sweep_into("torn.h5", {"--jobs", "1", "--over", "integrator.steps=20,30,200000",
                                          "--set", "output.every=500000", "--threads", "1"});
  auto const file = in_folder("torn.h5");
  auto const process = begin(all);
  EXPECT_TRUE(eventually([&] { return fs::exists(io::swept_run_file(file, 2)); }));
  EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
  auto const right = read_dataset("torn.h5.runs/0000.h5", "/spins").values;
  damage_spins(io::swept_run_file(file, 0), right);
  auto const outcome = expect_status(2, all);  // the last run is still performed
  EXPECT_TRUE(contains(outcome.errors, "torn.h5.runs/0000.h5: "));
  EXPECT_TRUE(fs::exists(io::swept_run_file(file, 2)));
  fs::remove(io::swept_run_file(file, 0));
  fs::resize_file(io::swept_run_file(file, 1), 1000);  // a truncated file: the run is repeated
  EXPECT_TRUE(contains(output_of(all), "2 of 2  run 0001"));
  EXPECT_EQ(spins("torn.h5", 0), right);
}

TEST_F(Sweeping, RunsNothingTwice) {
  output_of(arguments("all.h5", {"--quiet"}));
  auto const before = sweep_in("all.h5");
  EXPECT_FALSE(contains(output_of(arguments("all.h5")), " of "));
  auto const after = sweep_in("all.h5");
  for (std::size_t run = 0; run < 6; ++run)
    EXPECT_EQ(after.runs[run].cost.wall_seconds, before.runs[run].cost.wall_seconds);
  output_of(arguments("all.h5", {"--quiet", "--overwrite"}));
  EXPECT_NE(sweep_in("all.h5").runs[0].cost.wall_seconds, before.runs[0].cost.wall_seconds);
}

TEST_F(Sweeping, RecordsARunThatFails) {
  auto const all = sweep_into("failing.h5", {"--over", "integrator.dt=0.02,30.0,0.01", "--set",
                                             "integrator.method='classical_euler'"});
  auto const outcome = expect_status(3, all);
  EXPECT_TRUE(contains_all(outcome.errors, {"1 of 3 runs failed; run 0001, integrator.dt=30.0",
                                            "not finite", "failing.h5:/runs/0001"}));
  auto const sweep = sweep_in("failing.h5");
  EXPECT_TRUE(sweep.complete);
  EXPECT_EQ(sweep.runs[0].status, 0);
  EXPECT_EQ(sweep.runs[1].status, 3);
  EXPECT_TRUE(contains(sweep.runs[1].message, "not finite"));
  EXPECT_TRUE(sweep.runs[1].has_file);
  EXPECT_EQ(sweep.runs[2].status, 0);
  auto const again = expect_status(3, all);
  EXPECT_EQ(again.errors, outcome.errors);
  EXPECT_FALSE(contains(again.output, "of 3  run"));
}

// Returns the children of a sweep's process, which perform its runs.
std::vector<pid_t> children_of(pid_t process) {
  std::ifstream list(fmt::format("/proc/{0}/task/{0}/children", process));
  return {std::istream_iterator<pid_t>(list), {}};
}

TEST_F(Sweeping, GoesOnWithTheOtherRunsWhenOneCrashes) {
  auto const all =
      sweep_into("crashed.h5", {"--jobs", "1", "--over", "integrator.steps=20,1000000000,30"});
  auto const file = in_folder("crashed.h5");
  auto const process = begin(all);
  EXPECT_TRUE(eventually([&] { return fs::exists(io::swept_run_file(file, 1)); }));
  auto const children = children_of(process);
  ASSERT_EQ(children.size(), 1u);
  ::kill(children[0], SIGKILL);
  EXPECT_EQ(end(process, 0), 2);
  auto const sweep = sweep_in("crashed.h5");
  EXPECT_EQ(sweep.runs[0].status, 0);
  EXPECT_EQ(sweep.runs[1].status, 128 + SIGKILL);
  EXPECT_EQ(sweep.runs[2].status, 0);
  output_of(sweep_into("whole.h5", {"--jobs", "1", "--over", "integrator.steps=20,30"}));
  EXPECT_EQ(spins("crashed.h5", 2), spins("whole.h5", 1));
}

TEST_F(Sweeping, AnInterruptKeepsWhatIsDone) {
  auto const all =
      sweep_into("stopped.h5", {"--jobs", "1", "--over", "integrator.steps=10,1000000000,12"});
  auto const outcome = expect_status(
      130, all,
      {.interrupt_after = 0.1, .interrupt_when = io::swept_run_file(in_folder("stopped.h5"), 1)});
  EXPECT_TRUE(contains(outcome.errors, "interrupted with 2 of 3 runs to do"));
  EXPECT_FALSE(exists("stopped.h5.runs.partial"));
  auto const sweep = sweep_in("stopped.h5");
  EXPECT_FALSE(sweep.complete);
  EXPECT_EQ(sweep.runs[0].status, 0);
  EXPECT_EQ(sweep.runs[1].status, io::SweptRun::not_run);
  EXPECT_EQ(spins("stopped.h5", 0).size(), 2u * 3 * 20 * 3);  // by the link in the sweep's file
  EXPECT_TRUE(contains(output_of({"info", "stopped.h5"}), "open"));
}

TEST_F(Sweeping, TooManyJobsDestroyNothing) {
  output_of(arguments("all.h5", {"--quiet"}));
  auto const before = text_of("all.h5");
  Arguments const large{"--jobs", "65536", "--set", "lattice.shape=[64,64,64]"};
  expect_refused(
      sweep_into("all.h5", joined({"--overwrite", "--over", "system.damping=0.1,0.2"}, large)),
      "--jobs 65536");
  EXPECT_EQ(text_of("all.h5"), before);
  expect_refused(sweep_into("none.h5", joined({"--over", "system.damping=0.1,0.2"}, large)),
                 "--jobs 65536");
  EXPECT_FALSE(exists("none.h5"));
}

TEST_F(Sweeping, RunsStayIfTheFileOfTheirSweepIsGone) {
  auto const all =
      sweep_into("moved.h5", {"--jobs", "1", "--over", "integrator.steps=10,1000000000"});
  auto const run = io::swept_run_file(in_folder("moved.h5"), 0);
  auto const next = io::swept_run_file(in_folder("moved.h5"), 1);
  expect_status(130, all, {.interrupt_after = 0.1, .interrupt_when = next});
  auto const before = io::read_info(run).cost.wall_seconds;
  fs::rename(in_folder("moved.h5"), in_folder("kept.h5"));
  expect_refused(all, "moved.h5.runs has the runs of a sweep whose file is not there");
  EXPECT_EQ(io::read_info(run).cost.wall_seconds, before);
  EXPECT_FALSE(exists("moved.h5"));
}

TEST_F(Sweeping, AnInterruptSaysHowToContinue) {
  auto const all = sweep_into(
      "again.h5", {"--jobs", "1", "--overwrite", "--over", "integrator.steps=10,1000000000"});
  auto const outcome = expect_status(
      130, all,
      {.interrupt_after = 0.1, .interrupt_when = io::swept_run_file(in_folder("again.h5"), 1)});
  EXPECT_TRUE(contains(outcome.errors, "the same command without --overwrite continues it"));
}

TEST_F(Sweeping, TakesWordsWithoutQuotes) {
  output_of(sweep_into("words.h5", {"--quiet", "--over", "integrator.method=heun,rkmk4"}));
  EXPECT_EQ(sweep_in("words.h5").header.overrides(0),
            std::vector<std::string>{"integrator.method=\"heun\""});
  EXPECT_NE(spins("words.h5", 0), spins("words.h5", 1));
  // Words in quotes give the same sweep, so nothing runs again.
  output_of(sweep_into("words.h5", {"--quiet", "--over", "integrator.method=\"heun\",\"rkmk4\""}));
}

TEST_F(Sweeping, FullDiskLeavesNoFolder) {
  expect_refused(arguments("full.h5"), "full.h5", {.file_limit = 1000});
  EXPECT_FALSE(exists("full.h5"));
  EXPECT_FALSE(exists("full.h5.runs"));
}

TEST_F(Sweeping, AnotherSweepInTheFileIsRefused) {
  output_of(arguments("all.h5", {"--quiet"}));
  expect_refused(arguments("all.h5", {"--over", "output.every=1,2"}), "it has a sweep over");
  expect_refused(arguments("all.h5", {"--precision", "single"}), "in double precision");
  expect_refused(arguments("all.h5", set("integrator.dt=0.01")), "of another scene");
  std::string const many = "integrator.steps=1,2,3,4,5,6,7,8,9,10,11,12";
  output_of(sweep_into("many.h5", {"--quiet", "--over", many}));
  expect_refused(sweep_into("many.h5", {"--over", many + ",13"}),
                 "it has a sweep over integrator.steps=1,2,3,..,12 (12 values); accepted: ");
  expect_refused(sweep_into("many.h5", {"--over", "integrator.steps=1,2,3,4,5,6,7,8,9,10,12"}),
                 "integrator.steps=1,2,3,..,12 (12 values)");
  write("text.h5", "precious");
  expect_refused(arguments("text.h5"), "text.h5");
  run(chain_scene());
  expect_refused(arguments("out.h5"), "it exists and is not the file of a sweep");
}

#ifdef CAYSPIN_NO_LOCKS
TEST_F(Sweeping, SaysThatAFolderCannotBeLocked) {
  ::setenv("LD_PRELOAD", CAYSPIN_NO_LOCKS, 1);
  auto const outcome = start(arguments("free.h5", {"--quiet"}));
  ::unsetenv("LD_PRELOAD");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
  EXPECT_TRUE(contains(outcome.errors, "free.h5.runs: the folder cannot be locked ("))
      << outcome.errors;
  EXPECT_TRUE(sweep_in("free.h5").complete);
}
#endif

TEST_F(Sweeping, OnlyOneProcessHasAFile) {
  auto const all = sweep_into("busy.h5", {"--jobs", "1", "--over", "integrator.steps=1000000000"});
  write("busy.h5.runs.partial", "left by a kill");
  auto const first = begin(all);
  EXPECT_TRUE(eventually([&] { return fs::exists(io::swept_run_file(in_folder("busy.h5"), 0)); }));
  EXPECT_FALSE(exists("busy.h5.runs.partial"));
  expect_refused(all, "another sweep is writing it");
  expect_refused(joined(all, {"--overwrite"}), "another sweep is writing it");
  EXPECT_EQ(end(first, SIGTERM), 130);

  auto const run = begin({"run", "chain.toml", "--quiet", "--output", "run.h5", "--set",
                          "integrator.steps=1000000000"});
  EXPECT_TRUE(eventually([&] { return start({"info", "run.h5"}).status == 0; }));
  expect_refused(sweep_into("run.h5", {"--overwrite", "--over", "integrator.steps=1"}),
                 "another program is writing it");
  end(run, SIGKILL);
}

TEST_F(Sweeping, StagesWithOtherTermsAreRefused) {
  write("chain.toml", chain_scene() + "[[stage]]\nfield.dmi = { bulk = 0.1 }\n");
  expect_refused(
      sweep_into("terms.h5", {"--over", "system.damping=0.1,0.2", "--set", "output.terms=true"}),
      "field: has different terms from those at the start");
  EXPECT_FALSE(exists("terms.h5.runs"));
}

TEST_F(Sweeping, WrongUsesAreOneLine) {
  for (auto const& [more, part] : std::vector<std::pair<Arguments, std::string>>{
           {{}, "--over"},
           {{"--over", "system.damping"}, "not a key with values"},
           {{"--over", " =0.1,0.2"}, "--over  =0.1,0.2: not a key with values; accepted: "},
           {{"--over", "system.damping="}, "not a list of values"},
           {{"--over", "field.applied=[0,0,1],[0,0"}, "not TOML"},
           {{"--over", "system.damping=0.1,0.1"}, "stands twice"},
           {{"--over", "system.dampng=0.1,0.2"}, "did you mean"},
           {{"--over", "system.dampng=0.1"},
            "--over system.dampng=0.1: system.dampng: unknown key"},
           {{"--over", "foo=1,2"}, "with foo=1: --over foo=1: foo: unknown key"},
           {{"--over", "system.damping=0.1", "--set", "foo=1"}, "--set foo=1: foo: unknown key"},
           {{"--over", "system.damping=0.1,-0.2", "--over", "integrator.dt=0.02,0.01"},
            "with system.damping=-0.2 integrator.dt=0.02: "},
           {{"--over", "system.damping=0.1", "--over", "system.damping=0.2"}, "twice"},
           {{"--over", "system.damping=0.1", "--set", "system.damping=0.2"}, "--set"},
           {{"--over", "system.damping=0.1", "--set", "system.damping = 0.2"}, "--set"},
           {{"--over", "system.damping=0.1", "--set", "system={kind='llg',damping=0.2}"}, "--set"},
           {{"--over", "integrator={method='heun',dt=0.02,steps=1}", "--set", "integrator.dt=0.1"},
            "--set"},
           {{"--over", "integrator.dt=0.02", "--over",
             "integrator={method='heun',dt=0.01,steps=1}"},
            "--over integrator.dt has it too"},
           {{"--over", "'system'.damping=0.1", "--set", "system.damping=0.2"}, "--set has it too"},
           {{"--over", "field.applied.02=0,1", "--set", "field.applied.2=1"}, "--set has it too"},
           {{"--over", "output.file='a.h5','b.h5'"}, "output.file"},
           {{"--over", "\"output\".file='a.h5','b.h5'"}, "all runs go into the file"},
           {{"--over", "system.damping=0.1", "--set", "output.xdmf=true"},
            "output.xdmf: true: a sweep writes one file"},
           {{"--over", "output.table=false,true"}, "output.table: true: a sweep writes one file"},
           {{"--over", "system.damping=0.1", "--space", "serial", "--threads", "2"},
            "--space serial"},
           {{"--over", "system.damping=0.1", "--jobs", "0"}, "--jobs"}})
    expect_refused(sweep_into("wrong.h5", more), part);
  EXPECT_FALSE(exists("wrong.h5"));
  EXPECT_FALSE(exists("wrong.h5.runs"));
}

}  // namespace
}  // namespace cayspin::program::test
