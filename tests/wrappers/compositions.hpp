// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/biquadratic_bonds.hpp"
#include "members.hpp"

#include <cayspin/crystal.hpp>
#include <cayspin/field/field_of_moments.hpp>
#include <cayspin/field/slow_field.hpp>

#include <random>
#include <utility>

namespace cayspin::test {

/// A wrapper as a user might write it, with only the required members.
template <class Inner>
class Named : public Forwarding<Named<Inner>, Inner> {
 public:
  static constexpr int energy_terms = detail::energy_terms<Inner>;
  explicit Named(Inner inner) : inner_(std::move(inner)) {}

  template <class Stencil>
  VectorOf<Stencil> field(Stencil const& stencil) const {
    return inner_.field(stencil);
  }
  template <class Stencil>
  ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    return inner_.energy_density(stencil);
  }
  template <class Stencil, class Value>
  void energy_densities(Stencil const& stencil, Value* energies) const {
    detail::energy_densities(inner_, stencil, energies);
  }
  template <class Make>
  auto with_parts(Make const& make) const {
    auto made = make(inner_);
    return Named<decltype(made)>(std::move(made));
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(inner_);
  }

 private:
  Inner inner_;
};

/// H = 0.7 * m_z along z, computed by host code.
struct AlongZ {
  static constexpr int degree = 2;
  template <class Field>
  void operator()(Field const& spins, Field const& field, double) const {
    for (std::int64_t site = 0; site < spins.sites(); ++site)
      field.set(site, {0, 0, static_cast<typename Field::value_type>(0.7) * spins.get(site).z});
  }
};
struct Growing {
  Vec3<double> operator()(double t) const { return {t, 0.3 * t * t, 1 - t}; }
};

template <class Real>
Setting<Real> random_setting(unsigned seed) {
  std::mt19937 engine(seed);
  auto const extent = [&](int most) { return static_cast<std::int64_t>(1 + engine() % most); };
  auto const end = [&] { return engine() % 2 == 0 ? Boundary::open : Boundary::periodic; };
  Setting<Real> on;
  on.lattice = {{extent(5), extent(3), 2 * extent(2)}, {1.25, 0.75, 1}, {end(), end(), end()}};
  on.lattice.cell_sites = 2;
  auto const sites = on.lattice.sites();
  // These numbers are exact in both precisions.
  auto const rounded = [](std::vector<double> numbers) {
    for (double& number : numbers) number = static_cast<float>(number);
    return numbers;
  };
  on.m = rounded(random_directions(sites, seed));
  on.others = rounded(random_directions(sites, seed + 1000));
  on.rates = rounded(random_directions(sites, seed + 2000));
  on.occupation = {"occupation", on.lattice};
  std::vector<double> occupied;
  for (std::int64_t site = 0; site < sites; ++site) occupied.push_back(engine() % 4 != 0);
  copy_from_host(occupied, on.occupation);
  on.moments = {1.5, 0.75};
  on.gyromagnetic = {1, 2};
  on.seed = seed;
  return on;
}

/// Calls visit(name, term) for many terms of the library and for BiquadraticBonds.
template <class Real, class Visit>
void for_each_term(Setting<Real> const& on, Visit const& visit) {
  using Field = typename Setting<Real>::Field;
  using Host = Kokkos::HostSpace;
  auto const& lattice = on.lattice;
  std::mt19937 engine(on.seed);
  auto const number = [&] { return engine() * 0x1p-31 - 1; };
  auto const vector = [&] { return Vec3<double>{number(), number(), number() + 2}; };
  auto const numbers = [&](double least) {
    std::vector<double> all;
    for (std::int64_t site = 0; site < lattice.sites(); ++site) all.push_back(least + number());
    ScalarField<Real, Host> field("numbers", lattice);
    copy_from_host(all, field);
    return field;
  };
  visit("Exchange", Exchange(lattice, number()));
  visit("BiquadraticBonds", BiquadraticBonds{number()});
  visit("BulkDmi", BulkDmi(lattice, number()));
  visit("InterfacialDmi", InterfacialDmi(lattice, number()));
  visit("SiteDependentExchange", SiteDependentExchange(numbers(1)));
  visit("UniaxialAnisotropy", UniaxialAnisotropy(number(), vector()));
  visit("CubicAnisotropy", CubicAnisotropy(number(), {1, 1, 0}, {1, -1, 1}));
  visit("SlabDemag", SlabDemag(vector(), number()));
  visit("SiteDependentUniaxialAnisotropy", SiteDependentUniaxialAnisotropy(numbers(0), vector()));
  visit("Zeeman", Zeeman{vector()});
  visit("TimeDependentZeeman", TimeDependentZeeman(Growing()));
  visit("ZhangLi", ZhangLi(lattice, vector(), number()));
  visit("Slonczewski",
        Slonczewski({.damping_like = number(), .field_like = number(), .polarization = vector()}));
  visit("HostField", HostField<Field, AlongZ>(lattice, AlongZ()));
  Coupling const bilinear = Coupling::of({0, 1}, {1, 0, 0}, number(), {number(), number(), 1}),
                 within = Coupling::of({1, 1}, {0, 1, 0}, number());
  visit("PairCouplings", PairCouplings<Host>(lattice, {bilinear, within}));
  visit("PairCouplings, biquadratic",
        PairCouplings<Host>(lattice, {bilinear, {{0, 1}, {0, 0, 0}, {}, number()}}));
  visit("SlowField", SlowField<Field, Exchange>(lattice, Exchange(lattice, number())));
  visit("SlowField(Zeeman)", SlowField<Field, Zeeman>(lattice, Zeeman{vector()}));
  using Solved = HostField<Field, AlongZ>;
  visit("SlowField(HostField)", SlowField<Field, Solved>(lattice, Solved(lattice, AlongZ())));
}

template <class Term>
inline constexpr bool sees_vacant_spins =
    detail::holds<PairCouplings, Term>() || detail::holds<detail::SeesAllSpins, Term>();

/// Calls visit(name, wrapped, factors, is_alone) for each wrapper of the library and for Named
/// around a term, and for some wrappers around wrappers. `is_alone` is true if `wrapped` must
/// answer like the term.
template <class Real, class Term, class Visit>
void for_each_wrapper(Setting<Real> const& on, std::string const& name, Term const& term,
                      std::vector<double> const& factors, Visit const& visit) {
  visit("EffectiveField(" + name + ", Zeeman, Exchange)",
        EffectiveField(term, Zeeman{{0.25, -0.5, 0.75}}, Exchange(on.lattice, 0.375)), factors,
        false);
  visit("Named(" + name + ")", Named(term), factors, true);
  if constexpr (!sees_vacant_spins<Term>)
    visit("FieldWithVacancies(" + name + ")", FieldWithVacancies(term, on.occupation), factors,
          true);
  std::vector<double> of_moments;
  for (std::int64_t site = 0; site < on.lattice.sites(); ++site)
    of_moments.push_back(on.factor(site) *
                         (factors.empty() ? 1 : factors[static_cast<std::size_t>(site)]));
  auto const moments = [&](auto const& inside) {
    return FieldOfMoments(inside,
                          CellMoments<Kokkos::HostSpace>(on.lattice, on.moments, on.gyromagnetic));
  };
  visit("FieldOfMoments(" + name + ")", moments(term), of_moments, true);
  EffectiveField const sum(UniaxialAnisotropy(0.5, {1, 2, 3}), term);
  if constexpr (!sees_vacant_spins<Term>)
    visit("FieldWithVacancies(FieldOfMoments(UniaxialAnisotropy, " + name + "))",
          FieldWithVacancies(moments(sum), on.occupation), of_moments, false);
  else
    visit("Named(FieldOfMoments(UniaxialAnisotropy, " + name + "))", Named(moments(sum)),
          of_moments, false);
}

template <class Real, class Wrapped, class Term>
void expect_answers(std::string const& name, Wrapped const& wrapped, Term const& inside,
                    Setting<Real> const& on) {
  auto found = answers(wrapped, on), expected = answers(inside, on);
  // These answers may differ: wrappers of conservative terms need not be conservative, and Named
  // has no derivatives.
  found.conservative = expected.conservative = true;
  if (name.starts_with("Named(")) {
    found.linear = expected.linear = true;
    found.derivative = expected.derivative = true;
  }
  EXPECT_TRUE(found == expected) << name << " answers otherwise than its inside";
}

/// Checks the members of each term, and of each wrapper that for_each_wrapper makes of it.
template <class Real>
void expect_all_members(Setting<Real> const& on) {
  int count = 0;
  for_each_term(on, [&](std::string const& name, auto const& term) {
    expect_members(name, term, on);
    for_each_wrapper(
        on, name, term, {},
        [&](std::string const& outer, auto const& wrapped, auto const& factors, bool is_alone) {
          bool const has_energy = detail::is_conservative<std::remove_cvref_t<decltype(term)>>;
          expect_members(outer, wrapped, on, has_energy ? factors : std::vector<double>());
          if (is_alone) expect_answers(outer, wrapped, term, on);
          ++count;
        });
  });
  EXPECT_EQ(count, 19 * 5 - 3);
}

}  // namespace cayspin::test
