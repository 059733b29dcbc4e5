// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "crystal_anisotropy_of_sites.hpp"
#include "interlayer_of_sites.hpp"
#include "scene_field_now.hpp"
#include "slonczewski_of_sites.hpp"

#include <cayspin/field/cubic_anisotropy.hpp>
#include <cayspin/field/field_with_vacancies.hpp>
#include <cayspin/field/pair_couplings.hpp>
#include <cayspin/field/site_dependent_exchange.hpp>
#include <cayspin/field/slonczewski.hpp>
#include <cayspin/field/zhang_li.hpp>

#include <cstdint>

namespace cayspin::simulation {

/// Constants of a site of the cell.
struct CellSite {
  double moment = 1, per_moment = 1, gyromagnetic = 1;
  QuadraticTerms quadratic;
  std::int32_t first_cubic = 0, last_cubic = 0;
};

/// Uniaxial anisotropy H = (K * m.e + K2 * (m.e)^3) * e with site-dependent K (`constants`), K2
/// (`second`) and axis e (`axes`). If `axes` has no data, all sites have the same axis; if `second`
/// has none, K2 is 0.
template <class Real>
struct AnisotropyOfSites {
  cayspin::SiteArray<Real, 1> constants;
  Vec3<double> axis;
  cayspin::SiteArray<Real, 3> axes = {};
  cayspin::SiteArray<Real, 1> second = {};

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const e = axis_at<Value>(stencil);
    Value const along = dot(stencil.center(), e);
    Value h = stencil.site().load(constants) * along;
    if (second.data) h = h + stencil.site().load(second) * along * (along * along);
    return h * e;
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const along = dot(stencil.center(), axis_at<Value>(stencil)), square = along * along;
    Value const first = Value(-0.5) * stencil.site().load(constants) * square;
    if (!second.data) return first;
    return first - Value(0.25) * stencil.site().load(second) * square * square;
  }

 private:
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> axis_at(Stencil const& stencil) const {
    return axes.data ? Vec3<Value>(stencil.site().load(axes)) : as_value<Value>(axis);
  }
};

/// Functor that stores, for each site, the sum of `bonds` over its neighbours that are vacant.
template <class Real>
struct FindMissing {
  cayspin::SiteArray<Real, 1> moments;  // 0: a vacancy
  cayspin::OutputArray<Real, 1> missing;
  double bonds[3];

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    site.store(along<0>(site) + along<1>(site) + along<2>(site), missing);
  }

 private:
  template <int Axis, class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto along(Site const& site) const {
    using Value = typename Site::value_type;
    Value const one(1);  // past an open end there is no vacancy
    Value const back = site.template neighbor<Axis, 0>(moments, one),
                on = site.template neighbor<Axis, 1>(moments, one);
    auto const bond = as_value<Value>(bonds[Axis]);
    return Value(if_vacant(back, bond) + if_vacant(on, bond));
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value if_vacant(Value const& moment, Value const& bond) {
    Value const none(0);
    return cayspin::detail::select<Value>(moment == none, bond, none);
  }
};

/// Dzyaloshinskii-Moriya interaction with a site-dependent constant. The D of a bond along the axis
/// e is the mean of the constants at its ends. H is the sum of D * (v x m') over next neighbours
/// and of -D * (v x m') over previous ones. The vector v is (n x e) / spacing for an interface and
/// -e / spacing for the bulk. For D2d symmetry, v is x / spacing along x, -y / spacing along y and
/// zero along z.
template <class Real>
struct DmiOfSites {
  cayspin::SiteArray<Real, 1> constants;
  Vec3<double> vectors[3];

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    return along<0>(stencil) + along<1>(stencil) + along<2>(stencil);
  }

 private:
  template <int Axis, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> along(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& v = vectors[Axis];
    auto const none = zero<Value>();
    if (v.x == 0 && v.y == 0 && v.z == 0) return none;
    auto const& site = stencil.site();
    Value const own = site.load(constants), half(0.5);
    Value const before = half * (own + site.template neighbor<Axis, 0>(constants, own)),
                after = half * (own + site.template neighbor<Axis, 1>(constants, own));
    return cross(as_value<Value>(v), after * stencil.template next<Axis>(none) -
                                         before * stencil.template previous<Axis>(none));
  }
};

/// H = sum of factor * profile over all sources, at one time. The first `most` sources are in the
/// struct itself, for speed; all others are in tables that the kernel can read.
template <class Real>
struct SourcesNow {
  static constexpr std::size_t most = 8;
  cayspin::SiteArray<Real, 3> profiles[most];
  double factors[most];
  cayspin::SiteArray<Real, 3> const* other_profiles = nullptr;
  double const* other_factors = nullptr;
  std::int32_t count = 0, others = 0;
  double largest = 0;  // bound on |H|

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto h = zero<Value>();
    for (std::int32_t i = 0; i < count; ++i)
      h = multiply_add(as_value<Value>(factors[i]), stencil.site().load(profiles[i]), h);
    for (std::int32_t i = 0; i < others; ++i)
      h = multiply_add(as_value<Value>(other_factors[i]), stencil.site().load(other_profiles[i]),
                       h);
    return h;
  }
};

/// H and E of terms. The compiler omits E where it is not used.
template <class Value>
struct FieldAndEnergy {
  Vec3<Value> field;
  Value energy;

  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION void add(Term const& term, Stencil const& stencil) {
    field = field + term.field(stencil);
    energy = energy + term.energy_density(stencil);
  }
  /// Adds a term whose H is linear in the spins.
  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION void add_linear(Term const& term, Stencil const& stencil) {
    Vec3<Value> const h = term.field(stencil);
    field = field + h;
    energy = energy + Value(-0.5) * dot(stencil.center(), h);
  }
  /// Adds `factor` times `others`.
  KOKKOS_FORCEINLINE_FUNCTION void add_times(double factor, FieldAndEnergy const& others) {
    auto const times = as_value<Value>(factor);
    field = multiply_add(times, others.field, field);
    energy = energy + times * others.energy;
  }
};

/// All terms of a scene at one instant, for one kernel, enabled at run time.
template <class Real>
struct PassTerms {
  SceneFieldNow<Real> usual;  // without the applied field
  cayspin::detail::PairField<Real> pairs;
  cayspin::detail::UniformZhangLi zhang_li;
  Slonczewski slonczewski;
  SlonczewskiOfSites<Real> slonczewski_of_sites;
  Zeeman applied;
  CellSite const* sites;
  CubicAnisotropy const* cubics;
  cayspin::detail::ExchangeOfSites<Real> exchange_of_sites;
  DmiOfSites<Real> dmi_of_sites[3];
  InterlayerOfSites<Real> interlayer_of_sites;
  AnisotropyOfSites<Real> const* anisotropies_of_sites;
  CrystalAnisotropyOfSites<Real> const* crystals_of_sites;
  std::int32_t dmis, anisotropies, crystals, cubics_of_cell;
  std::int32_t anisotropies_in_time;          // how many, from the first on, have anisotropy_factor
  double exchange_factor, anisotropy_factor;  // uniform exchange already includes its factor
  cayspin::SiteArray<Real, 1> moments;        // 0 where there is no spin
  SourcesNow<Real> sources;
  cayspin::SiteArray<Real, 1> per_moments;       // 1 / moment; without data: CellSite::per_moment
  cayspin::SiteArray<Real, 1> per_gyromagnetic;  // for torques: 1 / gyromagnetic ratio; or no data
  cayspin::detail::StoredField<Real> of_all;     // due to all spins; acts like an applied field
  Vec3<double> applied_in_field;  // zero if the kernels of the methods add the applied field
  bool has_usual, has_pairs, has_zhang_li;
  bool zhang_li_per_moment;  // multiplied by per_moments, which has data
  bool has_slonczewski, has_slonczewski_of_sites;
  bool has_vacancies, has_of_all;
  bool is_gradient;  // computes -dE/dm, without gyromagnetic ratios and torques

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION FieldAndEnergy<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    FieldAndEnergy<Value> of_pairs{zero<Value>(), Value(0)};
    if (has_pairs) {
      auto const parts = pairs.parts(stencil);
      of_pairs = {parts.field(), parts.energy(stencil.center())};
    }
    return beside_pairs(stencil, of_pairs);
  }
  /// Computes H and E, given the contribution of the pairs.
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION FieldAndEnergy<Value> beside_pairs(
      Stencil const& stencil, FieldAndEnergy<Value> const& of_pairs) const {
    if (!has_vacancies) return among(stencil, of_pairs);
    auto found = among(among_spins(stencil), of_pairs);
    Value const none(0), moment = stencil.site().load(moments);
    found.energy = cayspin::detail::select<Value>(moment == none, none, found.energy);
    return found;
  }

  /// Returns a stencil in which vacancies count as missing neighbours.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION cayspin::detail::StencilAmongVacancies<Stencil, Real> among_spins(
      Stencil const& stencil) const {
    return {stencil, moments};
  }

  KOKKOS_FORCEINLINE_FUNCTION bool has_torques() const {
    return has_zhang_li || has_slonczewski || has_slonczewski_of_sites;
  }
  KOKKOS_FORCEINLINE_FUNCTION bool has_bonds_of_sites() const {
    return exchange_of_sites.any() || dmis > 0 || interlayer_of_sites.any();
  }
  bool has_local_of_sites() const { return anisotropies > 0 || crystals > 0 || cubics_of_cell > 0; }
  /// Returns true if there are only couplings, anisotropy axes of the cell's sites, and an applied
  /// field, as in most scenes of crystals. The kernels for these terms need no tests for other
  /// terms at each site.
  bool has_few() const {
    return !has_usual && !has_torques() && !is_gradient && !has_bonds_of_sites() &&
           !has_local_of_sites() && !per_moments.data && sources.count == 0 &&
           anisotropy_factor == 1;
  }

  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_bonds_of_sites(Stencil const& stencil,
                                                      FieldAndEnergy<Value>& sum) const {
    if (exchange_of_sites.any()) {
      if (exchange_factor == 1) [[likely]] {
        sum.add(exchange_of_sites, stencil);
      } else {
        FieldAndEnergy<Value> one{zero<Value>(), Value(0)};
        one.add(exchange_of_sites, stencil);
        sum.add_times(exchange_factor, one);
      }
    }
    for (std::int32_t i = 0; i < dmis; ++i) sum.add_linear(dmi_of_sites[i], stencil);
    if (interlayer_of_sites.any()) sum.add(interlayer_of_sites, stencil);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_anisotropies_of_sites(Stencil const& stencil,
                                                             FieldAndEnergy<Value>& sum) const {
    for (std::int32_t i = 0; i < anisotropies; ++i) sum.add(anisotropies_of_sites[i], stencil);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_cubics(Stencil const& stencil, std::int32_t first,
                                              std::int32_t last, FieldAndEnergy<Value>& sum) const {
    for (std::int32_t i = first; i < last; ++i) sum.add(cubics[i], stencil);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_crystals(Stencil const& stencil,
                                                FieldAndEnergy<Value>& sum) const {
    for (std::int32_t i = 0; i < crystals; ++i) sum.add(crystals_of_sites[i], stencil);
  }
  /// Adds all anisotropies, for an anisotropy_factor other than 1.
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_anisotropy_in_time(Stencil const& stencil,
                                                          QuadraticTerms const& quadratic,
                                                          std::int32_t first, std::int32_t last,
                                                          FieldAndEnergy<Value>& sum) const {
    FieldAndEnergy<Value> now{zero<Value>(), Value(0)};
    for (std::int32_t i = 0; i < anisotropies_in_time; ++i)
      now.add(anisotropies_of_sites[i], stencil);
    if (quadratic.present()) {
      now.field = quadratic.add_field(stencil.center(), now.field);
      now.energy = now.energy + quadratic.energy(stencil.center());
    }
    add_cubics(stencil, first, last, now);
    add_crystals(stencil, now);
    sum.add_times(anisotropy_factor, now);
    for (std::int32_t i = anisotropies_in_time; i < anisotropies; ++i)
      sum.add(anisotropies_of_sites[i], stencil);
  }
  /// Adds torques, which have no energy.
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> add_torques(Stencil const& stencil, Vec3<Value> h) const {
    if (per_gyromagnetic.data)
      return multiply_add(Value(stencil.site().load(per_gyromagnetic)),
                          sum_of_torques(stencil, zero<Value>()), h);
    return sum_of_torques(stencil, h);
  }

  KOKKOS_FORCEINLINE_FUNCTION CellSite const& site_of_plane(std::int32_t z) const {
    return sites[pairs.site_of_plane(z)];
  }

  /// Returns the H that acts on a site's moment, multiplied by the gyromagnetic ratio. `h`: -dE/dm
  /// without the applied field.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> seen_by_moment(CellSite const& site,
                                                                Vec3<double> const& applied,
                                                                Vec3<Value> const& h) {
    return as_value<Value>(site.gyromagnetic) *
           multiply_add(as_value<Value>(site.per_moment), h, as_value<Value>(applied));
  }

 private:
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> sum_of_torques(Stencil const& stencil,
                                                         Vec3<Value> h) const {
    if (has_zhang_li) {
      auto const of_current = zhang_li.field(stencil);
      h = zhang_li_per_moment ? multiply_add(Value(stencil.site().load(per_moments)), of_current, h)
                              : h + of_current;
    }
    if (has_slonczewski) h = h + slonczewski.field(stencil);
    if (has_slonczewski_of_sites) h = h + slonczewski_of_sites.field(stencil);
    return h;
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION FieldAndEnergy<Value> among(
      Stencil const& stencil, FieldAndEnergy<Value> const& of_pairs) const {
    auto const& m = stencil.center();
    auto const& mine = site_of_plane(stencil.site().z());
    // -dE/dm and E, without applied fields. H is computed from -dE/dm below.
    auto sum = of_pairs;
    if (has_usual) sum.add(usual, stencil);
    add_bonds_of_sites(stencil, sum);
    if (anisotropy_factor == 1) [[likely]] {
      add_anisotropies_of_sites(stencil, sum);
      if (mine.quadratic.present()) {
        sum.field = mine.quadratic.add_field(m, sum.field);
        sum.energy = sum.energy + mine.quadratic.energy(m);
      }
      add_cubics(stencil, mine.first_cubic, mine.last_cubic, sum);
      add_crystals(stencil, sum);
    } else {
      add_anisotropy_in_time(stencil, mine.quadratic, mine.first_cubic, mine.last_cubic, sum);
    }
    if (per_moments.data || sources.count > 0) return with_fields_of_sites(stencil, mine, sum);
    auto const moment = as_value<Value>(mine.moment);
    sum.energy = sum.energy + moment * applied.energy_density(stencil);
    if (is_gradient) return {multiply_add(moment, applied.field(stencil), sum.field), sum.energy};
    return {add_torques(stencil, seen_by_moment(mine, applied_in_field, sum.field)), sum.energy};
  }
  /// Used if each site has its own moment or applied field.
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION FieldAndEnergy<Value> with_fields_of_sites(
      Stencil const& stencil, CellSite const& mine, FieldAndEnergy<Value> sum) const {
    auto moment = as_value<Value>(mine.moment), per_moment = as_value<Value>(mine.per_moment);
    if (per_moments.data) {
      moment = stencil.site().load(moments);
      per_moment = stencil.site().load(per_moments);
    }
    auto seen = sources.field(stencil);
    sum.energy =
        sum.energy + moment * (applied.energy_density(stencil) - dot(stencil.center(), seen));
    seen = seen + (is_gradient ? applied.field(stencil) : as_value<Value>(applied_in_field));
    if (has_of_all) {
      seen = seen + of_all.field(stencil);
      sum.energy = sum.energy + moment * of_all.energy_density(stencil);
    }
    if (is_gradient) return {multiply_add(moment, seen, sum.field), sum.energy};
    return {add_torques(stencil, as_value<Value>(mine.gyromagnetic) *
                                     multiply_add(per_moment, sum.field, seen)),
            sum.energy};
  }
};

}  // namespace cayspin::simulation
