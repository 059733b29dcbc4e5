// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_field_now.hpp"

#include <cayspin/field/cubic_anisotropy.hpp>
#include <cayspin/field/field_with_vacancies.hpp>
#include <cayspin/field/pair_couplings.hpp>
#include <cayspin/field/site_dependent_exchange.hpp>
#include <cayspin/field/site_dependent_uniaxial_anisotropy.hpp>
#include <cayspin/field/slonczewski.hpp>
#include <cayspin/field/zhang_li.hpp>

#include <cstdint>

namespace cayspin::simulation {

/// What a site of a cell has of its own.
struct CellSite {
  double moment = 1, per_moment = 1, gyromagnetic = 1;
  QuadraticTerms quadratic;
  std::int32_t first_cubic = 0, last_cubic = 0;
};

/// An anisotropy whose constant differs from site to site.
template <class Real>
using AnisotropyOfSites =
    cayspin::detail::UniaxialAnisotropyOfSites<cayspin::SiteArray<Real, 1>, Vec3<double>>;

/// The constants of a site's bonds to vacancies, over the spacing squared.
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
    Value const one(1);  // past an open end
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

/// Dzyaloshinskii-Moriya interaction whose constant differs from site to site. That of a bond along
/// the axis e is the mean of its ends': H = sum of D v x m' over next and -D v x m' over previous
/// neighbours, v = n x e / spacing of an interface, and -e / spacing of the bulk.
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

/// H and E of terms. E is computed where it is used.
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
};

/// All terms of a scene at one instant, for one kernel. Which are there is asked at run time.
template <class Real>
struct PassTerms {
  SceneFieldNow<Real> usual;  // without the applied field
  cayspin::detail::PairField<Real> pairs;
  cayspin::detail::UniformZhangLi zhang_li;
  Slonczewski slonczewski;
  Zeeman applied;
  CellSite const* sites;
  CubicAnisotropy const* cubics;
  cayspin::detail::ExchangeOfSites<Real> exchange_of_sites;
  DmiOfSites<Real> dmi_of_sites;  // without data: none
  AnisotropyOfSites<Real> const* anisotropies_of_sites;
  std::int32_t anisotropies, cubics_of_cell;
  cayspin::SiteArray<Real, 1> moments;  // 0 where there is no spin
  Vec3<double> applied_in_field;  // zero where another adds what it makes of the applied field
  bool has_usual, has_pairs, has_zhang_li, has_slonczewski, has_vacancies;
  bool is_gradient;  // -dE/dm, without moments, gyromagnetic ratios and torques

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
  /// The same with what the pairs contribute.
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION FieldAndEnergy<Value> beside_pairs(
      Stencil const& stencil, FieldAndEnergy<Value> const& of_pairs) const {
    if (!has_vacancies) return among(stencil, of_pairs);
    auto found = among(among_spins(stencil), of_pairs);
    Value const none(0), moment = stencil.site().load(moments);
    found.energy = cayspin::detail::select<Value>(moment == none, none, found.energy);
    return found;
  }

  /// In which a vacancy is a missing neighbour.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION cayspin::detail::StencilAmongVacancies<Stencil, Real> among_spins(
      Stencil const& stencil) const {
    return {stencil, moments};
  }

  KOKKOS_FORCEINLINE_FUNCTION bool has_torques() const { return has_zhang_li || has_slonczewski; }
  KOKKOS_FORCEINLINE_FUNCTION bool has_bonds_of_sites() const {
    return exchange_of_sites.any() || dmi_of_sites.constants.data;
  }
  bool has_local_of_sites() const { return anisotropies > 0 || cubics_of_cell > 0; }
  /// Is there nothing but couplings, axes of the cell's sites, and an applied field? In most scenes
  /// of crystals, which need not ask for the rest at each site.
  bool has_few() const {
    return !has_usual && !has_torques() && !is_gradient && !has_bonds_of_sites() &&
           !has_local_of_sites();
  }

  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_bonds_of_sites(Stencil const& stencil,
                                                      FieldAndEnergy<Value>& sum) const {
    if (exchange_of_sites.any()) sum.add(exchange_of_sites, stencil);
    if (dmi_of_sites.constants.data) sum.add_linear(dmi_of_sites, stencil);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_anisotropies_of_sites(Stencil const& stencil,
                                                             FieldAndEnergy<Value>& sum) const {
    for (std::int32_t i = 0; i < anisotropies; ++i)
      sum.add_linear(anisotropies_of_sites[i], stencil);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_cubics(Stencil const& stencil, std::int32_t first,
                                              std::int32_t last, FieldAndEnergy<Value>& sum) const {
    for (std::int32_t i = first; i < last; ++i) sum.add(cubics[i], stencil);
  }
  /// Torques are no derivatives of an energy.
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> add_torques(Stencil const& stencil, Vec3<Value> h) const {
    if (has_zhang_li) h = h + zhang_li.field(stencil);
    if (has_slonczewski) h = h + slonczewski.field(stencil);
    return h;
  }

  KOKKOS_FORCEINLINE_FUNCTION CellSite const& site_of_plane(std::int32_t z) const {
    return sites[pairs.site_of_plane(z)];
  }

  /// H of a site's moment, where `h` is -dE/dm of all but the applied field.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> seen_by_moment(CellSite const& site,
                                                                Vec3<double> const& applied,
                                                                Vec3<Value> const& h) {
    return as_value<Value>(site.gyromagnetic) *
           multiply_add(as_value<Value>(site.per_moment), h, as_value<Value>(applied));
  }

 private:
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION FieldAndEnergy<Value> among(
      Stencil const& stencil, FieldAndEnergy<Value> const& of_pairs) const {
    auto const& m = stencil.center();
    auto const& mine = site_of_plane(stencil.site().z());
    // -dE/dm, of which each moment sees its own part.
    auto sum = of_pairs;
    if (has_usual) sum.add(usual, stencil);
    add_bonds_of_sites(stencil, sum);
    add_anisotropies_of_sites(stencil, sum);
    if (mine.quadratic.present()) {
      sum.field = mine.quadratic.add_field(m, sum.field);
      sum.energy = sum.energy + mine.quadratic.energy(m);
    }
    add_cubics(stencil, mine.first_cubic, mine.last_cubic, sum);
    auto const moment = as_value<Value>(mine.moment);
    sum.energy = sum.energy + moment * applied.energy_density(stencil);
    if (is_gradient) return {multiply_add(moment, applied.field(stencil), sum.field), sum.energy};
    return {add_torques(stencil, seen_by_moment(mine, applied_in_field, sum.field)), sum.energy};
  }
};

}  // namespace cayspin::simulation
