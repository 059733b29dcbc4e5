// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// With every method, a run that is stored and continued gives bitwise the same results, and the
// same counts, as one that is not interrupted. A run that is interrupted early reports that.
#include "random_run.hpp"
#include "scenes_of_text.hpp"
#include "simulation/failure.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

namespace cayspin::simulation::test {
namespace {

namespace fs = std::filesystem;

/// Runs a scene without and with an interruption after `cut` steps. Returns false if the scene is
/// invalid or the run fails with numbers that are not finite.
bool gives_the_bits_of_one_run(std::string const& text, Precision precision, std::int64_t cut) {
  std::optional<io::Scene> scene;
  try {
    scene = scene_of(text);
  } catch (io::SceneError const&) {
    return false;
  }
  SCOPED_TRACE(fmt::format("{}{} precision, cut after {} steps", text, to_string(precision), cut));
  try {
    end_of(*scene, precision);
  } catch (NumbersFailed const&) {
    return false;
  }
  expect_same_bits_after_a_break(*scene, cut, precision);
  return true;
}

TEST(Restarting, GivesTheBitsOfARunWithoutABreakByEveryMethod) {
  constexpr int scenes_each = 4, most_draws = 200;
  std::int64_t scenes = 0, draws = 0;
  for (auto const& variant : variants()) {
    int done = 0;
    for (int draw = 0; done < scenes_each && draw < most_draws && !HasFailure(); ++draw) {
      RandomRun random(random_seed(), ++draws);
      auto const text = random.scene(variant);
      auto const precision =
          random.one_in(2) ? Precision::single_precision : Precision::double_precision;
      done += gives_the_bits_of_one_run(text, precision, 1 + random.below(RandomRun::steps - 1));
    }
    EXPECT_EQ(done, scenes_each) << variant.method->word;
    scenes += done;
  }
  std::printf("    %lld scenes, %zu variants of methods\n", static_cast<long long>(scenes),
              variants().size());
  EXPECT_GE(scenes, 200);
}

TEST(Restarting, BeginsAnewAfterSpinsWereGiven) {
  auto const scene = llg_scene("0.1", "ab2", 40, chain_of_nine);
  auto const file = fs::path(testing::TempDir()) / fmt::format("restarting_{}.h5", ::getpid());
  auto const other = scene_of(scene.text, {"initial={uniform=[1,2,3]}"});
  auto const start = SceneRun::open(other, {});
  auto const run = SceneRun::open(scene, {});
  run->advance(5);
  run->set_spins(start->spins().vectors);
  run->save(file);
  auto const second = SceneRun::open(scene, {.restart = file});
  run->advance(7);
  second->advance(7);
  EXPECT_EQ(spins_of(*second), spins_of(*run));
  fs::remove(file);
}

// A field of the program throws once; the step is then repeated from spins that energy control has
// corrected already.
TEST(Restarting, CorrectsTheEnergyOnceIfAStepFails) {
  auto scene = llg_scene("0", "heun", 40, chain_of_nine);
  scene = io::with_overrides(scene, {"integrator.energy_control=true"});
  auto const file = fs::path(testing::TempDir()) / fmt::format("control_{}.h5", ::getpid());
  auto const run_of = [&](int failing_call, std::optional<fs::path> const& restart = {}) {
    auto const calls_left = std::make_shared<int>(-1);
    scene.field.own.nonlocal = [calls_left](io::HostVectors const&, io::HostVectors const& field,
                                            double) {
      if ((*calls_left)-- == 0) throw std::runtime_error("once");
      auto* const data = static_cast<double*>(field.data);
      for (int i = 0; i < 9; ++i)
        for (int c = 0; c < 3; ++c) data[i * field.strides[2] + c * field.strides[3]] = 0.1 * c;
    };
    auto run = SceneRun::open(scene, {.restart = restart});
    *calls_left = failing_call;
    return run;
  };
  auto const whole = run_of(-1);
  whole->advance(20);
  for (int const failing_call : {12, 13, 14}) {  // not all of these are by energy control
    auto const failed = run_of(failing_call);
    EXPECT_THROW(failed->advance(20), std::runtime_error);
    ASSERT_GT(failed->steps(), 0);
    failed->save(file);
    auto const restarted = run_of(-1, file);
    for (auto* const run : {failed.get(), restarted.get()}) {
      run->advance(20 - run->steps());
      EXPECT_EQ(spins_of(*run), spins_of(*whole)) << failing_call;
    }
  }
  fs::remove(file);
}

// The guard checks a lattice of so many sites after every tenth step of the scene, wherever the
// pieces end.
TEST(Restarting, DoesNotChangeWhereARunComesToRest) {
  auto const scene = scene_of(
      "system = { kind = 'llg', damping = 0.5 }\nlattice = { shape = [65, 64] }\n"
      "field = { applied = [0, 0, 1] }\ninitial = { uniform = [1, 0, 0] }\n"
      "integrator = { method = 'rkmk4', dt = 0.05, end = 40, until_torque = 1e-3 }\n");
  auto const steps_in_pieces_of = [&](std::int64_t count) {
    auto const run = SceneRun::open(scene, {});
    auto ended = Advanced::whole;
    while (ended == Advanced::whole && run->steps() + count <= scene.integrator.steps)
      ended = run->advance(count, {.period = 10, .until_torque = true, .at_end = true});
    EXPECT_EQ(ended, Advanced::at_rest);
    return run->steps();
  };
  EXPECT_EQ(steps_in_pieces_of(37), steps_in_pieces_of(800));
}

// If a poll returns true, the request, for example one of Python's signals, has been passed to the
// run, which then must report that it was interrupted.
TEST(Interrupting, IsNotAskedAfterTheLastStep) {
  auto scene = llg_scene("0.1", "rkmk4", 40, chain_of_nine);
  auto const wait = std::make_shared<std::chrono::milliseconds>(0);
  scene.field.own.uniform = [wait](double) {
    std::this_thread::sleep_for(*wait);
    return std::array<double, 3>{0.1, 0.2, 0.3};
  };
  auto const run = SceneRun::open(scene, {});
  run->advance(1);
  *wait = std::chrono::milliseconds(30);  // after the plan's evaluation of the field
  bool ever_said_yes = false;
  for (std::int64_t const count : {1, 2, 3}) {
    bool said_yes = false;
    auto const ended =
        run->advance(count, {.period = 1000, .interrupted = [&] { return said_yes = true; }});
    EXPECT_EQ(ended, said_yes ? Advanced::interrupted : Advanced::whole) << count;
    ever_said_yes = ever_said_yes || said_yes;
  }
  EXPECT_TRUE(ever_said_yes);
}

}  // namespace
}  // namespace cayspin::simulation::test
