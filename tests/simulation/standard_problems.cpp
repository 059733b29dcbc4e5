// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The shipped scenes of muMAG's standard problems, on coarse cells.
// docs/reports/standard_problems.md has results on finer ones.
#include "io/relax.hpp"
#include "scenes_of_text.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

std::unique_ptr<SceneRun> open(std::string const& name, std::vector<std::string> const& overrides) {
  auto const path = std::string(CAYSPIN_SCENES "/standard_problem_") + name + ".toml";
  return SceneRun::open(io::read_scene_to_run_or_relax(path, overrides), {});
}

Minimum relax(SceneRun& run, RelaxSettings const& settings) {
  auto const found = run.relax(settings);
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  return found;
}

void expect_magnetization(SceneRun& run, Vec3<double> const& theirs, double limit) {
  auto const m = run.sample().magnetization;
  EXPECT_NEAR(m.x, theirs.x, limit);
  EXPECT_NEAR(m.y, theirs.y, limit);
  EXPECT_NEAR(m.z, theirs.z, limit);
}

// Walls stick to cells of 40 nm, so -50 mT need not reverse the whole film.
TEST(StandardProblems, OneIsReversedAlongItsLongAxis) {
  auto const run =
      open("1", {"field.applied=[0, 0, 0]", "lattice.shape=[50, 25, 1]", "lattice.spacing=40e-9"});
  auto const along = [&](double tesla) {
    relax(*run, {.applied = {{tesla, 0.01746 * tesla, 0}}});
    return run->sample().magnetization.x;
  };
  EXPECT_GT(along(50e-3), 0.95);
  EXPECT_GT(along(0), 0.7);
  EXPECT_LT(along(-100e-3), -0.95);
}

// Donahue et al. 2000: in a field along (1, 1, 1) a small particle has Hc = 0.057069478 * Ms.
TEST(StandardProblems, TwoHasTheCoercivityOfASmallParticle) {
  auto const run = open("2", {"field.applied=[0, 0, 0]", "lattice.spacing=0.01"});
  auto const along = [&](double field) {
    double const h = field / std::sqrt(3);
    EXPECT_LE(relax(*run, {.applied = {{h, h, h}}}).evaluations, 150);
    auto const m = run->sample().magnetization;
    return m.x + m.y + m.z;
  };
  for (double const field : {0.5, 0.1, 0.0, -0.04, -0.055}) along(field);
  EXPECT_GT(along(-0.05705), 0);
  EXPECT_LT(along(-0.05709), 0);
}

// Half a hysteresis loop of a larger particle, including its jump, on cells of 3 and 1.5 exchange
// lengths.
TEST(StandardProblems, TwoTakesFewEvaluationsAState) {
  for (std::string const cells : {"lattice={ shape = [50, 10, 1], spacing = [3, 3, 3] }",
                                  "lattice={ shape = [100, 20, 1], spacing = [1.5, 1.5, 3] }"}) {
    auto const run = open("2", {"field.applied=[0, 0, 0]", cells});
    auto const to = [&](double field) {
      double const h = field / std::sqrt(3);
      EXPECT_LE(relax(*run, {.applied = {{h, h, h}}}).evaluations, 150) << cells << field;
    };
    for (double const field : {0.5, 0.2, 0.1, 0.05, 0.02, 0.0}) to(field);
    for (int step = 1; step <= 12; ++step) to(-0.005 * step);
    EXPECT_LT(run->sample().magnetization.x, -0.8);
  }
}

// Rave, Fabian and Hubert 1998: in a cube with edges of 8.47 exchange lengths, flower and vortex
// have equal energy densities, 0.3027 * Km with Km = mu0 * Ms^2 / 2. The flower is a saddle.
TEST(StandardProblems, ThreeHasAFlowerAndAVortexOfOneEnergy) {
  for (std::string const cells : {"10", "20"}) {
    std::string const shape = "lattice.shape=[" + cells + "," + cells + "," + cells + "]";
    double const n = std::stod(cells), edge = cells == "10" ? 8.4023 : 8.4535;
    std::string const spacing = "lattice.spacing=" + std::to_string(edge / n);
    auto const flower = open("3", {shape, spacing, "initial={ uniform = [0, 0, 1] }"});
    auto const vortex = open("3", {shape, spacing});
    auto const in_km = [&](Minimum const& found) {
      EXPECT_LE(found.evaluations, 150) << cells;
      return 2 * found.energy.value / (n * n * n) + 0.1;
    };
    double const of_flower = in_km(relax(*flower, {.keep_saddles = true}));
    double const of_vortex = in_km(relax(*vortex, {}));
    EXPECT_NEAR(of_flower, of_vortex, 2e-5) << cells;
    EXPECT_NEAR(of_flower, 0.3027, 1e-3) << cells;
    expect_magnetization(*flower, {0, 0, 0.971}, 1e-3);
    EXPECT_NEAR(vortex->sample().magnetization.x, 0.35, 0.01);
    relax(*flower, {});
    EXPECT_LT(in_km({.energy = flower->sample().energy}), of_flower - 5e-4);
  }
}

// In OOMMF on 200 x 50 cells, <m_x> first vanishes at 0.1385 ns.
TEST(StandardProblems, FourCrossesZero) {
  auto const run = open("4", {"lattice.shape=[100, 25, 1]", "lattice.spacing=[5e-9, 5e-9, 3e-9]"});
  relax(*run, {.applied = {{0, 0, 0}}});
  run->advance(108);  // steps of 1.25 ps
  EXPECT_GT(run->sample().magnetization.x, 0);
  run->advance(4);
  EXPECT_LT(run->sample().magnetization.x, 0);
}

// Values of mumax3's test standardproblem5.mx3. mumax3's demagnetising tensor differs, and its u is
// smaller by a factor of 1 + xi^2.
TEST(StandardProblems, FiveIsAsInMumax3) {
  std::vector<std::string> const size{"lattice.shape=[32, 32, 4]",
                                      "lattice.spacing=[3.125e-9, 3.125e-9, 2.5e-9]"};
  auto const start = open("5_start", size);
  EXPECT_LE(relax(*start, {}).evaluations, 150);
  auto overrides = size;
  overrides.emplace_back("material.gamma=1.7595e11");
  overrides.emplace_back("torque.zhang_li.velocity=[-72.17, 0, 0]");
  auto const run = open("5", overrides);
  run->set_spins(start->spins().vectors);
  run->advance(800);
  expect_magnetization(*run, {-0.23479773, -0.09453578, 0.02296375}, 3e-4);
}

}  // namespace
}  // namespace cayspin::simulation::test
