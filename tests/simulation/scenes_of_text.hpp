// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/larger.hpp"
#include "simulation/scene_run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::simulation::test {

inline constexpr double pi = std::numbers::pi;

inline constexpr Precision precisions[] = {Precision::double_precision,
                                           Precision::single_precision};

inline double epsilon(Precision precision) {
  return precision == Precision::double_precision ? std::numeric_limits<double>::epsilon()
                                                  : std::numeric_limits<float>::epsilon();
}

inline io::Scene scene_of(std::string const& text, std::vector<std::string> const& overrides = {}) {
  return io::parse_scene(text, "scene.toml", overrides);
}

/// Returns a scene of spins with steps of 0.02. `tables` are all tables but [system] and
/// [integrator].
inline io::Scene llg_scene(std::string_view damping, std::string_view method, int steps,
                           std::string const& tables) {
  return scene_of(
      fmt::format("system = {{ kind = 'llg', damping = {} }}\n"
                  "integrator = {{ method = '{}', dt = 0.02, steps = {} }}\n{}",
                  damping, method, steps, tables));
}

inline std::vector<double> spins_of(SceneRun& run) { return packed<double>(run.spins().vectors); }

inline std::vector<double> end_of(io::Scene const& scene,
                                  Precision precision = Precision::double_precision) {
  auto const run = SceneRun::open(scene, {.precision = precision});
  run->advance(scene.integrator.steps);
  return spins_of(*run);
}

inline double largest_distance(std::vector<double> const& a, std::vector<double> const& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = cayspin::test::larger(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// Expects bitwise identical results and equal counts from two computations: a run that is not
/// interrupted, and a run that is stored after `cut` steps and continued by another run to the
/// scene's end.
inline void expect_same_bits_after_a_break(io::Scene const& scene, std::int64_t cut,
                                           Precision precision = Precision::double_precision) {
  auto const file =
      std::filesystem::path(testing::TempDir()) / fmt::format("break_{}.h5", ::getpid());
  std::int64_t const steps = scene.integrator.steps;
  auto const whole = SceneRun::open(scene, {.precision = precision});
  whole->advance(cut);
  whole->advance(steps - cut);
  auto const first = SceneRun::open(scene, {.precision = precision});
  first->advance(cut);
  first->save(file);
  auto const second = SceneRun::open(scene, {.precision = precision, .restart = file});
  EXPECT_EQ(second->steps(), cut);
  EXPECT_EQ(spins_of(*second), spins_of(*first));
  second->advance(steps - cut);
  EXPECT_EQ(spins_of(*second), spins_of(*whole));
  EXPECT_EQ(second->steps(), steps);
  EXPECT_EQ(second->sample().energy.value, whole->sample().energy.value);
  EXPECT_EQ(first->evaluations() + second->evaluations(), whole->evaluations());
  EXPECT_EQ(first->own_steps() + second->own_steps(), whole->own_steps());
  EXPECT_EQ(first->rejected_steps() + second->rejected_steps(), whole->rejected_steps());
  std::filesystem::remove(file);
}

/// Expects the scene that `make` returns to be refused, by `make` or by the plan, in one line with
/// these words.
template <class Make>
void expect_refused(Make const& make, std::string const& words) {
  try {
    make_plan(make(), Precision::double_precision);
    ADD_FAILURE() << "taken, and not refused for: " << words;
  } catch (io::SceneError const& error) {
    std::string const text = error.what();
    EXPECT_NE(text.find(words), std::string::npos) << text;
    EXPECT_NE(text.find("; accepted: "), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

}  // namespace cayspin::simulation::test
