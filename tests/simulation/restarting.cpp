// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A run that was stored and goes on is the run without a break: the same bits and counts, by every
// method.
#include "random_run.hpp"
#include "simulation/failure.hpp"
#include "simulation/scene_run.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

namespace cayspin::simulation::test {
namespace {

namespace fs = std::filesystem;

std::uint64_t seed() {
  char const* const asked = std::getenv("CAYSPIN_SEED");
  return asked ? std::strtoull(asked, nullptr, 10) : 1;
}

struct State {
  std::vector<double> spins;
  std::int64_t steps, evaluations, own_steps, rejected;
  double energy;

  bool operator==(State const&) const = default;
};

State state_of(SceneRun& run, SceneRun const* before = nullptr) {
  auto const sum = [&](auto member) {
    return (run.*member)() + (before ? (before->*member)() : 0);
  };
  return {packed<double>(run.spins().vectors), run.steps(),
          sum(&SceneRun::evaluations),         sum(&SceneRun::own_steps),
          sum(&SceneRun::rejected_steps),      run.sample().energy.value};
}

class Restarting : public testing::Test {
 protected:
  Restarting() { fs::create_directories(folder_); }
  ~Restarting() override { fs::remove_all(folder_); }

  /// Runs a scene without and with a break after `cut` steps. False when it has no meaning.
  bool holds(std::string const& text, Precision precision, std::int64_t cut) {
    std::optional<io::Scene> scene;
    try {
      scene = io::parse_scene(text, "scene.toml");
    } catch (io::SceneError const&) {
      return false;
    }
    SCOPED_TRACE(fmt::format("{}{} precision, cut after {} steps, seed {}", text,
                             to_string(precision), cut, seed()));
    auto const whole = SceneRun::open(*scene, {.precision = precision});
    try {
      whole->advance(cut);
      whole->advance(RandomRun::steps - cut);
    } catch (NumbersFailed const&) {
      return false;
    }
    auto const first = SceneRun::open(*scene, {.precision = precision});
    first->advance(cut);
    first->save(file_);
    auto const second = SceneRun::open(*scene, {.precision = precision, .restart = file_});
    EXPECT_EQ(second->steps(), cut);
    EXPECT_EQ(state_of(*second).spins, state_of(*first).spins);
    second->advance(RandomRun::steps - cut);
    auto const one = state_of(*whole), two = state_of(*second, first.get());
    EXPECT_EQ(two.spins, one.spins);
    EXPECT_EQ(two, one) << two.evaluations << ' ' << one.evaluations << ", " << two.own_steps << ' '
                        << one.own_steps << ", " << two.rejected << ' ' << one.rejected;
    return true;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / fmt::format("restarting_{}", ::getpid());
  fs::path file_ = folder_ / "run.checkpoint.h5";
};

TEST_F(Restarting, GivesTheBitsOfARunWithoutABreakByEveryMethod) {
  constexpr int scenes_each = 4, most_draws = 200;
  std::int64_t scenes = 0, draws = 0;
  for (auto const& variant : variants()) {
    int done = 0;
    for (int draw = 0; done < scenes_each && draw < most_draws && !HasFailure(); ++draw) {
      RandomRun random(seed(), ++draws);
      auto const text = random.scene(variant);
      auto const precision =
          random.one_in(2) ? Precision::single_precision : Precision::double_precision;
      done += holds(text, precision, 1 + random.below(RandomRun::steps - 1));
    }
    EXPECT_EQ(done, scenes_each) << variant.method->word;
    scenes += done;
  }
  std::printf("    %lld scenes, %zu variants of methods\n", static_cast<long long>(scenes),
              variants().size());
  EXPECT_GE(scenes, 200);
}

TEST_F(Restarting, BeginsAnewAfterSpinsWereGiven) {
  auto const scene = io::parse_scene(R"(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [9]
[field]
exchange = 1.0
[initial]
random = { seed = 4 }
[integrator]
method = "ab2"
dt = 0.02
steps = 40
)",
                                     "scene.toml");
  auto const other = io::parse_scene(scene.text, "scene.toml", {"initial={uniform=[1,2,3]}"});
  auto const start = SceneRun::open(other, {});
  auto const run = SceneRun::open(scene, {});
  run->advance(5);
  run->set_spins(start->spins().vectors);
  run->save(file_);
  auto const second = SceneRun::open(scene, {.restart = file_});
  run->advance(7);
  second->advance(7);
  EXPECT_EQ(state_of(*second).spins, state_of(*run).spins);
}

}  // namespace
}  // namespace cayspin::simulation::test
