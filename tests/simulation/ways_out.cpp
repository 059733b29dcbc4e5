// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Searches for a way out of the state of a scene.
#include "scenes_of_text.hpp"
#include "simulation/scene_path.hpp"

#include <cstdint>

namespace cayspin::simulation::test {
namespace {

// The state, its modes, the climbs and the path are parts of one search.
TEST(WaysOut, ReportEvaluationsOfTheWholeSearch) {
  auto const scene = llg_scene("0.1", "rkmk4", 1,
                               "lattice = { shape = [3] }\n"
                               "field = { exchange = 20.0, anisotropy = [{ constant = 1.3, axis = "
                               "[0, 0, 1] }, { constant = -0.7, axis = [0, 1, 0] }] }\n"
                               "initial = { uniform = [0, 0, 1] }");
  for (auto const precision : precisions) {
    auto const run = SceneRun::open(scene, {.precision = precision});
    bool const is_double = precision == Precision::double_precision;
    ScenePathOptions options{.torque = is_double ? 1e-6 : 1e-3, .modes = 2};
    std::int64_t last = 0;
    options.observer = [&](PathProgress const& now) {
      EXPECT_GE(now.evaluations, last);
      last = now.evaluations;
      return Next::proceed;
    };
    auto const found =
        find_scene_path(scene, spins_of(*run), {}, run->space(), precision, options, "");
    EXPECT_EQ(found.end, PathEnd::converged);
    EXPECT_GE(found.path.evaluations, last);
    EXPECT_NEAR(found.path.energy.at(0), -3 * 0.5 * 1.3, 1e4 * epsilon(precision));
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
