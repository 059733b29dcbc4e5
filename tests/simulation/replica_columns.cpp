// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Tests which ensembles are stepped as columns of a few lattices, and that replicas in columns
// move, are sampled and fail like separate runs; also that ensembles relax.
// tests/program/ensembles.cpp compares files of ensembles with those of separate runs, bit by bit.
#include "../support/watchdog.hpp"
#include "ensemble_of_chains.hpp"
#include "simulation/failure.hpp"

#include <fmt/ranges.h>

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cayspin::simulation::test {
namespace {

TEST(ReplicaColumns, AreUsedForSmallLatticesOfLocalTermsAndExchange) {
  auto const scene = llg_scene("0.1", "rkmk4", 40, chains);
  EXPECT_TRUE(are_columns(scene));
  EXPECT_TRUE(are_columns(llg_scene("0.1", "rkmk4", 40, chains + noise)));
  std::vector<std::vector<std::string>> const can{
      {"lattice.shape=[1]"},
      {"lattice.shape=[3,1,5]", "lattice.boundary='periodic'"},
      {"integrator.method='ab2'"},
      {"thermal={temperature=0.1}", "ensemble.vary={'thermal.temperature'={from=0,to=1}}"},
      {"ensemble.vary={'system.damping'={from=0,to=1}}"},
      {"ensemble.vary={'system.damping'={from=0,to=1}}",
       "field.anisotropy={cubic=0.4,axes=[[1,0,0],[0,1,0]]}"},
      {"ensemble.vary={'field.applied.0'={from=0,to=1}}", "field.applied=[0.3,0,0]"},
      {"ensemble.vary={'field.anisotropy.constant'={from=0,to=1}}",
       "field.anisotropy={constant=0.1,axis=[0,3,4]}"},
      {"field.anisotropy={cubic=0.4,axes=[[1,0,0],[0,1,0]]}"},
      {"field.slab_demag={normal=[0,0,1]}"}};
  for (auto const& changes : can)
    EXPECT_TRUE(are_columns(scene_of(scene.text, changes))) << changes[0];
  std::vector<std::vector<std::string>> const cannot{
      {"lattice.shape=[2,2,2]"},
      {"lattice.shape=[1,3,3]"},
      {"lattice.shape=[600]"},
      {"lattice.occupied='i>0'"},
      {"lattice.crystal='bcc'", "field={couplings={shells=[1.0]}}"},
      {"ensemble.replicas=4"},
      {"ensemble.vary={'field.exchange'={from=0,to=1}}"},
      {"ensemble.vary={'field.applied.0'={from=0,to=1}}"},  // another component depends on t
      {"ensemble.vary={'field.applied.0'={from=0,to=1}}", "field.applied=[0.3,0,0]",
       "field.anisotropy={cubic=0.4,axes=[[1,0,0],[0,1,0]]}"},
      {"ensemble.vary={'field.anisotropy.0.constant'={from=0,to=1}}",
       "field.anisotropy=[{constant=0.1,axis=[0,0,1]},{cubic=0.4,axes=[[1,0,0],[0,1,0]]}]"},
      {"ensemble.vary={'field.anisotropy.constant2'={from=0,to=1}}",
       "field.anisotropy={constant=0.1,constant2=0.2,axis=[0,0,1]}"},
      {"ensemble.vary={'system.damping'={from=0.1,to=1}}", "thermal={temperature='0.1*t'}"},
      {"ensemble.vary={'system.damping'={from=0,to=1}}", "field.applied=[0.3,0,0]",
       "integrator.method='series4'"},
      {"field.dmi={bulk=0.3}"},
      {"field.demag=true"},
      {"field.exchange='1+i'"},
      {"field.anisotropy={constant='1+i',axis=[0,0,1]}"},
      {"integrator={method='tsit5',tolerance=1e-6,dt=0.02,steps=40}"},
      {"integrator.method='implicit_midpoint'"},
      {"integrator.method='red_black2'", "field.applied=[0.1,0,0]"},
      {"integrator.until_torque=1e-3"}};
  for (auto const& changes : cannot)
    EXPECT_FALSE(are_columns(scene_of(scene.text, changes))) << changes[0];
}

TEST(ReplicaColumns, AreSampledAndRelaxedAsRunsOfTheirOwn) {
  auto const scene = llg_scene("0.1", "heun", 40, chains + noise);
  for (auto const precision : precisions) {
    EnsembleRun run(scene, {.precision = precision}, false);
    auto const looks = run.looks(false, {});
    run.advance(7, looks);
    run.advance(4, looks);
    auto const scalars = run.scalars();
    std::vector<std::unique_ptr<SceneRun>> own;
    for (std::int64_t const replica : {0, 17, 39}) {
      own.push_back(SceneRun::open(io::replica_of(scene, replica), {.precision = precision}));
      own.back()->advance(11);
      auto const& sampled = scalars[static_cast<std::size_t>(replica)];
      EXPECT_EQ(sampled.energy, own.back()->sample().energy.value);
      EXPECT_EQ(sampled.norm_defect, own.back()->sample().norm_defect);
      EXPECT_EQ(sampled.magnetization[1], own.back()->sample().magnetization.y);
    }
    EXPECT_EQ(run.steps(), 11);
    EXPECT_DOUBLE_EQ(run.time(), 11 * 0.02);
    EXPECT_EQ(run.evaluations(), 40 * own[0]->evaluations());
  }
  // After relaxing, each replica has a run of its own.
  auto const cold =
      scene_of(llg_scene("0.1", "heun", 40, chains).text, {"field.applied=[0.3,0.1,0]"});
  EnsembleRun run(cold, {}, false);
  run.advance(11, run.looks(false, {}));
  auto const seconds = run.step_seconds();
  EXPECT_GT(seconds, 0);
  EXPECT_THROW(run.relax({.torque = -1}), UsageError);
  EXPECT_EQ(run.step_seconds(), seconds);
  auto const found = run.relax({.torque = 1e-9});
  EXPECT_EQ(run.step_seconds(), seconds);
  auto const own = SceneRun::open(io::replica_of(cold, 17), {});
  own->advance(11);
  EXPECT_EQ(found[17].evaluations, own->relax({.torque = 1e-9}).evaluations);
  EXPECT_EQ(run.scalars()[17].energy, own->sample().energy.value);
  run.advance(5, run.looks(false, {}));
  own->advance(5);
  EXPECT_EQ(run.scalars()[17].energy, own->sample().energy.value);
  EXPECT_EQ(run.steps(), 16);
}

// An interrupt stops some replicas before others; afterwards all continue to the same step.
TEST(ReplicaColumns, MeetAfterAnInterrupt) {
  auto const columns = llg_scene("0.1", "heun", 400, chains + noise);
  for (auto const& scene :
       {columns, scene_of(columns.text, {"ensemble.replicas=8"}),
        scene_of(columns.text, {"ensemble.replicas=8", "integrator.method='implicit_midpoint'"})}) {
    EnsembleRun run(scene, {}, false), whole(scene, {}, false);
    run.advance(3, run.looks(false, {}));
    std::atomic<int> asked = 0;
    auto const stop = [&] { return ++asked > 1; };
    if (scene.ensemble.replicas == 8) {
      EXPECT_EQ(run.advance(20, run.looks(false, stop)), Advanced::interrupted);
      EXPECT_EQ(run.steps(), 3);
      EXPECT_DOUBLE_EQ(run.time(), 3 * 0.02);
    } else {
      run.advance(20, run.looks(false, stop));
    }
    run.advance(40 - run.steps(), run.looks(false, {}));
    whole.advance(40, whole.looks(false, {}));
    EXPECT_EQ(run.steps(), 40);
    EXPECT_EQ(run.spins(), whole.spins());
  }
}

// The first replica is at the end when the last ones have not begun, except on many threads.
TEST(ReplicaColumns, GoOnAfterAnInterruptToTheEndOfAdaptiveSteps) {
  auto const scene = scene_of(
      llg_scene("0.1", "heun", 40, chains).text,
      {"integrator={method='tsit5',tolerance=1e-6,dt=0.02,steps=40}", "ensemble.replicas=8"});
  EnsembleRun run(scene, {}, false);
  run.advance(40, run.looks(false, [&] { return run.first().steps() > 0; }));
  auto const left = 40 - run.steps();
  EXPECT_NO_THROW(run.require_reachable(left));
  EXPECT_THROW(run.require_reachable(left + 1), UsageError);
  EXPECT_EQ(run.advance(left, run.looks(false, {})), Advanced::whole);
  EXPECT_EQ(run.steps(), 40);
}

TEST(ReplicaColumns, GoOnFromRest) {
  auto const scene = scene_of(llg_scene("0.5", "heun", 4000, chains).text,
                              {"ensemble={replicas=2,vary={'field.exchange'=[0.5,2.0]}}",
                               "field.applied=[0,0,1]", "integrator.until_torque=1e-2"});
  EnsembleRun run(scene, {}, false), steps(scene, {}, false);
  EXPECT_EQ(run.advance(4000, run.looks(true, {})), Advanced::at_rest);
  auto const rest = run.steps();
  EXPECT_LT(rest, 4000);
  run.advance(10, run.looks(false, {}));
  EXPECT_EQ(run.steps(), rest + 10);
  steps.advance(rest + 10, steps.looks(false, {}));
  EXPECT_EQ(run.spins(), steps.spins());
}

TEST(ReplicaColumns, AreReadWithoutTheListsOfAll) {
  std::string values;
  for (int replica = 0; replica < 40; ++replica) values += std::to_string(0.01 * replica) + ", ";
  auto scene = scene_of(llg_scene("0.1", "heun", 40, chains).text,
                        {"ensemble.vary={'field.exchange'=[" + values + "]}"});
  auto const replica = io::replica_of(scene, 17);
  EXPECT_EQ(scene.ensemble.text_of_replicas.find("ensemble"), std::string::npos);
  scene.ensemble.text_of_replicas.clear();
  EXPECT_EQ(replica.text, io::replica_of(scene, 17).text);
}

// In this field the steps are unstable.
TEST(ReplicaColumns, FailAsRunsOfTheirOwn) {
  auto const scene =
      scene_of(llg_scene("0.1", "classical_euler", 4000, chains).text, {"field.applied=[0,0,30]"});
  std::optional<std::string> said;
  std::int64_t first = -1;
  for (std::int64_t replica = 0; replica < 40 && !said; ++replica) {
    auto const own = SceneRun::open(io::replica_of(scene, replica), {});
    try {
      own->advance(400, {.period = 100, .at_end = true});
    } catch (NumbersFailed const& failure) {
      said = fmt::format("replica {}: {}", replica, failure.what());
      first = replica;
    }
  }
  ASSERT_TRUE(said) << "the steps should be unstable";
  EnsembleRun run(scene, {}, false);
  try {
    run.advance(400, run.looks(false, {}));
    FAIL() << "replica " << first << " should fail";
  } catch (NumbersFailed const& failure) {
    EXPECT_EQ(failure.what(), *said);
  }
}

// Neither the largest field nor the largest damping makes the steps too long, but a large field
// with a large damping does. In Euler's method, so does a large field with a small damping.
TEST(ReplicaColumns, WarnOfFieldsTogetherWithDampings) {
  struct Case {
    std::string method;
    std::pair<double, double> field, damping, both;  // replicas with (field, damping)
  };
  for (auto const& [method, field, damping, both] :
       {Case{"rkmk4", {60, 0.1}, {0.1, 10}, {50, 8}},
        Case{"euler", {4, 0.3}, {0.1, 0.01}, {3.5, 0.02}}}) {
    SCOPED_TRACE(method);
    std::vector<double> fields(20, 0.1), dampings(20, 0.3);
    for (auto const& [replica, values] : {std::pair{3, field}, {7, damping}, {11, both}}) {
      fields[static_cast<std::size_t>(replica)] = values.first;
      dampings[static_cast<std::size_t>(replica)] = values.second;
    }
    auto const scene = scene_of(
        llg_scene("0.1", method, 40, chains).text,
        {"field.exchange=0.01", "field.applied=[0.1,0.1,0]",
         fmt::format("ensemble={{replicas=20,vary={{'field.applied.0'=[{}],'system.damping'=[{}]}}"
                     "}}",
                     fmt::join(fields, ","), fmt::join(dampings, ","))});
    EXPECT_TRUE(are_columns(scene));
    for (std::int64_t const replica : {0, 3, 7})
      EXPECT_EQ(SceneRun::open(io::replica_of(scene, replica), {})->warning(), std::nullopt);
    auto const warning = EnsembleRun(scene, {}, false).warning();
    ASSERT_TRUE(warning.has_value());
    EXPECT_TRUE(warning->starts_with("replica 11: ")) << *warning;
  }
}

// mu0 multiplies the applied field, but not the anisotropy.
TEST(ReplicaColumns, WarnOfTheLargestFieldForAnyMu0) {
  auto const scene = scene_of(
      llg_scene("0.1", "rkmk4", 40, chains).text,
      {"field.mu0=0.001", "field.applied=[0.1,0,0.2]",
       "field.anisotropy={constant=0.1,axis=[0,0,1]}",
       "ensemble.vary={'field.applied.0'={from=0.1,to=2e4},'field.anisotropy.constant'={from=5e3,"
       "to=0.1}}"});
  EXPECT_TRUE(are_columns(scene));
  auto const own = SceneRun::open(io::replica_of(scene, 0), {})->warning();
  ASSERT_TRUE(own.has_value());
  EXPECT_EQ(EnsembleRun(scene, {}, false).warning(), "replica 0: " + *own);
}

// Each replica has a larger field and a larger damping than those before it.
TEST(ReplicaColumns, WarnOnlyIfTheStepsOfAReplicaAreTooLong) {
  auto const scene_to = [](std::string const& most) {
    return scene_of(llg_scene("0.1", "rkmk4", 40, chains).text,
                    {"field.exchange=0.01", "field.applied=[0.1,0.1,0]",
                     "ensemble.vary={'field.applied.0'={from=0.1,to=" + most +
                         "},'system.damping'={from=0.1,to=1}}"});
  };
  EXPECT_TRUE(are_columns(scene_to("1")));
  EXPECT_EQ(EnsembleRun(scene_to("1"), {}, false).warning(), std::nullopt);
  auto const scene = scene_to("1e4");
  std::optional<std::string> said;
  for (std::int64_t replica = 0; replica < 40 && !said; ++replica)
    if (auto const own = SceneRun::open(io::replica_of(scene, replica), {})->warning())
      said = fmt::format("replica {}: {}", replica, *own);
  ASSERT_TRUE(said) << "the steps should be too long";
  EXPECT_EQ(EnsembleRun(scene, {}, false).warning(), said);
}

// A replica between those with the largest damping and the largest temperature has the most noise.
TEST(ReplicaColumns, RefuseTheNoiseOfAReplicaByItsNumber) {
  auto const scene = scene_of(
      llg_scene("0.1", "rkmk4", 40, chains + noise).text,
      {"integrator.dt=0.1", "integrator.steps=1", "ensemble.replicas=41",
       "ensemble.vary={'thermal.temperature'={from=10,to=0.1},'system.damping'={from=0.1,to=10}}"});
  EXPECT_FALSE(are_columns(scene));
  try {
    EnsembleRun const run(scene, {}, false);
    ADD_FAILURE() << "too much noise";
  } catch (io::SceneError const& error) {
    EXPECT_NE(std::string_view(error.what()).find("ensemble.vary: in replica 5: integrator.dt: "),
              std::string_view::npos)
        << error.what();
  }
}

// The steps are far too long, so that the energy rises at once.
TEST(ReplicaColumns, FailAtTheirFirstCheckAsRunsOfTheirOwn) {
  auto const scene =
      scene_of(llg_scene("0.1", "rkmk4", 40, chains).text,
               {"integrator.dt=0.1", "integrator.steps=1", "field.applied=[0.1,0,0.2]",
                "field.anisotropy={constant=0.1,axis=[0,0,1]}",
                "ensemble.vary={'field.anisotropy.constant'={from=5000,to=0.1}}"});
  EXPECT_TRUE(are_columns(scene));
  auto const failure_of = [](auto& run, Looks const& looks) {
    try {
      run.advance(1, looks);
    } catch (NumbersFailed const& failure) {
      return std::string(failure.what());
    }
    return std::string();
  };
  auto const own = SceneRun::open(io::replica_of(scene, 0), {});
  auto const said = failure_of(*own, {.period = 100, .at_end = true});
  ASSERT_NE(said.find("the energy rose"), std::string::npos) << said;
  EnsembleRun run(scene, {}, false);
  EXPECT_EQ(failure_of(run, run.looks(false, {})), "replica 0: " + said);
}

// Searches with terms that need a pass free memory, for which Kokkos waits for all kernels. So they
// must not be side by side in one kernel: they would never end.
TEST(Ensembles, RelaxWithTermsThatNeedAPass) {
  auto const scene = llg_scene("0.1", "rkmk4", 1, R"([lattice]
shape = [4]
moments = 2.0
[field]
exchange = 1.0
applied = [0.0, 0, 0.5]
anisotropy = { constant = "0.1*i", axis = [0, 0, 1] }
[initial]
random = { seed = 7 }
[ensemble]
replicas = 4
)");
  cayspin::test::Watchdog const watchdog("relax of an ensemble");
  EnsembleRun run(scene, {}, false);
  for (auto const& minimum : run.relax({})) EXPECT_EQ(minimum.end, MinimizeEnd::converged);
}

}  // namespace
}  // namespace cayspin::simulation::test
