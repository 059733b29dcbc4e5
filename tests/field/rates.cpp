// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// FieldRate and LinearField of terms: the rate of H while a spin moves at a given rate, against
// differences.
#include "terms.hpp"

#include <cayspin_paper/analytic_sigma.hpp>

namespace cayspin::test {
namespace {

template <class Backend>
class FieldRates : public ::testing::Test {};
TYPED_TEST_SUITE(FieldRates, Backends, BackendName);

/// A term whose field is the rate of the field of `term`, evaluated as in steppers: spins are in an
/// array, and their rates in the stencil's array.
template <class Term, class Real>
struct RateOfField {
  Term term;
  SiteArray<Real, 3> spins;

  template <class Stencil>
  KOKKOS_FUNCTION Vec3<typename Stencil::value_type> field(Stencil const& rates) const {
    using Value = typename Stencil::value_type;
    return detail::FieldRate<Value>{rates.site().load(spins)}(term, rates);
  }
};

/// H of these local terms is a polynomial in the spin of degree 3 at most, so the differences are
/// exact.
template <class Backend, class Term>
void expect_rates(Term const& term) {
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  typename Backend::Exec const exec;
  auto const lattice = Lattice::square(19, 2);
  auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 3));
  auto const rates = spins_of<Spins>(lattice, random_directions(lattice.sites(), 4));
  auto const m = numbers_of(spins), rate = numbers_of(rates);
  auto const found = evaluated(exec, RateOfField<Term, Real>{term, spins.array()}, rates);
  auto const field_at = [&](double step) {
    auto moved = m;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += step * rate[i];
    return evaluated(exec, term, spins_of<Spins>(lattice, moved));
  };
  auto const h1 = field_at(0.5), h2 = field_at(-0.5), h3 = field_at(1), h4 = field_at(-1);
  for (std::size_t i = 0; i < m.size(); ++i)
    EXPECT_NEAR(found[i], (8 * (h1[i] - h2[i]) - (h3[i] - h4[i])) / 6, 200 * epsilon<Real>) << i;
}

TYPED_TEST(FieldRates, AreDerivativesOfTheField) {
  expect_rates<TypeParam>(CubicAnisotropy(1.3, {1, 0, 0}, {0, 1, 0}));
  expect_rates<TypeParam>(CubicAnisotropy(1.3, {1, 2, 2}, {2, 1, -2}));
  expect_rates<TypeParam>(
      Slonczewski({.damping_like = 0.7, .field_like = -1.1, .polarization = {1, -2, 2}}));
  expect_rates<TypeParam>(EffectiveField(CubicAnisotropy(-0.4, {0, 1, 0}, {3, 0, 4}),
                                         UniaxialAnisotropy(0.7, {1, 1, 1}), Zeeman{{1, 2, 3}}));
}

// Even a step of zero length needs the rate of an applied field.
TYPED_TEST(FieldRates, OverNoTimeLeaveSpinsAsTheyAre) {
  using Spins = typename TypeParam::Spins;
  auto spins = spins_of<Spins>(Lattice::chain(5), random_directions(5, 3));
  auto const before = numbers_of(spins);
  TimeDependentZeeman const applied([](double t) { return Vec3<double>{t, 0, 1}; });
  typename TypeParam::Exec const exec;
  LieEuler<Spins, isotropy::Analytic>(spins).step(exec, LandauLifshitz(applied, 0.1), spins, 1, 0);
  exec.fence();
  EXPECT_EQ(numbers_of(spins), before);
}

}  // namespace
}  // namespace cayspin::test
