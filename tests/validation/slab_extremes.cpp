// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The slab at equilibrium, with cells smaller than atoms, and with strong damping.
#include "../support/figures.hpp"
#include "../support/unit_slab.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

Vector const strong{5, 0, 0}, weak{0.05, 0.05, 0}, along_x{1, 0, 0}, along_z{0, 0, 1};

// Checks torque and energy, since beyond the stability limit a run may end at a maximum of the
// energy.
void expect_rest(char const* what, Slab const& slab, std::array<char const*, 3> const& figures) {
  Space const exec;
  Spins spins = slab_start();
  double const first = energy(exec, slab.field(), spins).value;
  Rkmk4<Spins> stepper(spins);
  double const dt =
      0.9 * largest_stable_step<Rkmk4<Spins>>(slab.field_bound(), 1, {.precession = false});
  advance(stepper, slab.natural(), spins, dt, std::llround(600 / dt));
  EXPECT_LT(largest_rate(exec, slab.natural(), spins), 1e-9);
  EXPECT_LT(energy(exec, slab.field(), spins).value, first);
  Vector const mean = magnetization(exec, spins);
  expect_figure(std::string(what) + ", m_x", mean.x, figures[0], 0);
  expect_figure(std::string(what) + ", m_y", mean.y, figures[1], 0);
  expect_figure(std::string(what) + ", m_z", mean.z, figures[2], 0);
  EXPECT_LT(length(spin(spins, 0) - mean), 1e-8) << "not uniform";
}

TEST(SlabAtRest, InStrongField) {
  expect_rest("(5, 0, 0)", unit_slab(strong, 1, false), {"1.00000", "0.00000", "0.00000"});
}

TEST(SlabAtRest, InWeakField) {
  expect_rest("(.05, .05, 0), axis z", unit_slab(weak, 1, false), {".025", ".050", ".998"});
  expect_rest("(.05, .05, 0), axis x", unit_slab(weak, 1, false, along_x),
              {".70711", ".70711", "0.00000"});
}

TEST(FineSlab, EulerBlowsUp) {
  Slab const slab = unit_slab(strong, 0.05, true, along_z, 0.01);
  auto const end = run<ClassicalEuler<Spins>>(slab.natural(), slab_start(0.01), 1e-4, 2000);
  EXPECT_TRUE(std::isnan(norm_defect(Space{}, end)));
}

template <class Generator>
void expect_restless(char const* what, Generator const& generator) {
  auto const end = run<LieEuler<Spins>>(generator, slab_start(0.01), 0.01, 6000);
  expect_below(std::string(what) + ", max ||m| - 1|", norm_defect(Space{}, end), 1e-13);
  double const rate = largest_rate(Space{}, generator, end);
  std::printf("    %-58s %.3g  (about 2e4)\n", (std::string(what) + ", largest |m'|").c_str(),
              rate);
  EXPECT_GT(rate, 1e4);
}

TEST(FineSlab, GeometricEulerStaysOnTheSphereAndNeverSettles) {
  expect_restless("damping .05, orthogonal",
                  unit_slab(strong, 0.05, true, along_z, 0.01).orthogonal());
  expect_restless("overdamped", unit_slab(strong, 1, false, along_z, 0.01).natural());
}

TEST(Slab, NormDriftOfClassicalRk4) {
  struct Row {
    double damping;
    char const *name, *drift;
  };
  for (Row const& row :
       {Row{0.05, ".05", "4.6e-9"}, Row{1, "1", "1.2e-7"}, Row{10, "10", "1.8e-4"}}) {
    Slab const slab = unit_slab(strong, row.damping, true, along_x);
    auto const drift = [&](double dt) {
      return norm_defect(Space{}, run<ClassicalRk4<Spins>>(slab.natural(), slab_start(), dt,
                                                           std::llround(1 / dt)));
    };
    std::string const name = std::string("classical rk4, damping ") + row.name;
    double const coarse = drift(0.01);
    expect_figure(name + ", dt .01, max ||m| - 1|", coarse, row.drift);
    // At damping .05 and 10, the drift at this dt is not a single power of dt.
    if (row.damping == 1)
      expect_figure(name + ", ratio to half the dt", coarse / drift(0.005), "16", 0.05);
  }
}

}  // namespace
