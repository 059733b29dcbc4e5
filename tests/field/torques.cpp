// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Torques as fields: their effect in the Landau-Lifshitz equation, motions in closed form, and the
// chirality of bulk DMI.
#include "../support/biquadratic_bonds.hpp"
#include "gradient.hpp"

#include <cayspin_paper/series4.hpp>

#include <numbers>

namespace cayspin::test {
namespace {

template <class Backend>
class Torques : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  using Method = Rkmk4<Spins, isotropy::Zero, Exponential>;
  typename Backend::Exec exec;

  /// Expects m' = t + damping * (m x t) at every site, where t is torque(m, site).
  template <class Term, class Torque>
  void check(Lattice const& lattice, Term const& term, Torque const& torque) const {
    auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 11));
    auto const m = numbers_of(spins);
    for (double const damping : {0.0, 0.3}) {
      LandauLifshitz const generator(EffectiveField{term}, damping);
      EXPECT_FALSE(generator.conserves_energy());
      auto const a = evaluated(exec, generator, spins);
      for (std::int64_t site = 0; site < lattice.sites(); ++site) {
        auto const t = torque(m, site);
        expect_near(cross(at(a, site), at(m, site)), t + damping * cross(at(m, site), t),
                    64 * epsilon<Real>);
      }
    }
    EXPECT_EQ(energy(exec, EffectiveField(term), spins).magnitude, 0);
  }

  /// Returns the spins after `time`.
  template <class Term>
  std::vector<double> moved(Lattice const& lattice, Term const& term, double damping,
                            std::vector<double> const& start, double time, int steps) const {
    auto spins = spins_of<Spins>(lattice, start);
    Method method(spins);
    LandauLifshitz const generator(EffectiveField{term}, damping);
    for (int step = 0; step < steps; ++step) method.step(exec, generator, spins, 0, time / steps);
    return numbers_of(spins);
  }
};
TYPED_TEST_SUITE(Torques, Backends, BackendName);

TYPED_TEST(Torques, SlonczewskiIsItsFormula) {
  auto const p = unit({1, -2, 2});
  this->check(lattices[0],
              Slonczewski({.damping_like = 0.7, .field_like = -1.1, .polarization = {1, -2, 2}}),
              [&](auto const& numbers, std::int64_t site) {
                auto const m = at(numbers, site);
                return 0.7 * cross(m, cross(p, m)) + 1.1 * cross(m, p);
              });
}

TYPED_TEST(Torques, ZhangLiIsItsFormula) {
  Vec3<double> const u{0.9, -0.5, 0.7};
  double const xi = 0.4;
  for (auto const& lattice : lattices)
    this->check(lattice, ZhangLi(lattice, u, xi),
                [&, all = bonds(lattice)](auto const& numbers, std::int64_t site) {
                  auto const m = at(numbers, site);
                  Vec3<double> gradient{0, 0, 0};
                  for (auto const& bond : all) {
                    double const rate = dot(u, bond.along) / (2 * bond.spacing);
                    if (bond.from == site) gradient += rate * (at(numbers, bond.to) - m);
                    if (bond.to == site) gradient -= rate * (at(numbers, bond.from) - m);
                  }
                  // Projected onto the tangent plane, in which the chords of a sphere do not lie.
                  auto const across = gradient - dot(gradient, m) * m;
                  return xi * cross(m, across) - across;
                });
}

// With c = m.p and the angle f about p: c' = (a + damping * b) * (1 - c^2), f' = b - damping * a.
TYPED_TEST(Torques, OneSpinUnderSlonczewski) {
  double const bound = 1e-9 + 100 * epsilon<typename TypeParam::Real>, time = 1.7;
  for (double const damping : {0.0, 0.2})
    for (auto const& [a, b] : {std::pair(0.8, 0.0), {0.0, 1.3}, {-0.6, 0.9}}) {
      Slonczewski const torque({.damping_like = a, .field_like = b, .polarization = {0, 0, 3}});
      auto const m =
          at(this->moved(Lattice::chain(1), torque, damping, {0.8, 0, 0.6}, time, 400), 0);
      double const along = std::tanh((a + damping * b) * time + std::atanh(0.6));
      double const across = std::sqrt(1 - along * along), angle = (b - damping * a) * time;
      expect_near(m, {across * std::cos(angle), across * std::sin(angle), along}, bound);
    }
}

std::vector<double> helix(std::int64_t sites, double per_site, double phase, double along) {
  double const across = std::sqrt(1 - along * along);
  std::vector<double> numbers;
  for (std::int64_t i = 0; i < sites; ++i) {
    double const angle = per_site * static_cast<double>(i) + phase;
    for (double const c : {across * std::cos(angle), across * std::sin(angle), along})
      numbers.push_back(c);
  }
  return numbers;
}

// A helix of angle q per site turns at the rate -w * (1 + damping * xi) and leaves its plane with
// m_z' = (xi - damping) * w * (1 - m_z^2). Here w = u * sin(q) / spacing; in the continuum, it
// would be u * q / spacing.
TYPED_TEST(Torques, AHelixUnderZhangLi) {
  double const bound = 1e-9 + 200 * epsilon<typename TypeParam::Real>;
  double const spacing = 0.5, u = 0.7, time = 2;
  std::int64_t const n = 20;
  double const q = 2 * std::numbers::pi * 3 / static_cast<double>(n);
  double const w = u * std::sin(q) / spacing;
  for (int axis = 0; axis < 3; ++axis) {
    Lattice lattice;
    lattice.shape[axis] = n;
    lattice.spacing[axis] = spacing;
    lattice.boundary[axis] = Boundary::periodic;
    Vec3<double> const velocity{axis == 0 ? u : 3, axis == 1 ? u : 3, axis == 2 ? u : 3};
    for (double const damping : {0.0, 0.1})
      for (double const xi : {0.0, 0.3}) {
        // If damping = xi, the helix turns rigidly in its plane, so that a step is exact.
        int const steps = damping == xi ? 2 : 400;
        auto const found = this->moved(lattice, ZhangLi(lattice, velocity, xi), damping,
                                       helix(n, q, 0, 0), time, steps);
        auto const expected =
            helix(n, q, -w * (1 + damping * xi) * time, std::tanh((xi - damping) * w * time));
        for (std::int64_t i = 0; i < n; ++i) expect_near(at(found, i), at(expected, i), bound);
      }
  }
}

// Methods that split or differentiate the field move spins like a Runge-Kutta method.
TYPED_TEST(Torques, EveryKindOfMethodTakesTheNewTerms) {
  using Spins = typename TypeParam::Spins;
  double const bound = 1e-7 + 400 * epsilon<typename TypeParam::Real>;
  Lattice const lattice{{9, 4, 2}, {0.5, 0.8, 1}, {Boundary::open, Boundary::periodic, {}}};
  auto const run = [&](auto const& field, auto method) {
    LandauLifshitz const generator(field, 0.2);
    auto spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 5));
    for (int step = 0; step < 200; ++step) method.step(this->exec, generator, spins, 0, 1e-3);
    return numbers_of(spins);
  };
  Spins const like("like", lattice);
  auto const expect_same = [&](auto const& field, auto method) {
    auto const expected = run(field, Rkmk4<Spins>(like)), found = run(field, std::move(method));
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], bound) << i;
  };
  Exchange const exchange(lattice, 0.6);
  BulkDmi const dmi(lattice, 0.8);
  CubicAnisotropy const cubic(1.3, {1, 2, 2}, {2, 1, -2});
  Slonczewski const local({.damping_like = 0.6, .field_like = -0.7, .polarization = {1, 2, 3}});
  EffectiveField const in_parts(exchange, dmi, cubic, local);
  EffectiveField const all(exchange, dmi, cubic, local, BiquadraticBonds{0.5},
                           ZhangLi(lattice, {0.7, -0.4, 0.3}, 0.5));
  expect_same(in_parts, RedBlack4<Spins>(like));
  expect_same(all, RedBlack4<Spins>(like));
  expect_same(EffectiveField(exchange, dmi, local), Series4<Spins>(like));
}

// (cos(q * z), sin(q * z), 0) has m . curl m = -q, so that D > 0 prefers it.
TYPED_TEST(Torques, BulkDmiIsDTimesMDotCurlM) {
  double const d = 0.7, spacing = 0.01;
  std::int64_t const n = 100;
  double const per_site = 2 * std::numbers::pi / static_cast<double>(n), q = per_site / spacing;
  for (double const sign : {1.0, -1.0}) {
    Lattice const lattice{{1, 1, n},
                          {spacing, spacing, spacing},
                          {Boundary::periodic, Boundary::periodic, Boundary::periodic}};
    auto const spins =
        spins_of<typename TypeParam::Spins>(lattice, helix(n, sign * per_site, 0.1, 0));
    double const density = energy(this->exec, BulkDmi(lattice, d), spins).value / n;
    EXPECT_NEAR(density, -sign * d * q, 1e-3 * d * q);
    EXPECT_NEAR(density, -sign * d * std::sin(per_site) / spacing,
                1000 * epsilon<typename TypeParam::Real>);
  }
}

TYPED_TEST(Torques, AFreeSpiralOfBulkDmiIsAtRest) {
  double const a = 1.5, d = 0.6, spacing = 0.8, turn = std::atan(d * spacing / a);
  Lattice const lattice{{1, 1, 20}, {1, 1, spacing}, {}};
  LandauLifshitz const generator(EffectiveField(Exchange(lattice, a), BulkDmi(lattice, d)), 0);
  auto const rate = [&](double angle) {
    auto const spins = spins_of<typename TypeParam::Spins>(lattice, helix(20, angle, 0.1, 0));
    return largest_rate(this->exec, generator, spins);
  };
  EXPECT_LT(rate(turn), 20 * epsilon<typename TypeParam::Real>);
  EXPECT_GT(rate(-turn), 0.1);
  EXPECT_GT(rate(turn + 0.1), 0.01);
}

}  // namespace
}  // namespace cayspin::test
