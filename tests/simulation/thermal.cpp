// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs at a temperature give bitwise identical results in pieces, with any period of checks and
// after a restart, in random scenes of many methods.
#include "random_run.hpp"
#include "scenes_of_text.hpp"
#include "simulation/failure.hpp"

#include <cstdio>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <vector>

namespace cayspin::simulation::test {
namespace {

namespace fs = std::filesystem;

class ThermalRuns : public testing::Test {
 protected:
  ThermalRuns() { fs::create_directories(folder_); }
  ~ThermalRuns() override { fs::remove_all(folder_); }

  /// Repeats the run in pieces, after a restart, and step by step. Returns false if the scene is
  /// invalid, or the run fails with values that are not finite.
  bool holds(std::string const& text, Precision precision, RandomRun& random) const {
    std::optional<io::Scene> scene;
    std::unique_ptr<SceneRun> whole;
    auto const steps = RandomRun::steps, cut = 1 + random.below(steps - 1);
    auto const open = [&](std::optional<fs::path> const& restart = {}) {
      return SceneRun::open(*scene, {.precision = precision, .restart = restart});
    };
    try {
      scene = scene_of(text);
      whole = open();
      whole->advance(steps, {.period = steps});
    } catch (io::SceneError const&) {
      return false;
    } catch (NumbersFailed const&) {
      return false;
    }
    SCOPED_TRACE(text + std::string(to_string(precision)) + " precision, cut after " +
                 std::to_string(cut));
    auto const expected = spins_of(*whole);

    auto const cut_run = open();
    cut_run->advance(cut, {.period = 1 + random.below(7)});
    cut_run->save(file_);
    auto const restarted = open(file_);
    EXPECT_EQ(restarted->steps(), cut);
    for (auto const* const run : {&cut_run, &restarted}) {
      (*run)->advance(steps - cut, {.period = 1 + random.below(7)});
      EXPECT_EQ(spins_of(**run), expected);
    }
    auto const one_by_one = open();
    for (std::int64_t step = 0; step < steps; ++step) one_by_one->advance(1);
    EXPECT_EQ(spins_of(*one_by_one), expected);
    EXPECT_LT(one_by_one->sample().norm_defect,
              precision == Precision::double_precision ? 1e-13 : 1e-4);
    return true;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / fmt::format("thermal_{}", ::getpid());
  fs::path file_ = folder_ / "run.checkpoint.h5";
};

TEST_F(ThermalRuns, HaveTheSameBitsInRandomScenes) {
  auto const wanted = setting("CAYSPIN_THERMAL_SCENES", 40);
  std::int64_t scenes = 0;
  std::set<std::string_view> methods;
  for (std::int64_t draw = 0; scenes < wanted && draw < 50 * wanted && !HasFailure(); ++draw) {
    RandomRun random(random_seed(), draw);
    // Draws are spaced by a prime larger than the number of variants, so that each variant is drawn
    // once per round.
    auto const& variant = variants()[(10007 * static_cast<std::size_t>(draw)) % variants().size()];
    auto const text =
        random.scene(variant) + fmt::format("[thermal]\ntemperature = {}\nseed = {}\n",
                                            random.one_in(2) ? 0.6 : 0.05, random.below(1000));
    auto const precision =
        random.one_in(2) ? Precision::single_precision : Precision::double_precision;
    if (!holds(text, precision, random)) continue;
    ++scenes;
    methods.insert(variant.method->word);
  }
  std::printf("    %lld scenes of %zu methods\n", static_cast<long long>(scenes), methods.size());
  EXPECT_EQ(scenes, wanted);
  EXPECT_GE(methods.size(), 12U);
}

io::Scene thermal_chain() {
  return llg_scene("0.1", "heun", 100,
                   std::string(chain_of_nine) + "thermal = { temperature = 0.5 }\n");
}

TEST(ThermalPlan, RefusesMethodsThatRememberSteps) {
  for (auto const& keys : std::vector<std::vector<std::string>>{
           {"integrator.method='ab2'"},
           {"integrator.method='euler'", "integrator.isotropy='finite_difference_backward'"}})
    expect_refused([&] { return io::with_overrides(thermal_chain(), keys); },
                   "integrator.method: remembers steps");
}

std::int64_t fences_of_noise = 0;

// Only observations wait for noise; nothing does between two of them.
TEST_F(ThermalRuns, WaitForNoiseOnlyAtLooks) {
  namespace tools = Kokkos::Tools::Experimental;
  auto const run = SceneRun::open(thermal_chain(), {});
  tools::set_begin_fence_callback([](char const* label, std::uint32_t, std::uint64_t*) {
    if (std::string_view(label).starts_with("cayspin::RunNoise")) ++fences_of_noise;
  });
  run->advance(100, {.period = 10});
  tools::set_begin_fence_callback(nullptr);
  EXPECT_EQ(fences_of_noise, 10);
}

// A field of the program throws once; the step is then repeated with the same noise, also by a run
// that continues from a checkpoint, and after a change of keys.
TEST_F(ThermalRuns, GoOnAfterAFieldThatFailed) {
  auto const run_of = [&](int failing_call) {
    auto scene = thermal_chain();
    auto const calls_left = std::make_shared<int>(-1);
    scene.field.own.uniform = [calls_left](double) {
      if ((*calls_left)-- == 0) throw std::runtime_error("once");
      return std::array<double, 3>{0.1, 0.2, 0.3};
    };
    auto run = SceneRun::open(scene, {});
    *calls_left = failing_call;
    return run;
  };
  auto const whole = run_of(-1);
  whole->advance(9);
  for (int const failing_call : {3, 6, 9}) {
    auto const run = run_of(failing_call);
    while (run->steps() < 9) {
      try {
        run->advance(9 - run->steps(), {.period = 1000});
      } catch (std::runtime_error const& error) {
        EXPECT_STREQ(error.what(), "once");
      }
    }
    EXPECT_EQ(spins_of(*run), spins_of(*whole)) << failing_call;
  }
  auto const file = folder_ / "failed.h5";
  auto const failed = run_of(6);
  EXPECT_THROW(failed->advance(9, {.period = 1000}), std::runtime_error);
  failed->save(file);
  auto again = thermal_chain();
  again.field.own.uniform = [](double) { return std::array<double, 3>{0.1, 0.2, 0.3}; };
  auto const restarted = SceneRun::open(again, {.restart = file});
  EXPECT_EQ(restarted->steps(), failed->steps());
  failed->change({"integrator.steps=50"});
  for (auto* const run : {restarted.get(), failed.get()}) {
    run->advance(9 - run->steps());
    EXPECT_EQ(spins_of(*run), spins_of(*whole));
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
