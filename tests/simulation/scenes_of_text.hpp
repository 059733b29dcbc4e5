// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/scene_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace cayspin::simulation::test {

inline constexpr Precision precisions[] = {Precision::double_precision,
                                           Precision::single_precision};

inline double epsilon(Precision precision) {
  return precision == Precision::double_precision ? std::numeric_limits<double>::epsilon()
                                                  : std::numeric_limits<float>::epsilon();
}

inline io::Scene scene_of(std::string const& text) { return io::parse_scene(text, "scene.toml"); }

inline std::vector<double> spins_of(SceneRun& run) {
  auto const spins = run.spins();
  if (run.precision() == Precision::double_precision) return packed<double>(spins.vectors);
  auto const single = packed<float>(spins.vectors);
  return {single.begin(), single.end()};
}

inline std::vector<double> end_of(io::Scene const& scene, Precision precision) {
  auto const run = SceneRun::open(scene, {.precision = precision});
  run->advance(scene.integrator.steps);
  return spins_of(*run);
}

inline double largest_distance(std::vector<double> const& a, std::vector<double> const& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace cayspin::simulation::test
