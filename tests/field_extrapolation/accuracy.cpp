// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders, the local solve alone, the estimated error, and the largest stable step.
#include "rotating_slab.hpp"

#include <array>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using Fx3 = FieldExtrapolation3<Spins>;
using Fx4 = FieldExtrapolation4<Spins>;

Boundary const open = Boundary::open, periodic = Boundary::periodic;
Lattice const cube{{4, 3, 3}, {1, 1.1, 0.9}, {periodic, open, open}};

struct Ladder {
  Ladder(RotatingSlab const& generator, Lattice const& lattice, double end_time)
      : generator(generator),
        start(random_spins(lattice, 3)),
        end_time(end_time),
        reference(run<Rkmk4<Spins>>(generator, start, end_time / 3000, 3000)) {}

  template <class Stepper>
  void expect(char const* what, double order) const {
    expect_convergence(
        what, end_time, std::array{40, 80, 160, 320}, order, 0.15, [&](int steps, double dt) {
          return largest_distance(run<Stepper>(generator, start, dt, steps), reference);
        });
  }

  RotatingSlab generator;
  Spins start;
  double end_time;
  Spins reference;
};

TEST(FieldExtrapolation, OrdersOnACoupledChainInARotatingField) {
  for (double const damping : {0.05, 1.0}) {
    Lattice const chain = Lattice::chain(8);
    Ladder const ladder(rotating_slab(hard_magnet(chain, damping), 0.6), chain, 1);
    ladder.expect<Fx3>("chain, order 3", 3);
    ladder.expect<Fx4>("chain, order 4", 4);
  }
}

TEST(FieldExtrapolation, OrdersOnACubicLattice) {
  for (double const damping : {0.05, 1.0}) {
    Ladder const ladder(rotating_slab(hard_magnet(cube, damping), 0.6), cube, 0.5);
    ladder.expect<Fx3>("cubic, order 3", 3);
    ladder.expect<Fx4>("cubic, order 4", 4);
  }
  static_assert(Fx3::order == 3 && Fx4::order == 4);
}

// Without other spins there is nothing to extrapolate: every step is one of Rkmk4.
TEST(FieldExtrapolation, OneSpinIsSolvedAsByRkmk4) {
  Lattice const one = Lattice::chain(1);
  Slab slab{.lattice = one, .applied = {0, 0, 2}, .damping = 0};
  Spins const start = random_spins(one, 3);
  for (bool const anisotropic : {false, true}) {
    if (anisotropic) slab = hard_magnet(one, 0.1);
    Ladder const ladder(rotating_slab(slab, anisotropic ? 0.6 : 0), one, 3);
    ladder.expect<Fx3>("one spin, order 3", 4);
    ladder.expect<Fx4>("one spin, order 4", 4);
    auto const end = run<Fx3>(ladder.generator, start, 0.1, 30);
    EXPECT_LT(largest_distance(end, run<Rkmk4<Spins>>(ladder.generator, start, 0.1, 30)), 1e-14);
  }
}

/// The angle by which the step from `spins` at t missed, over spins.
template <class Stepper>
double missed(Stepper& stepper, RotatingSlab const& generator, Spins& spins, double t, double dt) {
  Spins exact = copy_of(spins);
  Rkmk4<Spins> fine(exact);
  for (int n = 0; n < 20; ++n) fine.step(Space{}, generator, exact, t + n * dt / 20, dt / 20);
  stepper.step(Space{}, generator, spins, t, dt);
  return largest_distance(spins, exact);
}

/// The estimate over the true error, its least and largest over steps; every other step is half as
/// long where they are unequal.
template <class Stepper>
void expect_ratio(char const* what, Slab const& slab, double dt, bool unequal, double least,
                  double most) {
  auto const generator = rotating_slab(slab, 0.6);
  Spins spins = random_spins(slab.lattice, 3);
  Stepper stepper(spins);
  double t = 0, before = 0, low = 1e9, high = 0;
  for (int n = 0; n < 16; ++n) {
    double const step = unequal && n % 2 == 1 ? 0.5 * dt : dt;
    double const error = missed(stepper, generator, spins, t, step);
    t += step;
    double const ratio = stepper.last_error(Space{}) / before;
    EXPECT_EQ(std::isnan(ratio), n < Stepper::order) << n;
    if (n >= Stepper::order) low = std::min(low, ratio), high = std::max(high, ratio);
    before = error;
  }
  std::printf("    %-40s dt %-6g estimate over error %.3f .. %.3f\n", what, dt, low, high);
  EXPECT_GT(low, least) << what << ' ' << dt;
  EXPECT_LT(high, most) << what << ' ' << dt;
  EXPECT_EQ(stepper.starts(), 1);
}

TEST(FieldExtrapolation, EstimatesItsError) {
  using Estimating3 = FieldExtrapolation3<Spins, true>;
  using Estimating4 = FieldExtrapolation4<Spins, true>;
  for (double const damping : {0.05, 1.0})
    for (double const dt : {0.04, 0.01})
      for (bool const unequal : {false, true}) {
        auto const* const what = unequal ? "unequal steps" : "equal steps";
        expect_ratio<Estimating3>(what, hard_magnet(cube, damping), dt, unequal, 0.9, 1.2);
        expect_ratio<Estimating4>(what, hard_magnet(cube, damping), dt, unequal, 0.9, 1.2);
      }
}

/// The factor by which the mode of opposite neighbours has changed from one time to a later one.
template <class Stepper>
double growth(Slab const& slab, bool orthogonal, double dt, int from, int to) {
  auto const amplitude = [&](Spins const& spins) {
    Vector sum{0, 0, 0};
    for (std::int64_t n = 0; n < spins.sites(); ++n)
      sum = sum + (n % 2 == 0 ? 1.0 : -1.0) * spin(spins, n);
    return length(sum);
  };
  auto const start = make_spins(slab.lattice, [](auto i, auto, auto) {
    double const mode = i % 2 == 0 ? 1e-7 : -1e-7;
    return Vector{mode, mode, 1};
  });
  auto const after = [&](int steps) {
    return amplitude(orthogonal ? run<Stepper>(slab.orthogonal(), start, dt, steps)
                                : run<Stepper>(slab.natural(), start, dt, steps));
  };
  return after(to) / after(from);
}

// On a periodic chain half of the stiffest mode's rate is due to the neighbours, as is supposed.
template <class Stepper>
void expect_first_growth_at_the_limit(char const* method) {
  for (double const damping : {0.02, 0.1, 0.5, 1.0}) {
    Slab slab{.lattice = Lattice::chain(16), .exchange = 1, .damping = damping};
    slab.lattice.boundary[0] = periodic;
    double const s = slab.field_bound(), limit = largest_stable_step<Stepper>(s, damping);
    double largest = 0;  // of either generator
    for (bool const orthogonal : {false, true}) {
      EXPECT_LT(growth<Stepper>(slab, orthogonal, 0.998 * limit, 400, 1200), 1) << damping;
      double const above = growth<Stepper>(slab, orthogonal, 1.002 * limit, 400, 1200);
      EXPECT_GT(above, 1) << damping;
      largest = std::max(largest, above);
    }
    std::printf("    %s, damping %g: dt s = %.4f, at 1.002 of it times %.2e in 800 steps\n", method,
                damping, s * limit, largest);

    // A priori: never above, with local fields and open ends.
    slab.lattice.boundary[0] = open;
    slab.applied = {0, 0, 1};
    slab.anisotropy = 0.5;
    double const bound = largest_stable_step<Stepper>(slab.field_bound(), damping);
    EXPECT_LT(growth<Stepper>(slab, false, bound, 20, 100), 1);
    EXPECT_GT(growth<Stepper>(slab, false, 2 * bound, 20, 100), 1);
  }
}

TEST(FieldExtrapolation, LargestStableStep) {
  expect_first_growth_at_the_limit<Fx3>("order 3");
  expect_first_growth_at_the_limit<Fx4>("order 4");
  EXPECT_EQ(largest_stable_step<Fx3>(0, 0.1), std::numeric_limits<double>::infinity());
}

}  // namespace
