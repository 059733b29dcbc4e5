// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// [ensemble] on several ranks: the replicas are divided among them, and the file is that of a run
// on one rank.
#include "io/ensemble_checkpoint.hpp"
#include "io/ensemble_file.hpp"
#include "on_ranks.hpp"
#include "stored_contents.hpp"

#include <cmath>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace cayspin::program::test {
namespace {

class EnsemblesOnRanks : public OnRanks {
 protected:
  static std::string ensemble(int replicas, std::string const& keys = {}) {
    return fmt::format("[ensemble]\nreplicas = {}\n[ensemble.vary]\n{}", replicas, keys);
  }

  static Arguments into(std::string const& file, Arguments const& more = {}) {
    return run_of("all.toml", file, more);
  }

  /// Expects all datasets and attributes to be equal, except those of the time that a run took and
  /// of its threads.
  void expect_same_contents(std::string const& one, std::string const& other) const {
    auto const first = contents_of(in_folder(one)), second = contents_of(in_folder(other));
    EXPECT_GT(first.size(), 20u);
    EXPECT_EQ(second.size(), first.size());
    std::set<std::string> const of_the_run{"@wall_seconds", "@step_seconds", "@threads"};
    for (auto const& [name, bytes] : first) {
      if (of_the_run.contains(name)) continue;
      EXPECT_TRUE(second.contains(name) && second.at(name) == bytes) << name;
    }
  }

  void run_on(int ranks, std::string const& file, Arguments const& more = {}) const {
    auto const outcome = start_on(ranks, into(file, more));
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
  }

  /// Interrupts a long run, some time after the file `when` exists. Expects the ranks to end with
  /// these statuses, in any order.
  Outcome interrupt(int ranks, std::string const& file, std::multiset<int> const& expected,
                    Arguments const& more, fs::path const& when, double seconds) const {
    Treatment interrupted;
    interrupted.program = CAYSPIN_MPIEXEC;
    interrupted.interrupt_after = seconds;
    interrupted.interrupt_when = when;
    auto command = launch(ranks, into(file, more));
    // An interrupted launcher may lose the statuses of its ranks, so each rank stores its own.
    command.insert(command.begin() + 2,
                   {"sh", "-c", "trap : INT; \"$@\"; echo $? > status.$$", "sh"});
    auto outcome = start(command, interrupted);
    std::multiset<int> statuses;
    for (auto const& entry : fs::directory_iterator(folder_)) {
      if (entry.path().stem() != "status") continue;
      int status = -1;
      std::ifstream(entry.path()) >> status;
      statuses.insert(status);
      fs::remove(entry.path());
    }
    EXPECT_EQ(statuses, expected);
    return outcome;
  }
};

std::string const noise = "[thermal]\ntemperature = 0.05\nseed = 7\n";

TEST_F(EnsemblesOnRanks, WriteTheFileOfOneRankForRandomScenes) {
  std::mt19937 random(static_cast<unsigned>(setting("CAYSPIN_SEED", 3)));
  auto const one_of = [&](std::vector<std::string> const& choices) {
    return choices[random() % choices.size()];
  };
  int const compositions = setting("CAYSPIN_RANDOM_SCENES", 24);
  for (int composition = 0; composition < compositions && !HasFailure(); ++composition) {
    bool const is_crystal = composition % 4 == 3, has_noise = random() % 2 == 0;
    // From 16 replicas on, small lattices without `couplings` are stepped as the columns of one
    // lattice, unless they differ in more than temperatures, dampings and constant applied fields.
    int const replicas = std::stoi(one_of({"3", "5", "17", "40"}));
    std::vector<std::string> varied{"", "'system.damping' = { from = 0.1, to = 0.4 }\n",
                                    "'field.applied.2' = { from = -1, to = 2 }\n"};
    if (has_noise) varied.insert(varied.end(), 3, "'thermal.temperature' = { from = 0, to = 0.3 }");
    auto const integrator =
        has_noise ? one_of({"method = 'rkmk4'", "method = 'heun'", "method = 'cf4'"})
                  : one_of({"method = 'rkmk4'", "method = 'ab2'", "method = 'implicit_midpoint'",
                            "method = 'stiff2'", "method = 'tsit5'\ntolerance = 1e-6",
                            "method = 'stiff2_adaptive'\ntolerance = 1e-5",
                            "method = 'rkmk4'\nuntil_torque = 0.3",
                            "method = 'dp5'\ntolerance = 1e-5\nuntil_torque = 0.3"});
    bool const may_end = integrator.find("until_torque") != integrator.npos;
    auto const scene = fmt::format(
        "[system]\nkind = 'llg'\ndamping = 0.5\n[lattice]\nshape = {}\n{}[field]\n{}\napplied = "
        "[0.3, {}, 0.1]\n[initial]\n{}\n[integrator]\n{}\ndt = 0.02\nsteps = {}\n[output]\nevery = "
        "{}\nscalars_every = 5\ncompression = {}\n",
        is_crystal ? "[4, 3, 2]" : one_of({"[1]", "[20]", "[3, 1, 4]", "[3, 4, 2]"}),
        is_crystal ? "crystal = 'bcc'\n" : "",
        is_crystal ? "couplings = { shells = [1.0] }" : "exchange = 1.0",
        may_end ? "-0.2" : one_of({"-0.2", "'sin(9 * t)'"}),
        one_of({"random = { seed = 3 }", "expression = ['1', 'i', '0.3']"}), integrator,
        may_end ? "400" : "13", one_of({"4", "7"}), one_of({"0", "3"}));
    auto const text = scene + (has_noise ? noise : "") + ensemble(replicas, one_of(varied));
    write("all.toml", text);
    Arguments const same{"--precision", one_of({"double", "single"}), "--threads",
                         one_of({"1", "2"})};
    SCOPED_TRACE(text + same[1]);
    auto const alone = start(into("one.h5", same));
    ASSERT_EQ(alone.status, 0) << alone.errors;
    for (int const ranks : {2, 3}) {
      SCOPED_TRACE(ranks);
      auto const outcome = start_on(ranks, into("other.h5", same));
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      EXPECT_EQ(outcome.output, "");
      EXPECT_EQ(outcome.errors, alone.errors);
      expect_same_contents("one.h5", "other.h5");
    }
  }
}

TEST_F(EnsemblesOnRanks, AreNotMoreThanTheReplicas) {
  for (auto const& [replicas, ranks, warning] :
       {std::tuple{2, 4, "warning: 2 of 4 ranks have nothing to do: the ensemble has 2 replicas\n"},
        {1, 2, "warning: 1 of 2 ranks has nothing to do: the ensemble has 1 replica\n"},
        {3, 3, ""}}) {
    write("all.toml", chain_scene() + noise + ensemble(replicas));
    ASSERT_EQ(start(into("one.h5")).status, 0);
    auto const outcome = start_on(ranks, into("other.h5"));
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.errors, warning);
    expect_same_contents("one.h5", "other.h5");
  }
}

// In SI the reduced unit of time depends on alpha, so it differs between replicas.
TEST_F(EnsemblesOnRanks, ContinueFromFilesOfAnyNumberOfRanks) {
  std::string const in_si = R"(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0.1
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [6, 5]
spacing = [4e-9, 4e-9, 3e-9]
[field]
slab_demag = { normal = [0, 0, 1] }
[initial]
random = { seed = 5 }
[integrator]
method = "heun"
dt = 1e-13
steps = 20
[output]
every = 3
)";
  Arguments const part = set("integrator.steps=6");
  for (auto const& scene :
       {chain_scene() + noise + ensemble(40, "'thermal.temperature' = { from = 0, to = 0.3 }\n"),
        in_si + ensemble(5, "'material.alpha' = { from = 0.2, to = 0.5 }\n")}) {
    SCOPED_TRACE(scene);
    write("all.toml", scene);
    ASSERT_EQ(start(into("part.h5", part)).status, 0);
    run_on(3, "part_on_3.h5", part);
    expect_same_contents("part.h5", "part_on_3.h5");
    ASSERT_EQ(start(into("rest.h5", {"--restart", "part.h5"})).status, 0);
    for (int const ranks : {2, 3}) {
      run_on(ranks, "rest_on_ranks.h5", {"--restart", "part_on_3.h5"});
      expect_same_contents("rest.h5", "rest_on_ranks.h5");
    }
  }
  auto const outcome =
      start_on(3, into("changed.h5", {"--restart", "part.h5", "--set", "output.every=2", "--set",
                                      "field.slab_demag={normal=[0,1,0]}"}));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
  EXPECT_TRUE(contains(outcome.errors, "warning: --restart part.h5: these keys differ"));
}

TEST_F(EnsemblesOnRanks, NameTheReplicaWhoseNumbersFail) {
  auto const applied = [](std::string const& values) {
    return chain_scene() + ensemble(5, "'field.applied.2' = [" + values + "]\n");
  };
  Arguments const unstable =
      set("integrator.method='classical_euler'", "integrator.steps=1000", "output.every=30");
  for (auto const& [scene, more, failure] :
       {std::tuple{applied("0.1, 0.2, 0.3, 0.4, 1e300"), unstable, "replica 4: "},
        {applied("0.1, 0.2, 1e300, 0.4, 1e300"), unstable, "replica 2: "},
        {applied("1e300, 0.2, 0.3, 0.4, 0.5"), unstable, "replica 0: "},
        // These replicas are stepped as the columns of lattices.
        {chain_scene() + ensemble(40), joined(unstable, set("field.applied=[0,0,30]")),
         "replica "}}) {
    SCOPED_TRACE(scene);
    write("all.toml", scene);
    auto const alone = start(into("all.h5", more));
    ASSERT_EQ(alone.status, 3) << alone.errors;
    EXPECT_TRUE(contains(alone.errors, failure));
    auto const spins = read_dataset("all.h5", "/spins").values;
    for (double const number : spins) ASSERT_TRUE(std::isfinite(number));
    for (int const ranks : {2, 3}) {
      auto const outcome = start_on(ranks, into("all.h5", more));
      EXPECT_EQ(outcome.status, 3);
      EXPECT_EQ(outcome.errors, alone.errors);
      auto const info = io::read_ensemble_info(in_folder("all.h5"));
      EXPECT_FALSE(info.complete);
      EXPECT_GT(info.cost.evaluations, 0);
      EXPECT_EQ(read_dataset("all.h5", "/spins").values, spins);
    }
  }
}

TEST_F(EnsemblesOnRanks, EndTogetherWhenInterrupted) {
  for (auto const& [ranks, replicas, statuses] :
       {std::tuple{3, 4, std::multiset{130, 130, 130}}, {4, 2, {130, 130, 0, 0}}}) {
    SCOPED_TRACE(ranks);
    write("all.toml", chain_scene() + noise + ensemble(replicas));
    fs::remove(in_folder("part.h5"));
    auto const outcome =
        interrupt(ranks, "part.h5", statuses, set("integrator.steps=2000000", "output.every=50"),
                  in_folder("part.h5"), 0.3);
    auto const line = outcome.errors.find("interrupted after step ");
    ASSERT_NE(line, std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.errors.find("interrupted after step ", line + 1), std::string::npos);
    auto const info = io::read_ensemble_info(in_folder("part.h5"));
    EXPECT_FALSE(info.complete);
    EXPECT_GT(info.cost.evaluations, 0);
    auto const steps = std::stoll(outcome.errors.substr(line + 23));
    EXPECT_GE(steps, info.step);
    EXPECT_LE(steps, info.step + 50);
    EXPECT_TRUE(
        contains(outcome.errors, fmt::format("the last good frame is {} in", info.frames - 1)));
    auto const on = set(fmt::format("integrator.steps={}", info.step + 20), "output.every=10");
    run_on(2, "rest.h5", joined(on, {"--restart", "part.h5"}));
    ASSERT_EQ(start(into("whole.h5", on)).status, 0);
    EXPECT_EQ(last_spins("rest.h5"), last_spins("whole.h5"));
  }
}

// The replicas of a run that is interrupted are at different steps.
TEST_F(EnsemblesOnRanks, ContinueFromTheCheckpointOfAnInterruptedRun) {
  // The replicas with equal damping are stepped as the columns of lattices.
  for (auto const& [method, table] :
       {std::tuple{"method='dp5',tolerance=1e-6",
                   ensemble(4, "'system.damping' = { from = 0.1, to = 0.4 }\n")},
        {"method='ab2'", ensemble(70)}}) {
    SCOPED_TRACE(method);
    write("all.toml", chain_scene() + table);
    auto const same = set(fmt::format("integrator={{{},dt=0.001,steps=40000}}", method),
                          "output.every=40000", "lattice.shape=[5]");
    auto const checkpoint = io::checkpoint_beside(in_folder("part.h5"));
    interrupt(3, "part.h5", {130, 130, 130},
              joined(same, set("output.checkpoint_every='500 steps'")), checkpoint, 0.02);
    ASSERT_EQ(start(into("whole.h5", same)).status, 0);
    for (int const ranks : {1, 2}) {
      run_on(ranks, "rest.h5", joined(same, {"--restart", "part.h5"}));
      EXPECT_EQ(last_spins("rest.h5"), last_spins("whole.h5"));
    }
    fs::remove(checkpoint);
  }
}

TEST_F(EnsemblesOnRanks, RelaxToTheFileOfOneRank) {
  Arguments const vacancies =
      set("lattice={shape=[5,4],occupied='i!=j'}", "field.slab_demag.normal=[0,0,1]");
  auto const fields = [](std::string const& values) {
    return ensemble(5, "'field.applied.2' = [" + values + "]\n");
  };
  for (auto const& [table, more, status, part] :
       {std::tuple{fields("0.1, 0.2, 0.3, 0.4, 0.5"), Arguments{}, 0, ""},
        {fields("0.5, 0.2, -0.3, 0.4, 0.1"), joined(vacancies, {"--torque", "1e-8"}), 0, ""},
        {ensemble(3), {"--precision", "single", "--torque", "1e-4"}, 0, ""},
        {fields("0.1, 0.2, 0.3, 0.4, 0.5"), {"--evaluations", "3"}, 3, "did not converge"},
        {fields("0.1, 0.2, 1e300, 0.4, 1e300"), {}, 3, "replica 2: "}}) {
    SCOPED_TRACE(table + testing::PrintToString(more));
    write("all.toml", chain_scene() + table);
    auto const into_file = [&](std::string const& file) {
      return joined({"relax", "all.toml", "--quiet", "--overwrite", "--output", file}, more);
    };
    auto const alone = start(into_file("one.h5"));
    ASSERT_EQ(alone.status, status) << alone.errors;
    EXPECT_TRUE(contains(alone.errors, part));
    for (int const ranks : {2, 3}) {
      auto const outcome = start_on(ranks, into_file("other.h5"));
      EXPECT_EQ(outcome.status, status);
      EXPECT_EQ(outcome.output, "");
      EXPECT_EQ(outcome.errors, alone.errors);
      expect_same_contents("one.h5", "other.h5");
    }
  }
}

TEST_F(EnsemblesOnRanks, SpeakOnce) {
  write("all.toml", chain_scene() + ensemble(4, "'field.exchange' = [1, 1, 100, 100]\n"));
  for (int const ranks : {1, 2, 3}) {
    auto const outcome = start_on(ranks, into("all.h5", set("integrator.energy_guard=false")));
    EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, "warning: replica 2: ")) << outcome.errors;
    expect_refused(start_on(ranks, into("b.h5", set("integrator.refuse_unstable=true"))),
                   "replica 2: ");
    EXPECT_FALSE(exists("b.h5"));
  }
  write("all.toml", chain_scene() + ensemble(4));
  auto const outcome = start_on(3, {"run", "all.toml", "--overwrite", "--output", "all.h5"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors, "");
  EXPECT_TRUE(is_one_line(outcome.output)) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, "all.h5"));
}

TEST_F(EnsemblesOnRanks, AreRefusedInOneLine) {
  write("all.toml", chain_scene() + ensemble(3));
  auto const refused = [&](Arguments const& more, std::string const& part) {
    SCOPED_TRACE(part);
    expect_refused(start_on(2, into("out.h5", more)), part);
    EXPECT_FALSE(exists("out.h5"));
  };
  refused({"--ranks", "1,2"}, "--ranks takes no ensemble");
  refused({"--space", "nowhere"}, "--space nowhere");
  refused({"--restart", "nothing.h5"}, "nothing.h5");
  refused({"--set", "ensemble.vary={'field.exchange'=[1,2]}"}, "as many numbers as replicas");
  refused({"--set", "initial={expression=['0','0','i-12']}"}, "the spin of site (12, 0, 0)");
  expect_refused(start_on(2, into("no/such/folder/out.h5")), "no/such/folder");
  run_on(2, "out.h5");
  expect_refused(start_on(2, {"run", "all.toml", "--quiet", "--output", "out.h5"}), "out.h5");
  expect_refused(start_on(2, into("out.h5", {"--restart", "out.h5"})), "would replace it");
  expect_refused(start_on(2, into("b.h5", {"--restart", "out.h5", "--set", "ensemble.replicas=4"})),
                 "it has 3 replicas, and the scene has 4");
}

TEST_F(EnsemblesOnRanks, SayOnceThatOneHasTooLittleMemory) {
  // The field of a replica is 131 MB.
  write("all.toml",
        film("[256, 256, 160]", "method = \"rkmk4\"", "uniform = [0, 0, 1]") + ensemble(2));
  expect_too_little_memory(into("out.h5"));
}

}  // namespace
}  // namespace cayspin::program::test
