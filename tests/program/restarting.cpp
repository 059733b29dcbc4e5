// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// --restart: a run continued from a file equals an uninterrupted run.
#include "io/checkpoint.hpp"
#include "io/scene.hpp"
#include "program_test.hpp"

#include <csignal>
#include <optional>
#include <string>

namespace cayspin::program::test {
namespace {

class Restarting : public ProgramTest {
 protected:
  /// Runs only `steps` of the scene's 25 steps, into `file`.
  void run_to(char const* steps, char const* file, Arguments const& more = {}) const {
    output_of(joined({"run", "chain.toml", "--quiet", "--output", file, "--set",
                      std::string("integrator.steps=") + steps},
                     more));
  }

  static Arguments to_second(Arguments const& more) {
    return joined({"run", "chain.toml", "--quiet", "--output", "second.h5", "--overwrite",
                   "--restart", "first.h5"},
                  more);
  }

  /// Expects success, with a warning that names these keys and ends in `end`.
  void expect_named(Arguments const& more, std::string const& keys,
                    std::string const& end = "") const {
    auto const outcome = start(to_second(more));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "warning: --restart first.h5: these keys differ from its scene: " +
                                  keys + end + "\n");
  }

  void expect_refused(Arguments const& more, std::string const& part,
                      std::string const& output = "second.h5") const {
    ProgramTest::expect_refused(
        joined({"run", "chain.toml", "--quiet", "--output", output, "--restart", "first.h5"}, more),
        part);
    EXPECT_FALSE(exists("second.h5"));
  }
};

TEST_F(Restarting, GivesTheBitsOfARunWithoutABreak) {
  for (std::string const precision : {"double", "single"}) {
    Arguments const same{"--precision", precision, "--overwrite", "--set",
                         "field.applied=['0.3*cos(7*t)','0.1','0.2']"};
    run_to("25", "whole.h5", same);
    run_to("12", "first.h5", same);
    run_to("25", "second.h5", joined(same, {"--restart", "first.h5"}));
    EXPECT_EQ(last_spins("second.h5"), last_spins("whole.h5"));
    auto const info = info_of("second.h5");
    EXPECT_TRUE(info.complete);
    EXPECT_EQ(info.frame_steps, (std::vector<std::int64_t>{12, 20, 25}));
    EXPECT_EQ(info.frame_times.back(), info_of("whole.h5").frame_times.back());
    EXPECT_EQ(info.cost.evaluations, 13 * 4);
  }
}

TEST_F(Restarting, IsRefusedForAnotherStateThanTheScenes) {
  run_to("12", "first.h5");
  expect_refused(set("lattice.shape=[20,4]"), "its lattice is 20 x 3 x 1");
  expect_refused({"--precision", "single"}, "accepted: --precision double");
  expect_refused(set("integrator.dt=0.013"), "its step 12 is at t = 0.24");
  expect_refused(set("integrator.steps=12"), "it ends at step 12, the scene at step 12");
  auto const before = last_spins("first.h5");
  expect_refused({"--overwrite"}, "another file for --output", "first.h5");
  EXPECT_EQ(last_spins("first.h5"), before);
  std::filesystem::remove(in_folder("first.h5"));
  expect_refused({}, "first.h5");
}

// The lattice must be equal, but need not be typed the same way.
TEST_F(Restarting, IsRefusedOnAnotherLattice) {
  run_to("12", "first.h5");
  auto const expect_key = [&](std::string const& change, std::string const& key) {
    expect_refused(set(change), "first.h5: its " + key + " differs from the scene's; accepted: ");
  };
  expect_key("lattice.spacing=2.0", "lattice.spacing");
  expect_key("lattice.spacing=[1.0,1.0000001]", "lattice.spacing");
  expect_key("lattice.boundary=['open','periodic']", "lattice.boundary");
  expect_key("lattice.occupied='i<15'", "lattice.occupied");
  expect_key("lattice.frozen='i==0'", "lattice.frozen");
  expect_key("lattice.moments=[0.5]", "lattice.moments");
  expect_key("lattice.gyromagnetic=[0.5]", "lattice.gyromagnetic");
  // The lattice is typed differently, but is equal.
  output_of(
      to_second(set("lattice={shape=[20,3,1],spacing=[1,1.0,7.5],boundary=['open','open',"
                    "'periodic'],moments=[1.0]}",
                    "integrator.method='rkmk4'")));
}

TEST_F(Restarting, IsRefusedOnAnotherCell) {
  auto const with_cell = [](std::string const& cell) {
    return set("lattice={shape=[6,3],cell=" + cell + ",basis=[[0,0,0],[0.5,0.5,0]]}",
               "field={couplings=[{offset=[1,0,0],J=1.0}]}");
  };
  std::string const square = "[[1,0,0],[0,1,0],[0,0,1]]";
  run_to("12", "first.h5", with_cell(square));
  expect_refused(with_cell("[[1,0,0],[0.5,1,0],[0,0,1]]"), "its lattice.cell differs");
  auto other = with_cell(square);
  expect_refused(joined(other, set("lattice.basis=[[0,0,0],[0.5,0.4,0]]")),
                 "its lattice.basis differs");
  output_of(to_second(other));
}

TEST_F(Restarting, IsRefusedWhereOtherSitesAreVacant) {
  Arguments const some = set("lattice.occupied='i<15'");
  run_to("12", "first.h5", some);
  for (std::string const occupied : {"i<16", "i<14", "i<15 || j==2"})
    expect_refused(set("lattice.occupied='" + occupied + "'"), "its lattice.occupied differs");
  expect_refused({}, "its lattice.occupied differs");
  run_to("25", "whole.h5", some);
  output_of(to_second(set("lattice.occupied='i<=14'")));
  EXPECT_EQ(last_spins("second.h5"), last_spins("whole.h5"));
}

TEST_F(Restarting, NamesWhatElseDiffers) {
  run_to("12", "first.h5");
  expect_named(set("field.applied=[0.1,0,0]"), "field.applied");
  expect_named(set("system.damping=0.3", "field.mu0=1.0"), "field.mu0, system.damping");
  expect_named(set("thermal={temperature=0.01,seed=2}"), "thermal");
  expect_named(set("integrator.dt=0.01"), "integrator.dt");
  EXPECT_EQ(info_of("second.h5").frame_steps.front(), 24);
  expect_named(set("integrator.dt=0.01", "thermal={temperature=0}"), "integrator.dt, thermal");
  // 1.0 equals 1, and keys of [output] and [initial] are not named.
  output_of(to_second(set("field.exchange=1", "output.every=3", "initial={uniform=[0,0,1]}")));
}

// In floating point, the time after 5000002 steps of 0.3 differs in its last bit from the time
// after 15000006 steps of 0.1.
TEST_F(Restarting, AllowsForTheRoundOffOfALongRun) {
  auto const step = [](std::string const& dt, std::string const& steps) {
    return joined(set("integrator={method='euler',dt=" + dt + ",steps=" + steps + "}",
                      "output={every=100000000,scalars_every=100000000}"),
                  {"--quiet", "--overwrite"});
  };
  output_of(joined({"run", "spin.toml", "--output", "first.h5"}, step("0.3", "5000002")));
  auto const outcome =
      start(joined({"run", "spin.toml", "--output", "second.h5", "--restart", "first.h5"},
                   step("0.1", "15000016")));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(info_of("second.h5").frame_steps, (std::vector<std::int64_t>{15000006, 15000016}));
}

TEST_F(Restarting, NamesASeedThatWouldBeEqualAsDouble) {
  run_to("12", "first.h5", set("thermal={temperature=0.01,seed=9007199254740993}"));
  expect_named(set("thermal={temperature=0.01,seed=9007199254740992}"), "thermal.seed");
}

// After a change of the field, what the method remembers (a previous rate, a step length) would be
// wrong, so the method starts afresh.
TEST_F(Restarting, ForgetsTheStepsOfAnotherMotion) {
  for (std::string const method : {"ab2", "dp5"}) {
    SCOPED_TRACE(method);
    Arguments same = set("integrator.method='" + method + "'", "field.applied=[0.3,-0.2,0.1]");
    if (method == "dp5") same = joined(same, set("integrator.tolerance=1e-6"));
    run_to("12", "first.h5", joined(same, {"--overwrite"}));
    auto const other = joined(same, set("field.applied=[3.0,-0.2,0.1]"));
    expect_named(other, "field.applied", "; the method starts anew");
    // Without --restart: the stored state is the start of a new run.
    run_to("13", "third.h5",
           joined(other, joined(set("initial={file='first.h5'}"), {"--overwrite"})));
    auto const one = last_spins("second.h5"), other_one = last_spins("third.h5");
    ASSERT_EQ(one.size(), other_one.size());
    for (std::size_t i = 0; i < one.size(); ++i)
      EXPECT_NEAR(one[i], other_one[i], method == "dp5" ? 1e-6 : 1e-14);
  }
}

/// Settings that make a run remember more than its spins.
std::vector<Arguments> const memories{
    set("integrator.method='ab2'"),
    {"--set", "integrator.compensated=true", "--precision", "single"},
    set("integrator.energy_control=true", "system.damping=0"),
    set("integrator.until_torque=1e-9"),
    set("integrator.method='euler'", "integrator.isotropy='finite_difference_backward'")};

TEST_F(Restarting, GoesOnFromTheCheckpointOfAMethodThatRemembers) {
  for (auto const& memory : memories) {
    SCOPED_TRACE(memory.back());
    auto const with = [&](Arguments const& more) {
      return joined(joined(more, memory), {"--overwrite"});
    };
    run_to("25", "whole.h5", with({"--space", another_space}));
    run_to("12", "first.h5", with({"--threads", "1"}));
    EXPECT_TRUE(exists("first.checkpoint.h5"));
    run_to("25", "second.h5", with({"--threads", "2", "--restart", "first.h5"}));
    EXPECT_EQ(last_spins("second.h5"), last_spins("whole.h5"));
    run_to("25", "third.h5", with({"--restart", "first.checkpoint.h5"}));
    EXPECT_EQ(last_spins("third.h5"), last_spins("whole.h5"));
  }
}

TEST_F(Restarting, NamesKeysThatAreNewToTheRun) {
  run_to("12", "first.h5");
  for (auto const& [setting, key] :
       {std::pair{"integrator.until_torque=1e-9", "integrator.until_torque"},
        std::pair{"lattice.regions='i < 9 ? 0 : 1'", "lattice.regions"}}) {
    auto const outcome = start(to_second({"--set", setting}));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, key)) << outcome.errors;
  }
}

TEST_F(Restarting, NeedsTheCheckpointOfAMethodThatRemembers) {
  Arguments const ab2 = set("integrator.method='ab2'");
  run_to("12", "first.h5", ab2);
  auto const checkpoint = in_folder("first.checkpoint.h5");
  std::filesystem::rename(checkpoint, in_folder("kept.h5"));
  expect_refused(ab2, "first.checkpoint.h5 is not there");
  // A checkpoint of another scene is refused.
  run_to("7", "other.h5", ab2);
  std::filesystem::rename(in_folder("other.checkpoint.h5"), checkpoint);
  expect_refused(ab2, "is of another scene");
  std::filesystem::rename(in_folder("kept.h5"), checkpoint);
  auto const size = std::filesystem::file_size(checkpoint);
  std::filesystem::resize_file(checkpoint, size / 2);
  expect_refused(ab2, "first.checkpoint.h5");
}

TEST_F(Restarting, BeginsAnewByAnotherMethod) {
  run_to("12", "first.h5");
  expect_named(set("integrator.method='ab2'"), "integrator.method", "; the method starts anew");
  run_to("25", "third.h5", set("integrator.method='ab2'", "initial={file='first.h5'}"));
  EXPECT_EQ(info_of("second.h5").frame_steps.front(), 12);
}

TEST_F(Restarting, CheckpointsAreStoredWhereTheyAreNeeded) {
  run_to("12", "first.h5", set("output.checkpoint_every='5 steps'"));
  EXPECT_FALSE(exists("first.checkpoint.h5")) << "the last frame is it";
  run_to("12", "never.h5", set("integrator.method='ab2'", "output.checkpoint_every=0"));
  EXPECT_FALSE(exists("never.checkpoint.h5"));
  // A checkpoint without its trajectory may be replaced.
  run_to("12", "third.h5", set("integrator.method='ab2'"));
  std::filesystem::remove(in_folder("third.h5"));
  ASSERT_TRUE(exists("third.checkpoint.h5"));
  run_to("5", "third.h5", set("integrator.method='ab2'"));
  EXPECT_EQ(io::CheckpointReader(in_folder("third.checkpoint.h5")).header().step, 5);
  write("second.checkpoint.h5", "kept");
  expect_refused({}, "second.checkpoint.h5: cannot write the file: it exists");
}

TEST_F(Restarting, CheckpointsOfTrajectoriesWithOtherEndingsAreSeparate) {
  auto const ab2 = set("integrator.method='ab2'");
  run_to("12", "film_0.5", ab2);
  run_to("5", "film_0.6", ab2);
  EXPECT_EQ(io::CheckpointReader(in_folder("film_0.5.checkpoint.h5")).header().step, 12);
  EXPECT_EQ(io::CheckpointReader(in_folder("film_0.6.checkpoint.h5")).header().step, 5);
}

// The run is killed by SIGKILL, far from its end.
TEST_F(Restarting, GoesOnFromTheCheckpointOfAKilledRun) {
  for (std::string const method : {"rkmk4", "ab2", "dp5"}) {
    SCOPED_TRACE(method);
    std::string const integrator = "integrator={method='" + method + "',dt=0.001,steps=60000";
    auto const run_of = [&](std::string const& file, Arguments const& more = {}) {
      auto const changes =
          set(integrator + (method == "dp5" ? ",tolerance=1e-6}" : "}"), "output.every=60000");
      return joined(
          joined({"run", "chain.toml", "--quiet", "--overwrite", "--output", file}, changes), more);
    };
    auto const checkpoint = in_folder("first.checkpoint.h5");
    std::filesystem::remove(checkpoint);
    auto const process = begin(run_of("first.h5", set("output.checkpoint_every='500 steps'")));
    EXPECT_TRUE(eventually([&] { return std::filesystem::exists(checkpoint); }));
    EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
    auto const step = io::CheckpointReader(checkpoint).header().step;
    ASSERT_GT(step, 0);
    output_of(run_of("second.h5", {"--restart", "first.h5"}));
    output_of(run_of("whole.h5"));
    EXPECT_EQ(info_of("second.h5").frame_steps.front(), step);
    EXPECT_EQ(last_spins("second.h5"), last_spins("whole.h5"));
  }
}

TEST_F(Restarting, TakesTheMethodThatAutoChoseBefore) {
  auto const to = [](char const* steps) {
    return std::string("integrator={method='auto',error=1e-4,dt=0.1,steps=") + steps + "}";
  };
  run_to("5", "first.h5", set(to("5")));
  auto const first = info_of("first.h5").header.resolved_scene;
  // The restart uses the choice in the file, whatever would be chosen now.
  auto const before = io::parse_scene(first, "scene.toml").integrator;
  run_to("10", "second.h5", {"--set", to("10"), "--restart", "first.h5"});
  auto const second = info_of("second.h5");
  auto const after = io::parse_scene(second.header.resolved_scene, "scene.toml").integrator;
  EXPECT_EQ(after.method, before.method);
  EXPECT_EQ(after.dt, before.dt);
  EXPECT_EQ(after.tolerance, before.tolerance);
  EXPECT_EQ(after.steps, 2 * before.steps);
  EXPECT_EQ(second.frame_steps.front(), before.steps);
}

TEST_F(Restarting, KeepsTheOptionsOfItsOwnSceneBesideTheMethodOfAuto) {
  auto const to = [](std::string const& steps_and_options) {
    return "integrator={method='auto',error=1e-4,dt=0.1,steps=" + steps_and_options + "}";
  };
  auto const integrator_of = [&](char const* file) {
    return io::parse_scene(info_of(file).header.resolved_scene, "scene.toml").integrator;
  };
  struct Case {
    std::string before, after;
    bool energy_guard, refuse_unstable;
    std::optional<double> until_torque;
  };
  for (auto const& [before, after, energy_guard, refuse_unstable, until_torque] :
       {Case{"", ",energy_guard=false", false, false, {}},
        Case{",energy_guard=false", ",refuse_unstable=true", true, true, {}},
        Case{",until_torque=1e-9", ",until_torque=2e-9", true, false, 2e-9}}) {
    SCOPED_TRACE(before + " then " + after);
    run_to("5", "first.h5", {"--overwrite", "--set", to("5" + before)});
    auto const outcome = start(to_second({"--set", to("10" + after)}));
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    auto const first = integrator_of("first.h5"), second = integrator_of("second.h5");
    EXPECT_EQ(second.method, first.method);
    EXPECT_EQ(second.dt, first.dt);
    EXPECT_EQ(second.energy_guard, energy_guard);
    EXPECT_EQ(second.refuse_unstable, refuse_unstable);
    EXPECT_EQ(second.until_torque, until_torque);
  }
}

// In a file of relax, times are the numbers of its states.
TEST_F(Restarting, BeginsAtZeroFromAFileOfRelaxedStates) {
  output_of({"relax", "chain.toml", "--quiet", "--output", "first.h5", "--set",
             "field.applied=[[0,0,0.1],[0,0,0.2],[0,0,0.3]]"});
  ASSERT_EQ(info_of("first.h5").frames, 3);
  auto const outcome = start(to_second({"--set", "field.applied=[0,0,0.3]"}));
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  auto const second = info_of("second.h5");
  EXPECT_EQ(second.frame_steps.front(), 0);
  EXPECT_EQ(second.frame_steps.back(), 25);
  EXPECT_EQ(second.frame_times.front(), 0);
}

}  // namespace
}  // namespace cayspin::program::test
