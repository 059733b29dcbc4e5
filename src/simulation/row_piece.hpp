// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/detail/site.hpp>
#include <cayspin/stencil.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace cayspin::simulation {

/// Sites begin .. end - 1 of a row, and the memory for their H.
template <class Real>
struct RowPiece {
  cayspin::detail::RowOfSpins<Real> row;
  std::int32_t begin, end;
  cayspin::detail::RowFields<Real> fields;
  bool has_ends = true;  // false: no term couples sites along the row

  /// Calls visit(stencil, i) for the packs of the piece. Packs at the ends of the row have a
  /// separate loop, so that the others need no tests.
  template <class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void for_each(Visit const visit) const {
    constexpr std::ptrdiff_t lanes = cayspin::detail::host_lanes<Real>;
    std::ptrdiff_t const from = begin, to = end, last = (row.row.nx - 1) / lanes * lanes;
    along<false>(visit, has_ends ? std::max(from, lanes) : from, has_ends ? std::min(to, last) : to,
                 lanes);
    if (has_ends) for_each_at_ends(visit);
  }
  template <class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void for_each_at_ends(Visit const& visit) const {
    constexpr std::ptrdiff_t lanes = cayspin::detail::host_lanes<Real>;
    std::ptrdiff_t const last = (row.row.nx - 1) / lanes * lanes;
    along<true>(visit, begin > 0 ? last : 0, end, last > 0 ? last : lanes);
  }

 private:
  template <bool AtEdge, class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void along(Visit const& visit, std::ptrdiff_t from, std::ptrdiff_t to,
                                         std::ptrdiff_t step) const {
    using Site = cayspin::detail::Site<cayspin::detail::Pack<Real>, AtEdge>;
    // Copies, because the compiler must assume that stores of packs change values behind
    // references.
    cayspin::detail::Row const of_sites = row.row;
    cayspin::detail::RowStencil<Real> const of_spins = row.spins;
    for (std::ptrdiff_t x = from; x < to; x += step) {
      Site const site(of_sites, cayspin::detail::opaque(x));
      visit(Stencil<Site, Real, cayspin::detail::RowStencil<Real>>(site, of_spins), x - begin);
    }
  }
};

}  // namespace cayspin::simulation
