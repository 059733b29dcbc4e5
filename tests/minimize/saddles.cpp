// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The search leaves states without torque that are not minima.
#include "films.hpp"
#include "least_curvature.hpp"

#include <algorithm>

namespace cayspin::test {
namespace {

template <class Backend>
class Saddles : public MinimizerTest<Backend> {};
TYPED_TEST_SUITE(Saddles, Backends, BackendName);

std::vector<double> uniform(std::int64_t sites, Vec3<double> const& m) {
  std::vector<double> numbers;
  for (std::int64_t i = 0; i < sites; ++i)
    for (double const c : {m.x, m.y, m.z}) numbers.push_back(c);
  return numbers;
}

TYPED_TEST(Saddles, HardAxesOfAFilm) {
  auto const lattice = Lattice::square(19, 12);
  double const sites = 19 * 12;
  for (Vec3<double> const& m : {Vec3<double>{0, 0, 1}, Vec3<double>{0, 1, 0}}) {
    auto spins = spins_of<typename TestFixture::Spins>(lattice, uniform(lattice.sites(), m));
    auto const found = minimize(this->exec, film(lattice, 30), spins);
    EXPECT_EQ(found.end, MinimizeEnd::converged);
    EXPECT_GE(found.saddles, 1);
    EXPECT_NEAR(found.energy.value, -0.05 * sites, 1e-6 * sites);
    // The least curvature of the minimum is that of turning all spins out of the easy axis.
    EXPECT_NEAR(found.curvature, 0.1, 0.01);
  }
}

TYPED_TEST(Saddles, AreKeptOnDemand) {
  auto const lattice = Lattice::square(19, 12);
  auto spins = spins_of<typename TestFixture::Spins>(lattice, uniform(lattice.sites(), {0, 1, 0}));
  auto const found = minimize(this->exec, film(lattice, 30), spins, {.keep_saddles = true});
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_EQ(found.saddles, 0);
  EXPECT_NEAR(found.energy.value, 0, 1e-6);
  EXPECT_NEAR(at(numbers_of(spins), 0).y, 1, 1e-6);
}

TYPED_TEST(Saddles, TheTopOfTheEnergy) {
  auto spins = spins_of<typename TestFixture::Spins>(Lattice::chain(1), {0, 0, -1});
  auto const found = minimize(this->exec, Zeeman{{0, 0, 2}}, spins);
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_EQ(found.saddles, 1);
  EXPECT_NEAR(at(numbers_of(spins), 0).z, 1, 1e-12 + epsilon<typename TypeParam::Real>);
  EXPECT_NEAR(found.curvature, 2, 1e-5);
}

TYPED_TEST(Saddles, KeptOnesHaveTheirLowestCurvature) {
  auto spins = spins_of<typename TestFixture::Spins>(Lattice::chain(1), {0, 0, -1});
  auto const found = minimize(this->exec, Zeeman{{0, 0, 2}}, spins,
                              {.keep_saddles = true, .lowest_curvature = true});
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_EQ(at(numbers_of(spins), 0).z, -1);
  EXPECT_NEAR(found.curvature, -2, 1e-5);
}

// At the start there is no torque, and only one site of many has a descent, with a small share in
// the start of the search for it.
TYPED_TEST(Saddles, OnOneSiteOfMany) {
  using Real = typename TypeParam::Real;
  for (std::int64_t const n : {32, 128})
    for (double const other : {-1.0, -0.1, -1e-2}) {
      auto const lattice = Lattice::square(n, n);
      std::vector<double> constants(static_cast<std::size_t>(lattice.sites()), 1);
      constants[static_cast<std::size_t>(n / 2 * (n + 1))] = other;
      ScalarField<Real, typename TypeParam::MemorySpace> const field("constants", lattice);
      copy_from_host(constants, field);
      auto spins =
          spins_of<typename TestFixture::Spins>(lattice, uniform(lattice.sites(), {0, 0, 1}));
      auto const found =
          minimize(this->exec, SiteDependentUniaxialAnisotropy(field, {0, 0, 1}), spins);
      EXPECT_EQ(found.end, MinimizeEnd::converged);
      EXPECT_EQ(found.saddles, 1) << n << ' ' << other;
      // The torque is other * z.
      double const tolerance = std::max(1e-5, -1.1e-6 / other);
      EXPECT_NEAR(at(numbers_of(spins), n / 2 * (n + 1)).z, 0, tolerance) << n << ' ' << other;
    }
}

// A site of the same lattice along a diagonal, where vectors of the start may be nearly along
// spins.
TYPED_TEST(Saddles, OnOneSiteAlongADiagonal) {
  using Real = typename TypeParam::Real;
  auto const lattice = Lattice::square(16, 16);
  double const c = std::sqrt(1.0 / 3);
  for (std::size_t site = 3; site < 256; site += 23) {
    std::vector<double> constants(256, 1);
    constants[site] = -1e-2;
    ScalarField<Real, typename TypeParam::MemorySpace> const field("constants", lattice);
    copy_from_host(constants, field);
    auto spins = spins_of<typename TestFixture::Spins>(lattice, uniform(256, {c, c, c}));
    auto const found =
        minimize(this->exec, SiteDependentUniaxialAnisotropy(field, {c, c, c}), spins);
    EXPECT_EQ(found.end, MinimizeEnd::converged) << site;
    EXPECT_GE(found.saddles, 1) << site;
  }
}

// Without a preconditioner, some of these searches find a curvature below zero in their last step.
TYPED_TEST(Saddles, WhereTheSearchOnlyJustFindsTheWay) {
  auto const lattice = Lattice::chain(200);
  auto const stop = [](Minimum const&) { return Next::stop; };
  double const torque = 1e-6;
  int converged = 0;
  for (double applied = 8e-4; applied < 6e-3; applied *= 1.02) {
    auto spins = spins_of<typename TestFixture::Spins>(lattice, uniform(200, {0, 0, -1}));
    EffectiveField const field(Exchange(lattice, 1), Zeeman{{0, 0, applied}});
    auto const found = minimize(this->exec, field, spins,
                                {.torque = torque, .preconditioned = false, .observer = stop});
    double const round_off = 65 * epsilon<typename TypeParam::Real> * (4 + applied);
    if (found.end == MinimizeEnd::converged) {
      ++converged;
      EXPECT_GE(found.curvature, -std::max(torque, round_off)) << applied;
    }
  }
  EXPECT_GT(converged, 10);
}

// The energy of parallel spins does not depend on their direction: this is no saddle, also in
// single precision.
TYPED_TEST(Saddles, NotWhereTheEnergyIsFlat) {
  auto const lattice = Lattice::cubic(7, 6, 5);
  for (double const exchange : {1.0, 1000.0}) {
    auto spins = this->random_spins(lattice, 4);
    double const bound = 100 * epsilon<typename TypeParam::Real> * exchange;
    auto const found = minimize(this->exec, Exchange(lattice, exchange), spins, {.torque = bound});
    EXPECT_EQ(found.end, MinimizeEnd::converged) << exchange;
    EXPECT_LT(found.energy.value, 1e-4 * exchange);
    EXPECT_NEAR(found.curvature, 0, 1e3 * bound);
  }
}

/// H_i = -4 * c * m_i^3 for each component i, and E = c * (sum of m_i^4), which is not quadratic.
/// In minima, spins point to the corners of a cube.
struct CubicAnisotropy {
  double constant;
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const m = stencil.center();
    Value const c = as_value<Value>(-4 * constant);
    return Vec3<Value>{c * m.x * m.x * m.x, c * m.y * m.y * m.y, c * m.z * m.z * m.z};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const m = stencil.center();
    Value const x = m.x * m.x, y = m.y * m.y, z = m.z * m.z;
    return Value(as_value<Value>(constant) * (x * x + y * y + z * z));
  }
};

TYPED_TEST(Saddles, OfATermThatIsNotQuadratic) {
  auto const lattice = Lattice::square(9, 8);
  for (Vec3<double> const& m : {Vec3<double>{0, 0, 1}, Vec3<double>{0, 0.8, -0.6}}) {
    auto spins = spins_of<typename TestFixture::Spins>(lattice, uniform(72, m));
    EffectiveField const field(Exchange(lattice, 5), CubicAnisotropy{0.3});
    auto const found = minimize(this->exec, field, spins, {.torque = 1e-5});
    EXPECT_EQ(found.end, MinimizeEnd::converged);
    EXPECT_NEAR(found.energy.value, 0.1 * 72, 1e-5);
    for (double const c : numbers_of(spins)) EXPECT_NEAR(std::abs(c), std::sqrt(1.0 / 3), 1e-3);
  }
}

std::vector<double> alternating(Lattice const& lattice, bool alternates, double tilt) {
  std::vector<double> numbers;
  for (std::int64_t site = 0; site < lattice.sites(); ++site) {
    auto const x = site % lattice.shape[0], y = site / lattice.shape[0];
    double const sign = alternates && (x + y) % 2 == 1 ? -1 : 1;
    for (double const c : {std::sin(tilt), 0.0, sign * std::cos(tilt)}) numbers.push_back(c);
  }
  return numbers;
}

// An antiferromagnet in a field above its spin flop: near the saddle, round-off keeps the torque
// above the bound.
TYPED_TEST(Saddles, WhereTheTorqueStaysAboveTheBound) {
  Lattice const ring{{8, 1, 1}, {1, 1, 1}, {Boundary::periodic, Boundary::open, Boundary::open}};
  EffectiveField const field(Exchange(ring, -1), UniaxialAnisotropy(0.1, {0, 0, 1}),
                             Zeeman{{0, 0, 0.66}});
  for (double const tilt : {0.0, 1e-12, 1e-9, 1e-6, 1e-3})
    for (double const torque : {1e-5, 1e-9, 1e-12}) {
      if (!TestFixture::is_double && torque < 1e-5) continue;
      auto spins = spins_of<typename TestFixture::Spins>(ring, alternating(ring, true, tilt));
      auto const found = minimize(this->exec, field, spins, {.torque = torque});
      EXPECT_EQ(found.end, MinimizeEnd::converged) << tilt << ' ' << torque;
      EXPECT_NEAR(found.energy.value, -16.446769, 2e-6) << tilt << ' ' << torque;
    }
}

// Chains and films with exchange of either sign, at fields close to those at which their states
// lose stability: no state that is found has a curvature far below zero.
TYPED_TEST(Saddles, NearInstabilities) {
  std::mt19937 engine(5);
  auto const uniform = [&](double low, double high) {
    return low + (high - low) * engine() * 0x1p-32;
  };
  auto const below = [&](unsigned count) { return engine() % count; };
  int ended[4] = {};
  for (int scene = 0; scene < 1000; ++scene) {
    bool const is_film = below(2) == 0;
    std::int64_t const nx = 2 * (1 + below(is_film ? 3 : 8)), ny = is_film ? 2 * (1 + below(3)) : 1;
    auto const boundary = below(2) == 0 ? Boundary::periodic : Boundary::open;
    Lattice const lattice{{nx, ny, 1}, {1, 1, 1}, {boundary, boundary, Boundary::open}};
    double const stiff = uniform(0.2, 3), all = (is_film ? 8 : 4) * stiff;
    double const easy = uniform(0.02, 0.5) * (below(4) == 0 ? -1 : 1), k = std::abs(easy);
    bool const alternates = below(2) == 0;
    double const losses[] = {k, std::sqrt(k * (all + k)), all - easy, all + easy};
    double const beside = (below(2) == 0 ? 1 : -1) * std::pow(10, -uniform(1, 6));
    double const applied = losses[below(alternates ? 4 : 1)] * (1 + beside);
    double const skew = below(3) == 0 ? uniform(0, 1e-3) : 0;
    EffectiveField const field(Exchange(lattice, alternates ? -stiff : stiff),
                               UniaxialAnisotropy(easy, {0, 0, 1}),
                               Zeeman{{applied * skew, 0, applied}});
    auto const start = alternating(lattice, alternates, std::pow(10, -uniform(1, 9)));
    auto spins = spins_of<typename TestFixture::Spins>(lattice, start);
    double const torque =
        TestFixture::is_double ? std::pow(10, -uniform(5, 11)) : 1e-4 * (all + applied);
    auto const found = minimize(this->exec, field, spins, {.torque = torque});
    ++ended[static_cast<int>(found.end)];
    double const allowed = 2 * torque + (TestFixture::is_double ? 1e-6 : 1e-3) * (all + applied);
    EXPECT_GT(least_curvature(field, lattice, numbers_of(spins)), -allowed)
        << "scene " << scene << ", " << to_string(found.end);
  }
  EXPECT_GT(ended[static_cast<int>(MinimizeEnd::converged)], 985);
}

}  // namespace
}  // namespace cayspin::test
