// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Known equilibria: Stoner and Wohlfarth's particle through its hysteresis, a Bloch wall, and a
// spiral of exchange and Dzyaloshinskii-Moriya interaction.
#include "films.hpp"

#include <numbers>

namespace cayspin::test {
namespace {

template <class Backend>
class Exact : public MinimizerTest<Backend> {
 protected:
  /// Expects a free spiral, which turns by `angle` about `about` from site to site, where
  /// tan(angle) = D * dx / A.
  template <class Dmi>
  void expect_spiral(Lattice const& lattice, Dmi const& dmi, double angle, double a,
                     Vec3<double> const& about) const {
    auto spins = this->random_spins(lattice, 3);
    EffectiveField const field(Exchange(lattice, a), dmi);
    double const bound = this->is_double ? 1e-8 : 5e-5;
    auto const found = minimize(this->exec, field, spins, {.torque = bound});
    ASSERT_EQ(found.end, MinimizeEnd::converged);
    auto const m = numbers_of(spins);
    for (std::int64_t i = 0; i + 1 < lattice.sites(); ++i) {
      EXPECT_NEAR(dot(at(m, i), at(m, i + 1)), std::cos(angle), 20 * bound) << i;
      EXPECT_NEAR(dot(cross(at(m, i), at(m, i + 1)), about), std::sin(angle), 20 * bound) << i;
    }
  }
};
TYPED_TEST_SUITE(Exact, Backends, BackendName);

// E = -K/2 * (m.e)^2 - h.m with h at the angle psi to e: the spin switches at
// |h| = K * (cos(psi)^(2/3) + sin(psi)^(2/3))^(-3/2) (Stoner and Wohlfarth 1948).
TYPED_TEST(Exact, StonerWohlfarth) {
  double const strength = 0.7, step = 0.002;
  for (double const degrees : {5.0, 20.0, 45.0, 70.0}) {
    double const psi = degrees * std::numbers::pi / 180;
    double const switching =
        strength *
        std::pow(std::pow(std::cos(psi), 2.0 / 3) + std::pow(std::sin(psi), 2.0 / 3), -1.5);
    auto spins = spins_of<typename TestFixture::Spins>(Lattice::chain(1), {0, 0, 1});
    Minimizer minimizer(spins);
    double switched = 0;
    for (int i = 0; i < 1000 && switched == 0; ++i) {
      double const h = -i * step;
      EffectiveField const field(UniaxialAnisotropy(strength, {0, 0, 1}),
                                 Zeeman{{h * std::sin(psi), 0, h * std::cos(psi)}});
      auto const found = minimizer.minimize(this->exec, field, spins);
      ASSERT_EQ(found.end, MinimizeEnd::converged) << degrees << " " << i;
      auto const m = at(numbers_of(spins), 0);
      if (m.z < 0 && m.x * std::sin(psi) + m.z * std::cos(psi) < 0) switched = -h;
    }
    EXPECT_GT(switched, switching - 1e-5) << degrees;
    EXPECT_LT(switched, switching + step + 1e-5) << degrees;
  }
}

// m_z = tanh(x / sqrt(A / K)). The energy per area is 2 * sqrt(A * K), with an error of second
// order in the spacing.
TYPED_TEST(Exact, BlochWall) {
  double const a = 1, k = 1;
  double error[2];
  for (int fine = 0; fine < 2; ++fine) {
    std::int64_t const n = fine ? 160 : 80;
    double const dx = 20.0 / n;
    auto const lattice = Lattice::chain(n, dx);
    std::vector<double> start;
    for (std::int64_t i = 0; i < n; ++i)
      for (double const c : {0.0, 0.6, i < n / 2 ? -0.8 : 0.8}) start.push_back(c);
    auto spins = spins_of<typename TestFixture::Spins>(lattice, start);
    EffectiveField const field(Exchange(lattice, a), UniaxialAnisotropy(k, {0, 0, 1}));
    auto const found = minimize(this->exec, field, spins, {.torque = 1e-5});
    EXPECT_EQ(found.end, MinimizeEnd::converged);
    double const wall = (found.energy.value + 0.5 * k * n) * dx;
    error[fine] = 2 * std::sqrt(a * k) - wall;
    auto const m = numbers_of(spins);
    for (std::int64_t i = n / 4; i < 3 * n / 4; ++i)
      EXPECT_NEAR(at(m, i).z, std::tanh((i + 0.5 - 0.5 * n) * dx / std::sqrt(a / k)), 0.02);
  }
  EXPECT_GT(error[1], 0);
  double const order = std::log2(error[0] / error[1]);
  EXPECT_GT(order, 1.9);
  EXPECT_LT(order, 2.1);
}

TYPED_TEST(Exact, Spiral) {
  double const a = 1.5, d = 0.6;
  auto const lattice = Lattice::chain(60);
  this->expect_spiral(lattice, InterfacialDmi(lattice, d, {0, 0, 1}), std::atan(d / a), a,
                      {0, -1, 0});
  this->expect_spiral(lattice, BulkDmi(lattice, d), std::atan(d / a), a, {1, 0, 0});
}

}  // namespace
}  // namespace cayspin::test
