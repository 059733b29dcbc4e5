// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Noise about a uniform state decays for dt just below the measured limit and grows just above it.
// The a-priori bound is below the measured limits.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <numbers>
#include <random>

using namespace cayspin;
using namespace cayspin::test;

namespace {

struct Measured {
  char const* name;
  Lattice lattice;
  double damping, euler, heun, rkmk4;
};

std::array<Boundary, 3> const all_open{Boundary::open, Boundary::open, Boundary::open};
Measured const rows[] = {
    {"fine_chain", Lattice::chain(100, 0.01), .05, 2.49398e-6, 1.99672e-5, 7.26586e-5},
    {"fine_chain_damped", Lattice::chain(100, 0.01), 1, 2.50022e-5, 3.85955e-5, 4.78108e-5},
    {"chain", Lattice::chain(100), .05, 1.3351e-2, 1.06817e-1, 3.88384e-1},
    {"plane", {{16, 12, 1}, {0.2, 0.3, 1}, all_open}, .05, 6.82123e-4, 5.46117e-3, 1.98726e-2},
    {"block", {{8, 7, 6}, {0.2, 0.25, 0.3}, all_open}, .05, 4.93801e-4, 3.95345e-3, 1.43862e-2},
};

Slab slab_of(Measured const& row) {
  return {.lattice = row.lattice,
          .exchange = 1,
          .anisotropy = 1,
          .demag = 1,
          .applied = {5, 0, 0},
          .damping = row.damping};
}

/// The stable state (1, 0, 0) with the stiffest mode, of amplitude 1e-6, and noise of 1e-9.
Spins disturbed(Lattice const& lattice) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise(0, 1e-9);
  auto const& n = lattice.shape;
  auto const wave = [&](int a, auto i) {
    return std::cos(std::numbers::pi * (n[a] - 1) * (i + 0.5) / n[a]);
  };
  return make_spins(lattice, [&](auto i, auto j, auto k) {
    double const mode = 1e-6 * wave(0, i) * wave(1, j) * wave(2, k);
    return Vector{1, mode + noise(engine), mode + noise(engine)};
  });
}

double size(Spins const& spins) {
  auto const numbers = copy_to_host(spins);
  double square = 0;
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    square += numbers[i + 1] * numbers[i + 1] + numbers[i + 2] * numbers[i + 2];
  return std::sqrt(square / static_cast<double>(spins.sites()));
}

/// Returns the factor by which the disturbance has changed.
template <class Stepper>
double growth(Measured const& row, double dt, int steps) {
  Spins const start = disturbed(row.lattice);
  return size(run<Stepper>(slab_of(row).orthogonal(), start, dt, steps)) / size(start);
}

class Growth : public ::testing::TestWithParam<Measured> {
 protected:
  template <class Stepper>
  void expect(char const* method, double limit, int steps) const {
    Measured const& row = GetParam();
    double const below = growth<Stepper>(row, 0.98 * limit, steps);
    double const above = growth<Stepper>(row, 1.02 * limit, steps);
    double const bound = largest_stable_step<Stepper>(slab_of(row).field_bound(), row.damping);
    std::printf("    %-8s at .98 of %.5g: times %.2e, at 1.02: times %.2e; a-priori %.5g\n", method,
                limit, below, above, bound);
    EXPECT_LT(below, 0.5);
    EXPECT_GT(above, 2);
    EXPECT_LE(bound, 1.0002 * limit);
    EXPECT_GT(bound, 0.4 * limit);
  }
};

TEST_P(Growth, LieEuler) {
  expect<LieEuler<Spins>>("Euler", GetParam().euler, GetParam().damping < 0.1 ? 20000 : 1000);
}

TEST_P(Growth, LieHeun) {
  expect<LieHeun<Spins>>("Heun", GetParam().heun, GetParam().damping < 0.1 ? 5000 : 1000);
}

TEST_P(Growth, StereographicRk4) {
  expect<StereographicRungeKutta<Spins, tableau::Classical4>>("chart", GetParam().rkmk4, 1000);
}

TEST_P(Growth, Rkmk4) { expect<Rkmk4<Spins>>("rkmk4", GetParam().rkmk4, 1000); }

INSTANTIATE_TEST_SUITE_P(Lattices, Growth, ::testing::ValuesIn(rows),
                         [](auto const& info) { return std::string(info.param.name); });

}  // namespace
