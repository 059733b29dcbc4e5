// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A state without torque that is no minimum is left again.
#include "films.hpp"

namespace cayspin::test {
namespace {

template <class Backend>
class Saddles : public ::testing::Test {
 protected:
  using Spins = typename Backend::Spins;
  typename Backend::Exec exec;
};
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
    // The least curvature there is that of turning all spins out of the easy axis.
    EXPECT_NEAR(found.curvature, 0.1, 0.01);
  }
}

TYPED_TEST(Saddles, TheTopOfTheEnergy) {
  auto spins = spins_of<typename TestFixture::Spins>(Lattice::chain(1), {0, 0, -1});
  auto const found = minimize(this->exec, Zeeman{{0, 0, 2}}, spins);
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_EQ(found.saddles, 1);
  EXPECT_NEAR(at(numbers_of(spins), 0).z, 1, 1e-12 + epsilon<typename TypeParam::Real>);
  EXPECT_NEAR(found.curvature, 2, 1e-5);
}

// Spins that are parallel to each other may point anywhere: no saddle, in single precision either.
TYPED_TEST(Saddles, NotWhereTheEnergyIsFlat) {
  auto const lattice = Lattice::cubic(7, 6, 5);
  for (double const exchange : {1.0, 1000.0}) {
    auto spins =
        spins_of<typename TestFixture::Spins>(lattice, random_directions(lattice.sites(), 4));
    double const bound = 100 * epsilon<typename TypeParam::Real> * exchange;
    auto const found = minimize(this->exec, Exchange(lattice, exchange), spins, {.torque = bound});
    EXPECT_EQ(found.end, MinimizeEnd::converged) << exchange;
    EXPECT_LT(found.energy.value, 1e-4 * exchange);
    EXPECT_NEAR(found.curvature, 0, 1e3 * bound);
  }
}

/// H = -4 c m_i^3: E = c sum of m_i^4, which is not quadratic. Corners of a cube are its minima.
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

}  // namespace
}  // namespace cayspin::test
