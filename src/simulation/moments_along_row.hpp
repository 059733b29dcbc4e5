// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pass_terms.hpp"

#include <cayspin/detail/row_fields.hpp>

#include <cstddef>

namespace cayspin::simulation {

/// Returns true for the field (not the gradient) of a scene with site-dependent moments and
/// otherwise only the usual terms of micromagnetics: exchange (uniform or site-dependent), uniform
/// DMI, uniaxial anisotropies, the demagnetising field and an applied field. The factors of
/// exchange and anisotropy in time must be 1.
template <class Real>
bool has_few_beside_moments(PassTerms<Real> const& terms) {
  return terms.per_moments.data && !terms.has_pairs && !terms.has_torques() && !terms.is_gradient &&
         terms.dmis == 0 && !terms.interlayer_of_sites.any() && terms.cubics_of_cell == 0 &&
         terms.crystals == 0 && terms.sources.count == 0 && terms.exchange_factor == 1 &&
         terms.anisotropy_factor == 1;
}

/// Functor that computes H times the gyromagnetic ratio along a row, for terms that
/// has_few_beside_moments() accepts. Like PassTerms, but without tests for other terms.
template <class Real, bool ExchangeOfSites, bool Vacancies>
struct LoopOfMoments {
  PassTerms<Real> const& terms;
  CellSite const mine;
  cayspin::SiteArray<Real, 1> const per_moments = terms.per_moments;
  cayspin::detail::RowFields<Real> const fields;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Stencil const& stencil, std::ptrdiff_t i) const {
    using Value = typename Stencil::value_type;
    auto h = bonds_and_axes<Value>(stencil);
    if (mine.quadratic.present()) h = mine.quadratic.add_field(stencil.center(), h);
    auto seen = as_value<Value>(terms.applied_in_field);
    if (terms.has_of_all) seen = seen + terms.of_all.field(stencil);
    fields.store(as_value<Value>(mine.gyromagnetic) *
                     multiply_add(stencil.site().load(per_moments), h, seen),
                 i);
  }

 private:
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> bonds_and_axes(Stencil const& stencil) const {
    auto h = zero<Value>();
    if constexpr (Vacancies) {
      h = bonds<Value>(terms.among_spins(stencil));
    } else {
      h = bonds<Value>(stencil);
    }
    for (std::int32_t i = 0; i < terms.anisotropies; ++i)
      h = h + terms.anisotropies_of_sites[i].field(stencil);
    return h;
  }
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> bonds(Stencil const& stencil) const {
    auto h = zero<Value>();
    if (terms.has_usual) h = terms.usual.field(stencil);
    if constexpr (ExchangeOfSites) h = h + terms.exchange_of_sites.field(stencil);
    return h;
  }
};

}  // namespace cayspin::simulation
