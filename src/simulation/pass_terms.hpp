// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_field_now.hpp"

#include <cayspin/field/bulk_dmi.hpp>
#include <cayspin/field/cubic_anisotropy.hpp>
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

/// A stencil in which the zero vector, of a site without a spin, is a missing neighbour.
template <class Inner>
class StencilAmongSpins {
 public:
  using value_type = typename Inner::value_type;
  using vector_type = typename Inner::vector_type;

  KOKKOS_FORCEINLINE_FUNCTION explicit StencilAmongSpins(Inner const& inner) : inner_(inner) {}

  KOKKOS_FORCEINLINE_FUNCTION vector_type const& center() const { return inner_.center(); }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous() const {
    return previous<Axis>(center());
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next() const {
    return next<Axis>(center());
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous(vector_type const& missing) const {
    return if_spin(inner_.template previous<Axis>(missing), missing);
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next(vector_type const& missing) const {
    return if_spin(inner_.template next<Axis>(missing), missing);
  }
  KOKKOS_FORCEINLINE_FUNCTION auto const& site() const { return inner_.site(); }

 private:
  KOKKOS_FORCEINLINE_FUNCTION static vector_type if_spin(vector_type const& found,
                                                         vector_type const& missing) {
    return cayspin::detail::select<value_type>(dot(found, found) == value_type(0), missing, found);
  }

  Inner const& inner_;
};

/// An anisotropy whose constant differs from site to site.
template <class Real>
using AnisotropyOfSites =
    cayspin::detail::UniaxialAnisotropyOfSites<cayspin::detail::SiteArray<Real, 1>, Vec3<double>>;

/// Dzyaloshinskii-Moriya interaction whose constant differs from site to site. That of a bond along
/// the axis e is the mean of its ends': H = sum of D v x m' over next and -D v x m' over previous
/// neighbours, v = n x e / spacing of an interface, and -e / spacing of the bulk.
template <class Real>
struct DmiOfSites {
  cayspin::detail::SiteArray<Real, 1> constants;
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

/// All terms of a scene at one instant, for one kernel. Which are there is asked at run time.
template <class Real>
struct PassTerms {
  SceneFieldNow<Real> usual;  // without the applied field
  cayspin::detail::PairField<Real> pairs;
  cayspin::detail::UniformBulkDmi bulk_dmi;
  cayspin::detail::UniformZhangLi zhang_li;
  Slonczewski slonczewski;
  Zeeman applied;
  CellSite const* sites;
  CubicAnisotropy const* cubics;
  cayspin::detail::ExchangeOfSites<Real> exchange_of_sites;  // without data: none
  DmiOfSites<Real> dmi_of_sites;                             // the same
  AnisotropyOfSites<Real> const* anisotropies_of_sites;
  std::int32_t anisotropies;
  bool has_usual, has_cubics, has_pairs, has_bulk_dmi, has_zhang_li, has_slonczewski, has_vacancies;
  bool is_gradient;  // -dE/dm, without moments, gyromagnetic ratios and torques

  template <class Value>
  struct Result {
    Vec3<Value> field;
    Value energy;
  };

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Result<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Result<Value> of_pairs{zero<Value>(), Value(0)};
    if (has_pairs) {
      auto const parts = pairs.parts(stencil);
      of_pairs = {parts.field(), parts.energy(stencil.center())};
    }
    return beside_pairs(stencil, of_pairs);
  }
  /// The same with what the pairs contribute.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Result<typename Stencil::value_type> beside_pairs(
      Stencil const& stencil, Result<typename Stencil::value_type> const& of_pairs) const {
    using Value = typename Stencil::value_type;
    if (!has_vacancies) return among(stencil, of_pairs);
    auto found = among(StencilAmongSpins<Stencil>(stencil), of_pairs);
    Value const none(0), square = dot(stencil.center(), stencil.center());
    found.energy = cayspin::detail::select<Value>(square == none, none, found.energy);
    return found;
  }

  /// Is there nothing but couplings, axes of the cell's sites, and an applied field? In most scenes
  /// of crystals, which need not ask for the rest at each site.
  bool has_few() const {
    return !has_usual && !has_bulk_dmi && !has_zhang_li && !has_slonczewski && !is_gradient &&
           !exchange_of_sites.constants.data && !dmi_of_sites.constants.data && anisotropies == 0 &&
           !has_cubics;
  }
  /// Then H of sites begin .. end - 1 of a row, in place of what the pairs contribute.
  CAYSPIN_DETAIL_NOINLINE void add_few(cayspin::detail::RowInput<Real> spins,
                                       cayspin::detail::Row const& row, std::int32_t begin,
                                       std::int32_t end,
                                       cayspin::detail::RowFields<Real> fields) const {
    using Value = cayspin::detail::Pack<Real>;
    using Site = cayspin::detail::Site<Value>;
    CellSite const mine = sites[pairs.site_of_plane(row.z)];
    Vec3<double> const of_field = applied.applied;
    for (std::int32_t x = begin; x < end; x += Site::lanes) {
      auto h = fields.template load<Value>(x - begin);
      if (mine.quadratic.present()) h = mine.quadratic.add_field(Site(row, x).load(spins), h);
      fields.store(seen_by_moment(mine, of_field, h), x - begin);
    }
  }

 private:
  /// Of -dE/dm.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> seen_by_moment(CellSite const& site,
                                                                Vec3<double> const& applied,
                                                                Vec3<Value> const& h) {
    return as_value<Value>(site.gyromagnetic) *
           multiply_add(as_value<Value>(site.per_moment), h, as_value<Value>(applied));
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Result<typename Stencil::value_type> among(
      Stencil const& stencil, Result<typename Stencil::value_type> const& of_pairs) const {
    using Value = typename Stencil::value_type;
    auto const& m = stencil.center();
    auto const& mine = sites[pairs.site_of_plane(stencil.site().z())];
    // -dE/dm, of which each moment sees its own part.
    Vec3<Value> h = of_pairs.field;
    Value e = of_pairs.energy;
    if (has_usual) {
      h = h + usual.field(stencil);
      e = e + usual.energy_density(stencil);
    }
    if (has_bulk_dmi) {
      Vec3<Value> const of_bulk = bulk_dmi.field(stencil);
      h = h + of_bulk;
      e = e + Value(-0.5) * dot(m, of_bulk);
    }
    if (exchange_of_sites.constants.data) {
      h = h + exchange_of_sites.field(stencil);
      e = e + exchange_of_sites.energy_density(stencil);
    }
    if (dmi_of_sites.constants.data) {
      Vec3<Value> const of_dmi = dmi_of_sites.field(stencil);
      h = h + of_dmi;
      e = e + Value(-0.5) * dot(m, of_dmi);
    }
    for (std::int32_t i = 0; i < anisotropies; ++i) {
      Vec3<Value> const of_axis = anisotropies_of_sites[i].field(stencil);
      h = h + of_axis;
      e = e + Value(-0.5) * dot(m, of_axis);
    }
    if (mine.quadratic.present()) {
      h = mine.quadratic.add_field(m, h);
      e = e + mine.quadratic.energy(m);
    }
    for (std::int32_t i = mine.first_cubic; i < mine.last_cubic; ++i) {
      h = h + cubics[i].field(stencil);
      e = e + cubics[i].energy_density(stencil);
    }
    auto const moment = as_value<Value>(mine.moment);
    e = e + moment * applied.energy_density(stencil);
    if (is_gradient) return {multiply_add(moment, applied.field(stencil), h), e};
    h = seen_by_moment(mine, applied.applied, h);
    // Torques are no derivatives of an energy.
    if (has_zhang_li) h = h + zhang_li.field(stencil);
    if (has_slonczewski) h = h + slonczewski.field(stencil);
    return {h, e};
  }
};

}  // namespace cayspin::simulation
