// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The generator A of the Landau-Lifshitz equation, its orthogonal part, and sigma added to it.
#include "../support/evaluate.hpp"
#include "../support/larger.hpp"

#include <cayspin/cayspin.hpp>

#include <limits>
#include <stdexcept>

namespace cayspin::test {
namespace {

template <class Backend>
class LandauLifshitzGenerator : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  static constexpr double bound = 64 * epsilon<Real>;  // for numbers up to about 10

  Lattice lattice = Lattice::cubic(9, 2, 3, 0.7);
  Spins spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 31));
  std::vector<double> m = numbers_of(spins);
  EffectiveField<Exchange, Zeeman> field{Exchange(lattice, 0.8), Zeeman{{0.3, -2, 1}}};
  typename Backend::Exec exec;
};
TYPED_TEST_SUITE(LandauLifshitzGenerator, Backends, BackendName);

// A x m is the rate of m in the equation, and damping turns m towards H.
TYPED_TEST(LandauLifshitzGenerator, MovesSpinsByTheEquation) {
  auto const h = evaluated(this->exec, this->field, this->spins);
  for (bool const precession : {true, false})
    for (double const damping : {0.0, 0.05, 1.0, 3.0}) {
      LandauLifshitz const generator(this->field, damping, precession);
      auto const a = evaluated(this->exec, generator, this->spins);
      for (std::int64_t site = 0; site < this->lattice.sites(); ++site) {
        auto const m = at(this->m, site), field = at(h, site), turn = cross(m, field);
        double const p = precession ? 1 : 0;
        expect_near(at(a, site), p * field + damping * turn, this->bound);
        expect_near(cross(at(a, site), m), (-p) * turn - damping * cross(m, turn), this->bound);
        double const gain = dot(field, cross(at(a, site), m));  // d(m.H)/dt
        EXPECT_NEAR(gain, damping * dot(turn, turn), this->bound * 10);
      }
    }
}

TYPED_TEST(LandauLifshitzGenerator, OrthogonalMovesTheSameAcrossTheSpin) {
  LandauLifshitz const generator(this->field, 0.3);
  auto const a = evaluated(this->exec, generator, this->spins);
  auto const across = evaluated(this->exec, orthogonal(generator), this->spins);
  double largest_part = 0;
  for (std::int64_t site = 0; site < this->lattice.sites(); ++site) {
    auto const m = at(this->m, site);
    EXPECT_NEAR(dot(m, at(across, site)), 0, this->bound);
    expect_near(cross(at(across, site), m), cross(at(a, site), m), this->bound);
    expect_near(at(across, site), at(a, site) - dot(m, at(a, site)) * m, this->bound);
    largest_part = larger(largest_part, std::abs(dot(m, at(a, site))));
  }
  EXPECT_GT(largest_part, 1);
}

TYPED_TEST(LandauLifshitzGenerator, EnergyIsTheFields) {
  LandauLifshitz const generator(this->field, 0.3);
  Energy const expected = energy(this->exec, this->field, this->spins);
  for (Energy const found : {energy(this->exec, generator, this->spins),
                             energy(this->exec, orthogonal(generator), this->spins)}) {
    EXPECT_EQ(found.value, expected.value);
    EXPECT_EQ(found.magnitude, expected.magnitude);
  }
}

TYPED_TEST(LandauLifshitzGenerator, FieldsAreTakenAtTheTimeAsked) {
  auto const applied = [](double t) { return Vec3<double>{t, 2 * t, -t}; };
  LandauLifshitz const moving(EffectiveField{TimeDependentZeeman{applied}}, 0.5);
  LandauLifshitz const still(EffectiveField{Zeeman{applied(1.5)}}, 0.5);
  EXPECT_EQ(evaluated(this->exec, moving, this->spins, 1.5),
            evaluated(this->exec, still, this->spins));
  EXPECT_EQ(evaluated(this->exec, orthogonal(moving), this->spins, 1.5),
            evaluated(this->exec, orthogonal(still), this->spins));
}

TYPED_TEST(LandauLifshitzGenerator, DampingMustBeANumberNotNegative) {
  EXPECT_THROW(LandauLifshitz(this->field, -0.1), std::invalid_argument);
  EXPECT_THROW(LandauLifshitz(this->field, std::numeric_limits<double>::quiet_NaN()),
               std::invalid_argument);
  EXPECT_THROW(LandauLifshitz(this->field, std::numeric_limits<double>::infinity()),
               std::invalid_argument);
}

template <class Value, class Real>
void expect_constant_isotropy() {
  auto const value = [](double number) { return Value(static_cast<Real>(number)); };
  Vec3<Value> const m{value(0.6), value(0), value(-0.8)}, a{value(1), value(2), value(-3)};
  auto const found = isotropy::Constant{2.5}(m, a);
  auto const same = isotropy::Zero()(m, a);
  Real number[detail::lanes_of<Value>];
  auto const expect = [&](Value const& lanes, double expected) {
    detail::store(lanes, number);
    for (Real const lane : number) EXPECT_NEAR(lane, expected, 4 * epsilon<Real>);
  };
  expect(found.x, 2.5), expect(found.y, 2), expect(found.z, -5);
  expect(same.x, 1), expect(same.y, 2), expect(same.z, -3);
}

TEST(ConstantIsotropy, AddsSigmaAlongTheSpin) {
  expect_constant_isotropy<float, float>();
  expect_constant_isotropy<double, double>();
  expect_constant_isotropy<detail::Pack<float>, float>();
  expect_constant_isotropy<detail::Pack<double>, double>();
}

}  // namespace
}  // namespace cayspin::test
