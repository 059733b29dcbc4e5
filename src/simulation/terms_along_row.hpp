// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pass_terms.hpp"

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/stencil.hpp>

#include <cstdint>

// Terms whose H is computed along a piece of a row, in the L1 cache, by loops that are compiled
// once for all methods.
namespace cayspin::simulation {

/// Correction of exchange that treats vacancies as neighbours: for each vacancy beside a site, such
/// exchange lacks H = c * m, where c is the strength of the bond. `exchange` holds the sum of c for
/// each site.
template <class Real>
struct MissingNeighbors {
  cayspin::SiteArray<Real, 1> exchange;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    return stencil.site().load(exchange) * stencil.center();
  }
};

/// H that a stage adds to the terms compiled into it, in scenes without couplings. A single term
/// has its own loop; several terms share a loop that tests for each of them.
template <class Real>
struct AddedTerms {
  PassTerms<Real> terms;
  MissingNeighbors<Real> missing;  // without data: none
  double scale = 1;                // factor of -dE/dm
  double gyromagnetic = 1;         // factor of applied fields

  bool any() const { return count() > 0; }
  int count() const {
    return int{terms.usual.has_stored} + terms.anisotropies + terms.cubics_of_cell +
           terms.crystals + int{missing.exchange.data != nullptr} +
           int{terms.exchange_of_sites.any()} + terms.dmis + int{terms.interlayer_of_sites.any()} +
           int{terms.has_zhang_li} + int{terms.has_slonczewski} +
           int{terms.has_slonczewski_of_sites} + terms.sources.count;
  }
};

/// The whole H of scenes with couplings, distant interlayers, several sites per cell, or a moment
/// for each site.
template <class Real>
struct WholeTerms {
  PassTerms<Real> terms;
  bool lacks_local = false;  // computes only couplings; stages add the rest
};

/// The function that FieldAlongRows::evaluate points to, for AddedTerms or WholeTerms. Compiled by
/// terms_along_row_double.cpp and terms_along_row_single.cpp.
template <class Terms, class Real>
void evaluate_along(void const* terms, cayspin::detail::RowOfSpins<Real> const& row,
                    std::int32_t begin, std::int32_t end,
                    cayspin::detail::RowFields<Real> const& to);

}  // namespace cayspin::simulation
