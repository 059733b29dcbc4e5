// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Spins stepped in reduced units are compared with motion in SI: all expected values are from
// formulas that do not use the library's conversions.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <cayspin/units.hpp>

#include <limits>
#include <numbers>

using namespace cayspin;
using namespace cayspin::test;
using cayspin::units::gilbert;
using cayspin::units::landau_lifshitz;

namespace {

constexpr double pi = std::numbers::pi, mu0 = 1.25663706127e-6, gamma_e = 1.760859e11;
constexpr double Ms = 8e5, A = 1.3e-11, Ku = 4e4, D = 2e-3;
constexpr std::array<double, 3> cell{4e-9, 3e-9, 2e-9};
constexpr double volume = 24e-27;

units::Micromagnetic material(units::Damping const& damping = {}) {
  return units::Micromagnetic({.Ms = Ms, .cell = cell, .damping = damping});
}

template <class Real>
class UnitsInMotion : public ::testing::Test {
 protected:
  using Field = SpinField<Real, Space::memory_space>;
  static constexpr bool in_double = std::is_same_v<Real, double>;
  static constexpr int steps_taken = 2000;
  /// Tolerance of angles after all steps.
  static constexpr double tolerance = steps_taken * double(std::numeric_limits<Real>::epsilon());

  /// Returns the spins after `seconds`.
  template <class Generator>
  static Field after(double seconds, units::ReducedUnits const& units, Generator const& generator,
                     Field const& start, int steps = steps_taken) {
    return run<Rkmk4<Field>>(generator, start, units.time(seconds) / steps, steps);
  }

  /// Returns the angle by which the spin of a site has turned about z.
  static double turn(Field const& spins, Field const& start, std::int64_t site = 0) {
    auto const a = spin(start, site), b = spin(spins, site);
    return std::remainder(std::atan2(b.y, b.x) - std::atan2(a.y, a.x), 2 * pi);
  }
};
using Precisions = ::testing::Types<double, float>;
TYPED_TEST_SUITE(UnitsInMotion, Precisions);

TYPED_TEST(UnitsInMotion, AFreeSpinTurnsAt28GigahertzPerTesla) {
  using Field = typename TestFixture::Field;
  auto const start = make_spins<Field>(Lattice::chain(1), [](auto...) { return Vector{3, 0, 4}; });
  constexpr double seconds = 1e-11;
  expect_figure("gamma / (2 pi), GHz/T", gamma_e / (2 * pi) * 1e-9, "28.02494", 0);
  struct Case {
    units::Damping damping;
    double slower;
  };
  for (auto const& [damping, slower] :
       {Case{{}, 1}, Case{gilbert(0.5), 1.25}, Case{landau_lifshitz(0.5), 1}}) {
    auto const units = material(damping);
    LandauLifshitz const generator{EffectiveField{Zeeman{{0, 0, units.applied(1.0)}}},
                                   units.damping()};
    auto const end = this->after(seconds, units, generator, start);
    double const frequency = this->turn(end, start) / (2 * pi * seconds);
    EXPECT_NEAR(frequency * slower, gamma_e / (2 * pi), this->tolerance * gamma_e);
    // The tangent of half the angle to the field decreases exponentially.
    double const theta = 2 * std::atan(std::tan(0.5 * std::acos(0.8)) *
                                       std::exp(-damping.alpha() * gamma_e * seconds / slower));
    EXPECT_NEAR(spin(end, 0).z, std::cos(theta), this->tolerance);
  }
}

TYPED_TEST(UnitsInMotion, AFilmPrecessesAtKittelsFrequency) {
  using Field = typename TestFixture::Field;
  auto const units = material();
  constexpr double B = 0.05, amplitude = TestFixture::in_double ? 1e-5 : 1e-2;
  double const in_plane = B + 2 * Ku / Ms, out_of_plane = in_plane + mu0 * Ms;
  double const omega = gamma_e * std::sqrt(in_plane * out_of_plane);
  LandauLifshitz const generator{EffectiveField{SlabDemag{{0, 0, 1}, units.demagnetization(1)},
                                                UniaxialAnisotropy{units.anisotropy(Ku), {1, 0, 0}},
                                                Zeeman{{units.applied(B), 0, 0}}},
                                 0.0};
  auto const start = make_spins<Field>(Lattice::chain(1), [&](auto...) {
    return Vector{1, amplitude, 0};
  });
  auto const m = spin(this->after(4.0 / omega, units, generator, start), 0);
  double const phase = std::atan2(m.z * std::sqrt(out_of_plane / in_plane), m.y);
  EXPECT_NEAR(std::remainder(phase - 4, 2 * pi), 0, TestFixture::in_double ? 1e-8 : 1e-3);
}

// Returns B = mu0 H in T on the spin of a site, in a block with open ends.
Vector tesla_at(std::vector<Vector> const& m, Lattice const& lattice, std::int64_t site,
                Vector const& applied) {
  auto const& n = lattice.shape;
  std::array<std::int64_t, 3> const at{site % n[0], site / n[0] % n[1], site / (n[0] * n[1])};
  std::array<std::int64_t, 3> const stride{1, n[0], n[0] * n[1]};
  Vector b = applied + (2 * Ku / Ms * m[site].y) * Vector{0, 1, 0};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int const side : {-1, 1}) {
      auto const next = at[axis] + side;
      if (next < 0 || next >= n[axis]) continue;
      b = b + (2 * A / (Ms * cell[axis] * cell[axis])) * (m[site + side * stride[axis]] - m[site]);
    }
  return b;
}

TYPED_TEST(UnitsInMotion, EverySpinObeysGilbertsEquation) {
  using Field = typename TestFixture::Field;
  constexpr double alpha = 0.7, dt = TestFixture::in_double ? 1e-15 : 1e-14;
  Vector const applied{0.1, -0.2, 0.3};
  auto const units = material(gilbert(alpha));
  Lattice const lattice{{3, 2, 2}, units.spacing(), {}};
  LandauLifshitz const generator{
      EffectiveField{Exchange{lattice, units.exchange(A)},
                     UniaxialAnisotropy{units.anisotropy(Ku), {0, 1, 0}},
                     Zeeman{{units.applied(0.1), units.applied(-0.2), units.applied(0.3)}}},
      units.damping()};
  auto const before = random_spins<Field>(lattice, 7);
  auto const middle = this->after(dt, units, generator, before, 4);
  auto const past = this->after(dt, units, generator, middle, 4);
  std::vector<Vector> m;
  for (std::int64_t site = 0; site < 12; ++site) m.push_back(spin(middle, site));
  for (std::int64_t site = 0; site < 12; ++site) {
    Vector const rate = (1 / (2 * dt)) * (spin(past, site) - spin(before, site));
    Vector const b = tesla_at(m, lattice, site, applied);
    Vector const expected = -gamma_e * cross(m[site], b) + alpha * cross(m[site], rate);
    double const scale = gamma_e * length(b);
    EXPECT_LT(length(rate - expected), (TestFixture::in_double ? 1e-5 : 2e-3) * scale) << site;
    EXPECT_GT(length(rate), 0.01 * scale);
  }
}

TYPED_TEST(UnitsInMotion, EnergyInJoulesIsTheDirectSum) {
  using Field = typename TestFixture::Field;
  auto const units = material();
  Lattice const lattice{{4, 3, 2}, units.spacing(), {}};
  EffectiveField const field{Exchange{lattice, units.exchange(A)},
                             UniaxialAnisotropy{units.anisotropy(Ku), {0, 1, 0}},
                             InterfacialDmi{lattice, units.dmi(D), {0, 0, 1}},
                             SlabDemag{{1, 0, 0}, units.demagnetization(0.6)},
                             Zeeman{{units.applied(0.1), 0, units.applied(0.3)}}};
  auto const spins = random_spins<Field>(lattice, 11);
  double sum = 0, magnitude = 0;
  auto const add = [&](double energy) { sum += energy, magnitude += std::abs(energy); };
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) {
        auto const at = [&](int x, int y, int z) { return spin(spins, x + 4 * (y + 3 * z)); };
        auto const m = at(i, j, k);
        add(-Ku * volume * m.y * m.y);
        add(-Ms * volume * (0.1 * m.x + 0.3 * m.z));
        add(0.5 * mu0 * Ms * Ms * volume * 0.6 * m.x * m.x);
        auto const stiff = [&](Vector const& next, double d) {
          add(A * volume / (d * d) * dot(next - m, next - m));
        };
        // A bond along e has the energy density D * (m_z * d_e m_e - m_e * d_e m_z), where m is the
        // mean of the spins at its ends, and d_e m is their difference divided by the cell's edge.
        if (i < 3) {
          auto const next = at(i + 1, j, k);
          stiff(next, cell[0]);
          add(D * volume / cell[0] * (m.z * next.x - m.x * next.z));
        }
        if (j < 2) {
          auto const next = at(i, j + 1, k);
          stiff(next, cell[1]);
          add(D * volume / cell[1] * (m.z * next.y - m.y * next.z));
        }
        if (k < 1) stiff(at(i, j, k + 1), cell[2]);
      }
  double const joules = units.joules(energy(Space{}, field, spins).value);
  double const epsilon = std::numeric_limits<TypeParam>::epsilon();
  EXPECT_NEAR(joules, sum, 8 * epsilon * magnitude);
  EXPECT_GT(std::abs(sum), 0.01 * magnitude);
}

TYPED_TEST(UnitsInMotion, AtomisticEnergyIsTheDirectSum) {
  using Field = typename TestFixture::Field;
  constexpr double J = 3e-21, K = 2e-22, bond_dmi = 5e-22, B = 1.5, a = 3e-10;
  double const mu_s = 2 * units::bohr_magneton;
  units::Atomistic const units({.mu_s = mu_s, .energy = 7e-21, .lattice_constant = a});
  auto const lattice = Lattice::chain(9);
  EffectiveField const field{
      Exchange{lattice, units.exchange(J)}, UniaxialAnisotropy{units.anisotropy(K), {0, 1, 0}},
      InterfacialDmi{lattice, units.dmi(bond_dmi), {0, 0, 1}},
      SlabDemag{{1, 0, 0}, units.demagnetization(0.6)}, Zeeman{{0, 0, units.applied(B)}}};
  auto const spins = random_spins<Field>(lattice, 5);
  double sum = 0, magnitude = 0;
  auto const add = [&](double energy) { sum += energy, magnitude += std::abs(energy); };
  for (int i = 0; i < 9; ++i) {
    auto const m = spin(spins, i);
    add(-K * m.y * m.y);
    add(-mu_s * B * m.z);
    add(0.5 * 0.6 * mu0 * mu_s * mu_s / (a * a * a) * m.x * m.x);
    if (i == 8) continue;
    auto const next = spin(spins, i + 1);
    add(-J * dot(m, next));
    add(J);  // relative to parallel spins
    add(bond_dmi * (m.z * next.x - m.x * next.z));
  }
  double const joules = units.joules(energy(Space{}, field, spins).value);
  EXPECT_NEAR(joules, sum, 8 * std::numeric_limits<TypeParam>::epsilon() * magnitude);
}

}  // namespace
