// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The public functions that evaluate H, A and the energy of each term.
#include "../support/coefficients.hpp"
#include "../support/larger.hpp"

#include <cayspin/cayspin.hpp>

namespace cayspin::test {
namespace {

/// An applied field that changes with t.
Vec3<double> turning(double t) { return {0, 0.5 * t, 1}; }

template <class Backend>
class Evaluations : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  static constexpr double bound = 32 * epsilon<Real>;

  Lattice lattice = Lattice::cubic(19, 3, 2, 0.8);
  Spins spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 3));
  std::vector<double> m = numbers_of(spins);
  Spins output = Spins("output", lattice);
  typename Backend::Exec exec;
};
TYPED_TEST_SUITE(Evaluations, Backends, BackendName);

TYPED_TEST(Evaluations, FieldAndGeneratorByHand) {
  UniaxialAnisotropy const anisotropy(0.7, {0, 0, 1});
  EffectiveField const field(anisotropy, TimeDependentZeeman(turning));
  LandauLifshitz const generator(field, 0.3);
  evaluate_field(this->exec, field, this->spins, 2.5, this->output);
  this->exec.fence();
  auto const h = numbers_of(this->output);
  evaluate_generator(this->exec, generator, this->spins, 2.5, this->output);
  this->exec.fence();
  auto const a = numbers_of(this->output);
  for (std::int64_t site = 0; site < this->lattice.sites(); ++site) {
    auto const m = at(this->m, site);
    auto const expected = Vec3<double>{0, 0, 0.7 * m.z} + turning(2.5);
    expect_near(at(h, site), expected, this->bound);
    expect_near(at(a, site), expected + 0.3 * cross(m, expected), this->bound);
  }
  // The field may also be a single term. largest_rate is the largest torque.
  evaluate_field(this->exec, anisotropy, this->spins, 0, this->output);
  this->exec.fence();
  expect_near(at(numbers_of(this->output), 5), {0, 0, 0.7 * at(this->m, 5).z}, this->bound);
  double largest = 0;
  for (std::int64_t site = 0; site < this->lattice.sites(); ++site) {
    auto const torque = cross(at(a, site), at(this->m, site));
    largest = larger(largest, std::sqrt(dot(torque, torque)));
  }
  EXPECT_NEAR(largest_rate(this->exec, generator, this->spins, 2.5), largest, this->bound);
}

TYPED_TEST(Evaluations, EnergiesOfTermsAreTheirOwn) {
  using Spins = typename TypeParam::Spins;
  Exchange const exchange(this->lattice, 1.3);
  UniaxialAnisotropy const anisotropy(1.7, {1, -2, 2});
  TimeDependentZeeman const applied(turning);
  SiteDependentExchange const bonds(random_numbers_on<Spins>(this->lattice, 0.1, 1, 8, 9));
  EffectiveField const field(exchange, anisotropy, applied, bonds);
  double const t = 1.5;
  auto const found = term_energies(this->exec, field, this->spins, t);
  static_assert(std::tuple_size_v<decltype(found)> == 4);
  Energy const alone[] = {
      energy(this->exec, exchange, this->spins), energy(this->exec, anisotropy, this->spins),
      energy(this->exec, applied, this->spins, t), energy(this->exec, bonds, this->spins)};
  double value = 0, magnitude = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found[i].value, alone[i].value, 16 * epsilon<double> * alone[i].magnitude) << i;
    EXPECT_NEAR(found[i].magnitude, alone[i].magnitude, 16 * epsilon<double> * alone[i].magnitude);
    value += found[i].value;
    magnitude += found[i].magnitude;
  }
  Energy const total = energy(this->exec, field, this->spins, t);
  EXPECT_NEAR(value, total.value, 16 * epsilon<double> * total.magnitude);
  EXPECT_NEAR(magnitude, total.magnitude, 16 * epsilon<double> * total.magnitude);
}

TYPED_TEST(Evaluations, EnergiesOfTermsInWrappers) {
  using Spins = typename TypeParam::Spins;
  EffectiveField const field(Exchange(this->lattice, 1.3), Zeeman{{0.3, -0.4, 0.5}});
  auto const occupation =
      numbers_on<Spins>(this->lattice, [](auto site) { return site % 4 == 1 ? 0 : 1; });
  FieldWithVacancies const among(field, occupation);
  auto const found = term_energies(this->exec, among, this->spins);
  FieldWithVacancies const exchange_alone(Exchange(this->lattice, 1.3), occupation);
  FieldWithVacancies const applied_alone(Zeeman{{0.3, -0.4, 0.5}}, occupation);
  Energy const expected[] = {energy(this->exec, exchange_alone, this->spins),
                             energy(this->exec, applied_alone, this->spins)};
  EXPECT_LT(expected[1].magnitude, 0.9 * energy(this->exec, field, this->spins).magnitude);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(found[i].value, expected[i].value, 16 * epsilon<double> * expected[i].magnitude);
  // A generator has the terms of its field, a rigid body counts as one term, and an empty field has
  // none.
  auto const same = term_energies(this->exec, orthogonal(LandauLifshitz(among, 0.1)), this->spins);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(same[i].value, found[i].value);
  auto const one = term_energies(this->exec, RigidBody::principal(1, 2, 3), this->spins);
  static_assert(std::tuple_size_v<decltype(one)> == 1);
  EXPECT_EQ(one[0].value, energy(this->exec, RigidBody::principal(1, 2, 3), this->spins).value);
  EXPECT_TRUE(term_energies(this->exec, EffectiveField<>(), this->spins).empty());
}

}  // namespace
}  // namespace cayspin::test
