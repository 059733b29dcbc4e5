// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

#include <cayspin/cayspin.hpp>

#include <cayspin_paper/field_rate.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

// Every member of a term, compared with values that use only `field` and `energy_density`.
namespace cayspin::test {

using Vectors = std::vector<Vec3<double>>;

/// Spins and other vectors on a lattice, with moments and gyromagnetic ratios of the sites of a
/// cell.
template <class Real>
struct Setting {
  using Field = SpinField<Real, Kokkos::HostSpace>;
  Lattice lattice;
  std::vector<double> m, others, rates;  // (sites, 3)
  ScalarField<Real, Kokkos::HostSpace> occupation;
  std::vector<double> moments, gyromagnetic;
  unsigned seed = 0;
  double t = 0.4;

  Field field(std::vector<double> const& numbers) const {
    return spins_of<Field>(lattice, numbers);
  }
  double factor(std::int64_t site) const {
    auto const plane = site / (lattice.shape[0] * lattice.shape[1]);
    auto const of_cell = static_cast<std::size_t>(plane % lattice.cell_sites);
    return gyromagnetic[of_cell] / moments[of_cell];
  }
};

inline std::vector<double> combined(std::vector<double> const& a, double factor,
                                    std::vector<double> const& b) {
  auto sum = a;
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] += factor * b[i];
  return sum;
}

/// The results of the members of a prepared term, at each site.
struct Said {
  Vectors field, added, turning, added_turning, neighbor, local, other_local;
  std::vector<double> energy, magnitude, sum_of_terms, magnitude_of_terms;
};

template <class Real>
Vec3<double> in_double(Vec3<Real> const& v) {
  return {double(v.x), double(v.y), double(v.z)};
}

/// Calls visit(stencil) for all sites, x fastest.
template <class Field, class Visit>
void for_each_stencil(Field const& spins, Visit const& visit) {
  using Real = typename Field::value_type;
  using Site = detail::Site<Real>;
  auto const& layout = spins.layout();
  auto const array = spins.array();
  for (std::int32_t z = 0; z < layout.nz; ++z)
    for (std::int32_t y = 0; y < layout.ny; ++y) {
      detail::Row const row(layout, y, z);
      for (std::int32_t x = 0; x < layout.nx; ++x) {
        Site const site(row, x);
        visit(Stencil<Site, Real>(site, array));
      }
    }
}

template <class Real>
using ScalarStencil = Stencil<detail::Site<Real>, Real>;

inline Vec3<double> const added_to{0.25, -0.5, 1};

template <class Prepared, class Field>
[[gnu::noinline]] Said said(Prepared const& prepared, Field const& spins) {
  using Real = typename Field::value_type;
  Said all;
  for_each_stencil(spins, [&](auto const& stencil) {
    auto const h = Vec3<Real>{Real(added_to.x), Real(added_to.y), Real(added_to.z)};
    all.field.push_back(in_double(prepared.field(stencil)));
    all.added.push_back(in_double(detail::add_field(prepared, stencil, h)));
    all.turning.push_back(in_double(detail::turning_field(prepared, stencil)));
    all.added_turning.push_back(in_double(detail::add_turning_field(prepared, stencil, h)));
    if constexpr (detail::comes_in_parts<Prepared, ScalarStencil<Real>>()) {
      all.neighbor.push_back(in_double(detail::neighbor_field(prepared, stencil)));
      using Site = std::remove_cvref_t<decltype(stencil.site())>;
      auto const m = stencil.center();
      detail::SpinAlone<Site> const alone(stencil.site(), m);
      all.local.push_back(in_double(detail::local_field(prepared, alone)));
      detail::SpinAlone<Site> const other(stencil.site(), {m.y, m.z, m.x});
      all.other_local.push_back(in_double(detail::local_field(prepared, other)));
    }
    all.energy.push_back(double(prepared.energy_density(stencil)));
    all.magnitude.push_back(double(detail::energy_magnitude(prepared, stencil)));
    Real of_terms[std::size_t{detail::energy_terms<Prepared> + 1}] = {};
    detail::energy_densities(prepared, stencil, of_terms);
    double sum = 0, magnitude = 0;
    for (Real const e : of_terms) sum += double(e), magnitude += std::abs(double(e));
    all.sum_of_terms.push_back(sum);
    all.magnitude_of_terms.push_back(magnitude);
  });
  return all;
}

/// Returns a term's H at every site.
template <class Term, class Field>
Vectors field_of(Term const& term, Field const& spins, double t) {
  auto const prepared = detail::prepare_term(term, Host(), spins, t);
  Vectors all;
  for_each_stencil(spins, [&](auto const& s) { all.push_back(in_double(prepared.field(s))); });
  return all;
}
template <class Term, class Field>
double energy_of(Term const& term, Field const& spins, double t) {
  auto const prepared = detail::prepare_term(term, Host(), spins, t);
  double sum = 0;
  for_each_stencil(spins, [&](auto const& s) { sum += double(prepared.energy_density(s)); });
  return sum;
}

/// Answers that a wrapper must share with the term inside it, except those that expect_answers()
/// leaves out.
struct Answers {
  bool linear, derivative, affine, conservative, depends_on_time, stationary, by_time;
  int energy_terms;
  friend bool operator==(Answers const&, Answers const&) = default;
};

template <class Real, class Term>
Answers answers(Term const& term, Setting<Real> const& on) {
  auto const spins = on.field(on.m);
  using Prepared = decltype(detail::prepare_term(term, Host(), spins, 0.0));
  using OfRate = decltype(detail::prepare_rate(term, Host(), spins, 0.0, 0.1));
  using Stencil = ScalarStencil<Real>;
  return {.linear = detail::has_linear_part<Prepared, Stencil>(),
          .derivative = detail::has_derivative<OfRate, Stencil>(),
          .affine = detail::has_affine_field(term, Host(), spins),
          .conservative = detail::is_conservative<Term>,
          .depends_on_time = detail::depends_on_time<Term>,
          .stationary = detail::is_stationary(term, Host(), spins),
          .by_time = detail::needs_only_time(term, Host(), spins),
          .energy_terms = detail::energy_terms<Term>};
}

class Members {
 public:
  /// `precision` is the epsilon of Real; the values compared are of the order of 10.
  Members(std::string what, double precision) : what_(std::move(what)), bound_(300 * precision) {}

  void expect_same(Vectors const& found, Vectors const& expected, char const* member,
                   double factor = 1) const {
    ASSERT_EQ(found.size(), expected.size());
    double off = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
      off = larger(off, length(found[i] - expected[i]));
    EXPECT_LE(off, factor * bound_) << what_ << ": " << member;
  }
  void expect_same(std::vector<double> const& found, std::vector<double> const& expected,
                   char const* member) const {
    double off = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
      off = larger(off, std::abs(found[i] - expected[i]));
    EXPECT_LE(off, bound_) << what_ << ": " << member;
  }
  /// Compares vectors up to a multiple of the spin.
  void expect_turns(Vectors found, Vectors expected, std::vector<double> const& m,
                    char const* member) const {
    for (std::size_t i = 0; i < found.size(); ++i) {
      auto const spin = at(m, static_cast<std::int64_t>(i));
      found[i] = cross(found[i], spin);
      expected[i] = cross(expected[i], spin);
    }
    expect_same(found, expected, member);
  }
  std::string const& what() const { return what_; }
  double bound() const { return bound_; }

 private:
  std::string what_;
  double bound_;
};

inline Vectors operator-(Vectors a, Vectors const& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] - b[i];
  return a;
}
inline Vectors operator*(double factor, Vectors a) {
  for (auto& v : a) v = factor * v;
  return a;
}

/// Returns f'(0) from differences with the step h, exact for polynomials up to degree 4.
template <class Function>
auto derivative(Function const& f, double h) {
  return (1 / (12 * h)) * (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h)));
}

/// Checks every member of a term. `factors`: one for each site, with H = -dE/dm * factor; empty:
/// all are 1.
template <class Real, class Term>
void expect_members(std::string const& name, Term const& term, Setting<Real> const& on,
                    std::vector<double> const& factors = {}) {
  Host const exec;
  Members const is(name + ", seed " + std::to_string(on.seed), epsilon<Real>);
  auto const spins = on.field(on.m), others = on.field(on.others), rates = on.field(on.rates);
  auto const m = numbers_of(spins), v = numbers_of(rates);
  auto const prepare = [&](auto const& of, double t) {
    return detail::prepare_term(term, exec, of, t);
  };
  auto const prepared = prepare(spins, on.t);
  using Prepared = std::remove_const_t<decltype(prepared)>;
  using Stencil = ScalarStencil<Real>;
  Said const here = said(prepared, spins);
  Vectors const field = field_of(term, spins, on.t);
  is.expect_same(here.field, field, "field");

  auto with_added = field;
  for (auto& h : with_added) h = h + added_to;
  is.expect_same(here.added, with_added, "add_field");
  is.expect_turns(here.turning, field, m, "turning_field");
  is.expect_turns(here.added_turning, with_added, m, "add_turning_field");

  // The neighbour field and the local field add up to the field, except for a multiple of the
  // spin, and the neighbour field does not depend on the site's own spin.
  if constexpr (detail::comes_in_parts<Prepared, Stencil>()) {
    is.expect_turns(here.neighbor - (-1.0 * here.local), field, m,
                    "neighbor_field and local_field");
    std::int64_t const sites = on.lattice.sites();
    for (std::int64_t site = on.seed % 2; site < sites; site += 3) {
      auto turned = m;
      for (int c = 0; c < 3; ++c)
        turned[static_cast<std::size_t>(3 * site + c)] =
            on.others[static_cast<std::size_t>(3 * site + c)];
      auto const there = on.field(turned);
      auto const i = static_cast<std::size_t>(site);
      auto const neighbor = said(prepare(there, on.t), there).neighbor;
      EXPECT_LE(length(neighbor[i] - here.neighbor[i]), is.bound())
          << is.what() << ": neighbor_field of the spin itself";
    }
    if (!detail::local_field_varies(prepared))
      is.expect_same(here.other_local, here.local, "local_field_varies");
  }

  // Prepared terms may be used at other times and with other spins where the term's traits say so.
  Vectors const later = field_of(term, others, on.t + 0.3);
  Said const of_others = said(prepared, others);
  if (detail::is_stationary(term, exec, spins))
    is.expect_same(of_others.field, later, "is_stationary");
  if (detail::needs_only_time(term, exec, spins))
    is.expect_same(of_others.field, field_of(term, others, on.t), "needs_only_time");
  if (!detail::depends_on_time<Term>)
    is.expect_same(later, field_of(term, others, on.t), "depends_on_time");

  is.expect_same(here.sum_of_terms, here.energy, "energy_densities");
  is.expect_same(here.magnitude_of_terms, here.magnitude, "energy_magnitude");
  if (detail::is_conservative<Term> || !factors.empty())
    for (std::int64_t site = on.seed % 4; site < on.lattice.sites(); site += 5) {
      auto const i = static_cast<std::size_t>(site);
      double slope[3];
      for (std::size_t c = 0; c < 3; ++c)
        slope[c] = derivative(
            [&](double h) {
              auto moved = m;
              moved[3 * i + c] += h;
              return energy_of(term, on.field(moved), on.t);
            },
            0.5);
      Vec3<double> const expected =
          (factors.empty() ? -1 : -factors[i]) * Vec3<double>{slope[0], slope[1], slope[2]};
      EXPECT_LE(length(here.field[i] - expected), 20 * is.bound())
          << is.what() << ": energy_density, site " << site;
    }

  if constexpr (detail::has_linear_part<Prepared, Stencil>()) {
    if (detail::has_affine_field(term, exec, spins)) {
      auto const of_rates = prepare(rates, on.t);
      Vectors linear;
      for_each_stencil(rates, [&](auto const& s) {
        linear.push_back(in_double(detail::LinearField()(of_rates, s)));
      });
      auto const both = field_of(term, on.field(combined(m, 1, v)), on.t);
      is.expect_same(linear, both - field, "linear_field", 4);
    }
  }
  double const dt = 0.25;
  using OfRate = decltype(detail::prepare_rate(term, exec, rates, on.t, dt));
  if constexpr (detail::has_derivative<OfRate, Stencil>()) {
    if (detail::has_linear_part<OfRate, Stencil>() &&
        !detail::has_affine_field(term, exec, spins)) {
      EXPECT_THROW(detail::prepare_rate(term, exec, rates, on.t, dt), std::invalid_argument)
          << is.what();
      return;
    }
    auto const of_rates = detail::prepare_rate(term, exec, rates, on.t, dt);
    Vectors found;
    for_each_stencil(rates, [&](auto const& s) {
      auto const site = static_cast<std::int64_t>(found.size());
      auto const spin = at(m, site);
      detail::FieldRate<Real> const rate{{Real(spin.x), Real(spin.y), Real(spin.z)}};
      found.push_back(in_double(rate(of_rates, s)));
    });
    auto const expected = derivative(
        [&](double h) { return field_of(term, on.field(combined(m, h, v)), on.t + h); }, 0.25);
    is.expect_same(found, expected, "field_rate", 30);
  }
}

}  // namespace cayspin::test
