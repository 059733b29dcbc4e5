// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Landau-Lifshitz generators around wrapped terms: A computed from H, and a step of a method that
// evaluates rows.
#include "compositions.hpp"

#include <cayspin/evaluate.hpp>

namespace cayspin::test {
namespace {

template <class Real>
class WrappedGenerators : public ::testing::Test {
 protected:
  using Field = SpinField<Real, Kokkos::HostSpace>;
  static constexpr double damping = 0.3;

  /// Returns A computed by hand from the H of a term.
  template <class Term>
  static Vectors generator_of(Term const& term, Field const& spins, double t) {
    auto all = field_of(term, spins, t);
    auto const m = numbers_of(spins);
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = all[i] + damping * cross(at(m, static_cast<std::int64_t>(i)), all[i]);
    return all;
  }

  template <class Term>
  void expect_generator(std::string const& name, Term const& term, Setting<Real> const& on) {
    Members const is(name + ", seed " + std::to_string(on.seed), epsilon<Real>);
    auto const spins = on.field(on.m);
    auto const m = numbers_of(spins);
    LandauLifshitz const generator(term, damping);
    auto const a = generator_of(term, spins, on.t);
    auto with_orthogonal = a;
    for (std::size_t i = 0; i < a.size(); ++i) {
      auto const spin = at(m, static_cast<std::int64_t>(i));
      with_orthogonal[i] = a[i] - dot(spin, a[i]) * spin;
    }
    expect_evaluated(is, generator, a, spins, on.t);
    expect_evaluated(is, orthogonal(generator), with_orthogonal, spins, on.t);
    expect_step(is, generator, a, on);
  }

 private:
  template <class Generator>
  void expect_evaluated(Members const& is, Generator const& generator, Vectors const& expected,
                        Field const& spins, double t) {
    Host const exec;
    auto const prepared = detail::prepare_term(generator, exec, spins, t);
    auto const m = numbers_of(spins);
    Vectors found, turning;
    for_each_stencil(spins, [&](auto const& stencil) {
      found.push_back(in_double(detail::evaluate(prepared, stencil)));
      turning.push_back(in_double(detail::turning_part(prepared, stencil)));
    });
    is.expect_same(found, expected, "operator()");
    is.expect_turns(turning, expected, m, "turning_part");
  }

  template <class Generator>
  void expect_step(Members const& is, Generator const& generator, Vectors const& a,
                   Setting<Real> const& on) {
    Host const exec;
    // A step evaluates the field along rows.
    double const dt = 0.25;
    auto spins = on.field(on.m);
    LieEuler(spins).step(exec, generator, spins, on.t, dt);
    Vectors found, expected;
    for (std::int64_t site = 0; site < on.lattice.sites(); ++site) {
      auto const i = static_cast<std::size_t>(site);
      found.push_back(at(numbers_of(spins), site));
      expected.push_back(Cayley::rotate(dt * a[i], at(on.m, site)));
    }
    is.expect_same(found, expected, "a step of LieEuler");
  }
};
TYPED_TEST_SUITE(WrappedGenerators, Precisions, PrecisionName);

TYPED_TEST(WrappedGenerators, HaveTheFieldOfTheirTerms) {
  using Field = typename TestFixture::Field;
  using Host = Kokkos::HostSpace;
  for (unsigned const seed : {1U, 2U, 3U, 4U}) {
    auto const on = random_setting<TypeParam>(seed);
    auto const& lattice = on.lattice;
    PairCouplings<Host> const pairs(
        lattice, {Coupling::of({0, 1}, {1, 0, 0}, 0.75), {{0, 0}, {0, 1, 0}, {}, 0.5}});
    UniaxialAnisotropy const axis(0.75, {1, 2, 3});
    auto const moments = [&](auto const& inside) {
      return FieldOfMoments(inside, CellMoments<Host>(lattice, on.moments, on.gyromagnetic));
    };
    this->expect_generator("pairs", EffectiveField(pairs, axis), on);
    this->expect_generator("named pairs", EffectiveField(axis, Named(pairs)), on);
    this->expect_generator("pairs of moments", moments(EffectiveField(pairs, axis)), on);
    this->expect_generator("moments in a name", Named(moments(EffectiveField(axis, pairs))), on);
    EffectiveField const sum(Exchange(lattice, 0.75), axis, Named(axis),
                             TimeDependentZeeman(Growing()),
                             HostField<Field, AlongZ>(lattice, AlongZ()));
    this->expect_generator("a sum", sum, on);
    this->expect_generator(
        "vacancies in moments in vacancies",
        FieldWithVacancies(moments(FieldWithVacancies(sum, on.occupation)), on.occupation), on);
  }
}

}  // namespace
}  // namespace cayspin::test
