// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Prefactors of harmonic transition state theory and of Langer's theory, for a biaxial particle,
// for chains, and for the skyrmion of Pd/Fe/Ir(111) in UppASD's tests.
#include "simulation/transition_rates.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/minimum_energy_path.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace cayspin::simulation::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Spins = SpinField<double, Exec::memory_space>;

struct Rates : testing::Test {
  static void SetUpTestSuite() {
    if (Kokkos::is_initialized()) return;
    Kokkos::initialize();
    std::atexit([] { Kokkos::finalize(); });
  }
};

struct Rate {
  MinimumEnergyPath path;
  io::RatesOfPath rates;
};

template <class Field>
Rate rate(Field const& field, cayspin::Lattice const& lattice, std::vector<double> const& from,
          std::vector<double> const& to, double damping = 0) {
  Exec const exec;
  std::vector<Spins> images;
  for (int k = 0; k < 16; ++k) images.emplace_back("image", lattice);
  Spins saddle("saddle", lattice);
  copy_from_host(from, images.front());
  copy_from_host(to, images.back());
  Rate found;
  found.path = minimum_energy_path(exec, field, images, saddle, {.torque = 1e-8});
  EXPECT_EQ(found.path.end, PathEnd::converged);
  io::Scene scene;
  scene.lattice.shape = lattice.shape;
  scene.system.damping = damping;
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (lattice.boundary[axis] == Boundary::periodic)
      scene.lattice.boundary[axis] = io::BoundaryKind::periodic;
  found.rates = rates_of(scene, exec, field, images.front(), saddle, images.back(),
                         found.path.saddle().curvature, [] {});
  return found;
}

TEST_F(Rates, OfABiaxialParticle) {
  for (double const hard : {0.01, 0.7, 5.0}) {
    double const easy = 1.3;
    EffectiveField const field(UniaxialAnisotropy(easy, {0, 0, 1}),
                               UniaxialAnisotropy(-hard, {0, 1, 0}));
    auto const found = rate(field, cayspin::Lattice::chain(1), {0, 0, 1}, {0, 0, -1});
    double const exact = std::sqrt(easy * (easy + hard)) / (2 * std::numbers::pi);
    EXPECT_NEAR(found.rates.prefactor_forward / exact, 1, 1e-9);
    EXPECT_NEAR(found.rates.prefactor_backward / exact, 1, 1e-9);
    EXPECT_EQ(found.rates.zero_modes, (std::array<std::int64_t, 3>{}));
  }
}

// Smith and de Rozario (1976): the rate at which the motion grows at the saddle is the positive
// root of a quadratic.
TEST_F(Rates, OfABiaxialParticleWithDamping) {
  double const easy = 1.3;
  for (double const hard : {0.01, 0.7, 5.0})
    for (double const damping : {0.0, 0.05, 1.0, 20.0}) {
      EffectiveField const field(UniaxialAnisotropy(easy, {0, 0, 1}),
                                 UniaxialAnisotropy(-hard, {0, 1, 0}));
      auto const found = rate(field, cayspin::Lattice::chain(1), {0, 0, 1}, {0, 0, -1}, damping);
      double const sum = damping * (easy + hard);
      double const growth =
          0.5 * (damping * (easy - hard) + std::sqrt(sum * sum + 4 * easy * hard));
      double const exact = growth / (2 * std::numbers::pi) * std::sqrt((easy + hard) / hard);
      EXPECT_NEAR(found.rates.langer_forward / exact, 1, 1e-8) << hard << ' ' << damping;
      EXPECT_NEAR(found.rates.langer_backward / exact, 1, 1e-8) << hard << ' ' << damping;
    }
}

// If stiff exchange modes are fast compared with the motion over the barrier, they contribute as
// without damping.
TEST_F(Rates, OfAStiffChainWithDamping) {
  double const easy = 1.3, damping = 0.3;
  auto const lattice = cayspin::Lattice::chain(3);
  // The smaller `hard` is much weaker than exchange, but there are still two saddles, not a ring.
  for (double const hard : {0.7, 0.005}) {
    EffectiveField const field(Exchange(lattice, 1e4), UniaxialAnisotropy(easy, {0, 0, 1}),
                               UniaxialAnisotropy(-hard, {0, 1, 0}));
    auto const found =
        rate(field, lattice, {0, 0, 1, 0, 0, 1, 0, 0, 1}, {0, 0, -1, 0, 0, -1, 0, 0, -1}, damping);
    double const sum = damping * (easy + hard);
    double const growth = 0.5 * (damping * (easy - hard) + std::sqrt(sum * sum + 4 * easy * hard));
    double const exact = growth / (2 * std::numbers::pi) * std::sqrt((easy + hard) / hard);
    EXPECT_EQ(found.rates.zero_modes, (std::array<std::int64_t, 3>{})) << hard;
    EXPECT_NEAR(found.rates.langer_forward / exact, 1, 1e-3) << hard;
  }
}

// At the saddle the spin may turn freely about the axis: a zero mode, whose volume is that of a
// full turn.
TEST_F(Rates, FindARotationOfAllSpins) {
  auto const found =
      rate(UniaxialAnisotropy(1, {0, 0, 1}), cayspin::Lattice::chain(1), {0, 0, 1}, {0, 0, -1});
  EXPECT_EQ(found.rates.zero_modes, (std::array<std::int64_t, 3>{0, 1, 0}));
  EXPECT_NEAR(found.rates.volumes[1], 2 * std::numbers::pi, 1e-6);
  EXPECT_LT(found.rates.prefactor_forward, 1e-6);  // no precession leads over the barrier
  EXPECT_LT(found.rates.langer_forward, 1e-6);
  // With damping, spins do cross the barrier: Brown (1963).
  for (double const damping : {0.01, 1.0}) {
    auto const damped = rate(UniaxialAnisotropy(1, {0, 0, 1}), cayspin::Lattice::chain(1),
                             {0, 0, 1}, {0, 0, -1}, damping);
    EXPECT_NEAR(damped.rates.langer_forward / damping * std::sqrt(2 * std::numbers::pi), 1, 1e-5);
  }
}

/// A chain with an easy axis, in a field along this axis.
struct ChainWithAxis {
  double k, h, exchange;
  std::int64_t count;

  /// Returns Langer's prefactor divided by the damping, for a well with this curvature.
  ///
  /// Brown's diffusion: the cosine z of the angle to the axis diffuses in the potential
  /// -K * z^2 / 2 - h * z; the diffusion coefficient is damping * kT * (1 - z^2). The flux of
  /// probability over the top at z = -h / K gives the rate of one spin: exp(-barrier / kT) times
  ///   damping * (1 - z^2) * sqrt(K / (2 * pi * kT)) * (K +- h).
  /// In a chain of N spins this is multiplied by sqrt(N) and, for each exchange mode, by the ratio
  /// of its curvatures in the well and at the top. At the top, a mode has one curvature along the
  /// ring of saddles and one across it.
  double prefactor(double curvature) const {
    double const square = 1 - h * h / (k * k);
    double factor = square * std::sqrt(k / (2 * std::numbers::pi)) * curvature *
                    std::sqrt(static_cast<double>(count));
    for (std::int64_t mode = 1; mode < count; ++mode) {
      double const angle =
          std::numbers::pi * static_cast<double>(mode) / static_cast<double>(count);
      double const bending = 2 * exchange * (1 - std::cos(angle));
      factor *= (bending + curvature) / std::sqrt(bending * (bending - k * square));
    }
    return factor;
  }

  Rate found(cayspin::Vec3<double> const& axis, double damping) const {
    auto const lattice = cayspin::Lattice::chain(count);
    EffectiveField const field(Exchange(lattice, exchange), UniaxialAnisotropy(k, axis),
                               Zeeman{{h * axis.x, h * axis.y, h * axis.z}});
    std::vector<double> up, down;
    for (std::int64_t site = 0; site < count; ++site)
      for (double const c : {axis.x, axis.y, axis.z}) up.push_back(c), down.push_back(-c);
    return rate(field, lattice, up, down, damping);
  }
};

TEST_F(Rates, InAFieldAlongTheEasyAxis) {
  double const damping = 0.4;
  for (double const h : {0.0, -0.2, 0.6, 1.1})
    for (cayspin::Vec3<double> const axis :
         {cayspin::Vec3<double>{0, 0, 1}, {2. / 3, -1. / 3, 2. / 3}})
      for (std::int64_t const count : {1, 4}) {
        ChainWithAxis const chain{1.3, h, 8, count};
        auto const rates = chain.found(axis, damping).rates;
        double const forward = damping * chain.prefactor(chain.k + h),
                     backward = damping * chain.prefactor(chain.k - h);
        EXPECT_EQ(rates.zero_modes, (std::array<std::int64_t, 3>{0, 1, 0}));
        EXPECT_NEAR(rates.langer_forward / forward, 1, 1e-6) << h << ' ' << count;
        EXPECT_NEAR(rates.langer_backward / backward, 1, 1e-6) << h << ' ' << count;
        EXPECT_LT(rates.prefactor_forward, 1e-4 * forward);
      }
}

// However strong the exchange, the anisotropy holds the spins in the wells: they do not turn freely
// there.
TEST_F(Rates, WithAnisotropyMuchWeakerThanExchange) {
  for (auto const& chain : {ChainWithAxis{0.3, 0, 1e4, 3}, {1, 0, 4e4, 2}, {1, 0, 6e4, 2}}) {
    auto const rates = chain.found({0, 0, 1}, 0.4).rates;
    EXPECT_EQ(rates.zero_modes, (std::array<std::int64_t, 3>{0, 1, 0})) << chain.exchange;
    EXPECT_NEAR(rates.langer_forward / (0.4 * chain.prefactor(chain.k)), 1, 1e-5) << chain.exchange;
  }
}

// For two spins at an angle phi, E = -J * cos(phi) - b * cos(phi)^2. Parallel and antiparallel
// spins have two zero modes, which turn both, and two modes of curvature c = 2 * E''(phi). The
// saddle has three zero modes and cos(phi) = -J / (2 * b). The rate is
//   damping * sqrt(-2 * E''(phi)) * sin(phi) * c / (2 * sqrt(pi * kT)),
// with phi at the saddle and c at the minimum, whatever the direction of the spins.
TEST_F(Rates, OfAnIsotropicPairInAnyDirection) {
  double const j = 0.2, b = 1, damping = 0.4;
  auto const lattice = cayspin::Lattice::chain(2);
  auto bond = Coupling::of({0, 0}, {1, 0, 0}, j);
  bond.biquadratic = b;
  EffectiveField const field(PairCouplings(lattice, {bond}));
  double const cosine = -j / (2 * b), sine = std::sqrt(1 - cosine * cosine);
  double const top = 2 * (j * cosine + 2 * b * (2 * cosine * cosine - 1));
  auto const exact = [&](double curvature) {
    return damping * std::sqrt(-top) * sine * curvature / (2 * std::sqrt(std::numbers::pi));
  };
  double const root = std::sqrt(14.0);
  for (auto const& [x, y, z] : {std::array{0.0, 0.0, 1.0}, {1 / root, 2 / root, 3 / root}}) {
    auto const found =
        rate(field, lattice, {x, y, z, x, y, z}, {x, y, z, -x, -y, -z}, damping).rates;
    EXPECT_EQ(found.zero_modes, (std::array<std::int64_t, 3>{2, 3, 2})) << x;
    EXPECT_NEAR(found.langer_forward / exact(2 * (2 * b + j)), 1, 1e-7) << x;
    EXPECT_NEAR(found.langer_backward / exact(2 * (2 * b - j)), 1, 1e-7) << x;
  }
}

// Parameters in mRy and results from tests/regressionGNEB of UppASD: 9 shells of exchange by von
// Malottki et al. (2017).
TEST_F(Rates, OfASkyrmionOfPdFeIr) {
  std::int64_t const n = 40;
  cayspin::Lattice const lattice{
      {n, n, 1}, {1, 1, 1}, {Boundary::periodic, Boundary::periodic, Boundary::open}};
  double const exchange[] = {1.058718581215438, -0.182356018041598, -0.197349006627337,
                             0.038263762060291, 0.054210395564408,  0.020404326321045,
                             0.011824535500085, -0.042221296598254, -0.015629780845687};
  double const squares[] = {1, 3, 4, 7, 9, 12, 13, 16, 19};
  std::vector<Coupling> couplings;
  double const height = std::sqrt(0.75);
  for (int a = -6; a <= 6; ++a)
    for (int b = 0; b <= 6; ++b)
      for (std::size_t shell = 0; shell < 9; ++shell) {
        double const x = a + 0.5 * b, y = b * height;
        if ((b == 0 && a <= 0) || std::abs(x * x + y * y - squares[shell]) > 1e-6) continue;
        double const dmi = shell == 0 ? 2 * 0.0734986449617 : 0;
        couplings.push_back(
            Coupling::of({0, 0}, {a, b, 0}, 2 * exchange[shell], {dmi * y, -dmi * x, 0}));
      }
  EffectiveField const field(PairCouplings(lattice, couplings),
                             UniaxialAnisotropy(2 * 0.05144905147319651, {0, 0, 1}),
                             Zeeman{{0, 0, -24 * 0.05788381806 / 13.605693}});
  std::vector<double> spins, uniform;
  for (std::int64_t j = 0; j < n; ++j)
    for (std::int64_t i = 0; i < n; ++i) {
      double const u = static_cast<double>(i - n / 2), v = static_cast<double>(j - n / 2);
      double const x = u + 0.5 * v, y = height * v, r = std::hypot(x, y) + 1e-12;
      double const angle = std::numbers::pi * std::exp(-std::pow(r / 3.5, 1.5));
      for (double const c : {x / r * std::sin(angle), y / r * std::sin(angle), -std::cos(angle)})
        spins.push_back(c);
      for (double const c : {0.0, 0.0, -1.0}) uniform.push_back(c);
    }
  auto const found = rate(field, lattice, spins, uniform);
  EXPECT_NEAR(found.path.barrier_forward(), 5.32125123, 1e-8);
  EXPECT_NEAR(found.path.barrier_backward(), 14.08655587, 1e-8);
  EXPECT_NEAR(found.path.saddle().curvature, -2.45602087, 1e-7);
  EXPECT_EQ(found.rates.zero_modes, (std::array<std::int64_t, 3>{2, 0, 0}));
  EXPECT_NEAR(found.rates.volumes[0], 15.1529267, 0.02);
  // Factors that convert the prefactors to 1/s and 1/(s K), for moments of 3 Bohr magnetons.
  double const time = 2.00231930 / 4.837769e-14 / 3, kelvin = 6.333623e-6 * 1e3;
  EXPECT_NEAR(found.rates.prefactor_forward * time * kelvin / 4.19766298e12, 1, 2e-3);
  EXPECT_NEAR(found.rates.prefactor_backward * time / 8.71839224e14, 1, 2e-3);
}

TEST_F(Rates, AskBeforeEachColumnWhetherToGoOn) {
  auto const lattice = cayspin::Lattice::chain(3);
  EffectiveField const field(Zeeman{{0, 0, 1}});
  Spins const spins("spins", lattice);
  copy_from_host(std::vector<double>{0, 0, 1, 0, 0, 1, 0, 0, 1}, spins);
  Exec const exec;
  int calls = 0;
  hessian_of(exec, field, spins, {}, [&] { ++calls; });
  EXPECT_EQ(calls, 6);
  auto const interrupt = [&] {
    if (--calls == 3) throw std::runtime_error("interrupted");
  };
  EXPECT_THROW(hessian_of(exec, field, spins, {}, interrupt), std::runtime_error);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace cayspin::simulation::test
