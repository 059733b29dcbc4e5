// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "moments_along_row.hpp"
#include "pass_terms.hpp"

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/stencil.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

// H along a piece of a row, in the L1 cache, by loops that are compiled once for all methods.
namespace cayspin::simulation {

/// Sites begin .. end - 1 of a row, and the memory for their H.
template <class Real>
struct RowPiece {
  cayspin::detail::RowOfSpins<Real> row;
  std::int32_t begin, end;
  cayspin::detail::RowFields<Real> fields;

  /// Calls visit(stencil, i) for the packs of the piece. Packs at the ends of the row have a
  /// separate loop, so that the others need no tests.
  template <class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void for_each(Visit const visit) const {
    constexpr std::ptrdiff_t lanes = cayspin::detail::host_lanes<Real>;
    std::ptrdiff_t const from = begin, to = end, last = (row.row.nx - 1) / lanes * lanes;
    along<false>(visit, std::max(from, lanes), std::min(to, last), lanes);
    for_each_at_ends(visit);
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

  void along(RowPiece<Real> const& piece) const {
    bool const changes = terms.exchange_factor != 1 || terms.anisotropy_factor != 1;
    if (count() > 1 || scale != 1 || gyromagnetic != 1 || changes || terms.per_gyromagnetic.data)
      return run(Loop{*this, piece.fields}, piece);
    if (missing.exchange.data) return run_alone(missing, piece);
    if (terms.anisotropies > 0) return run_alone(terms.anisotropies_of_sites[0], piece);
    if (terms.cubics_of_cell > 0) return run_alone(terms.cubics[0], piece);
    if (terms.crystals > 0) return run_alone(terms.crystals_of_sites[0], piece);
    if (terms.has_vacancies) return run(Loop{*this, piece.fields}, piece);
    if (terms.exchange_of_sites.any()) return run_alone(terms.exchange_of_sites, piece);
    if (terms.dmis > 0) return run_alone(terms.dmi_of_sites[0], piece);
    if (terms.interlayer_of_sites.any()) return run_alone(terms.interlayer_of_sites, piece);
    if (terms.has_zhang_li) return run_alone(terms.zhang_li, piece);
    if (terms.has_slonczewski) return run_alone(terms.slonczewski, piece);
    if (terms.has_slonczewski_of_sites) return run_alone(terms.slonczewski_of_sites, piece);
    if (terms.sources.count > 0) return run_alone(terms.sources, piece);
    run(Loop{*this, piece.fields}, piece);
  }

 private:
  int count() const {
    return int{terms.usual.has_stored} + terms.anisotropies + terms.cubics_of_cell +
           terms.crystals + int{missing.exchange.data != nullptr} +
           int{terms.exchange_of_sites.any()} + terms.dmis + int{terms.interlayer_of_sites.any()} +
           int{terms.has_zhang_li} + int{terms.has_slonczewski} +
           int{terms.has_slonczewski_of_sites} + terms.sources.count;
  }

  struct Loop {
    AddedTerms const& added;
    cayspin::detail::RowFields<Real> fields;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION void operator()(Stencil const& stencil, std::ptrdiff_t i) const {
      using Value = typename Stencil::value_type;
      auto const& terms = added.terms;
      FieldAndEnergy<Value> sum{zero<Value>(), Value(0)};
      if (terms.has_bonds_of_sites()) {
        if (terms.has_vacancies)
          terms.add_bonds_of_sites(terms.among_spins(stencil), sum);
        else
          terms.add_bonds_of_sites(stencil, sum);
      }
      if (terms.anisotropy_factor == 1) [[likely]] {
        terms.add_anisotropies_of_sites(stencil, sum);
        terms.add_cubics(stencil, 0, terms.cubics_of_cell, sum);
        terms.add_crystals(stencil, sum);
      } else {
        terms.add_anisotropy_in_time(stencil, {}, 0, terms.cubics_of_cell, sum);
      }
      if (terms.usual.has_stored) sum.field = sum.field + terms.usual.stored.field(stencil);
      auto h = as_value<Value>(added.scale) * sum.field;
      if (terms.sources.count > 0)
        h = multiply_add(as_value<Value>(added.gyromagnetic), terms.sources.field(stencil), h);
      if (added.missing.exchange.data) {
        auto const lacking = added.missing.field(stencil);
        h = terms.exchange_factor == 1
                ? h + lacking
                : multiply_add(as_value<Value>(terms.exchange_factor), lacking, h);
      }
      if (terms.has_torques()) {
        if (terms.has_vacancies)
          h = terms.add_torques(terms.among_spins(stencil), h);
        else
          h = terms.add_torques(stencil, h);
      }
      fields.store(h, i);
    }
  };

  template <class Term>
  struct LoopOf {
    Term const term;
    cayspin::detail::RowFields<Real> const fields;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION void operator()(Stencil const& stencil, std::ptrdiff_t i) const {
      fields.store(term.field(stencil), i);
    }
  };
  template <class Term>
  static void run_alone(Term const& term, RowPiece<Real> const& piece) {
    run(LoopOf<Term>{term, piece.fields}, piece);
  }
  template <class AnyLoop>
  CAYSPIN_DETAIL_NOINLINE static void run(AnyLoop const& loop, RowPiece<Real> const& piece) {
    piece.for_each(loop);
  }
};

/// The whole H of scenes with couplings, distant interlayers, several sites per cell, or a moment
/// for each site.
template <class Real>
struct WholeTerms {
  PassTerms<Real> terms;
  bool lacks_local = false;  // computes only couplings; stages add the rest

  struct Loop {
    PassTerms<Real> const& terms;
    cayspin::detail::RowFields<Real> fields;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION void operator()(Stencil const& stencil, std::ptrdiff_t i) const {
      using Value = typename Stencil::value_type;
      auto const before = terms.has_pairs ? fields.template load<Value>(i) : zero<Value>();
      auto const found = terms.beside_pairs(stencil, FieldAndEnergy<Value>{before, Value(0)});
      fields.store(found.field, i);
    }
  };
  struct LoopOfFew {
    CellSite mine;
    Vec3<double> applied;
    cayspin::detail::RowFields<Real> fields;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION void operator()(Stencil const& stencil, std::ptrdiff_t i) const {
      auto h = fields.template load<typename Stencil::value_type>(i);
      if (mine.quadratic.present()) h = mine.quadratic.add_field(stencil.center(), h);
      fields.store(PassTerms<Real>::seen_by_moment(mine, applied, h), i);
    }
  };

  void along(RowPiece<Real> const& piece) const {
    if (terms.has_pairs)
      terms.pairs.evaluate_row(piece.row.row, piece.begin, piece.end, piece.fields);
    if (lacks_local) return;
    if (terms.has_pairs && terms.has_few())
      run_few(piece);
    else if (has_few_beside_moments(terms))
      run_moments(piece);
    else
      run(piece);
  }

 private:
  CAYSPIN_DETAIL_NOINLINE void run(RowPiece<Real> const& piece) const {
    piece.for_each(Loop{terms, piece.fields});
  }
  void run_moments(RowPiece<Real> const& piece) const {
    if (terms.exchange_of_sites.any())
      terms.has_vacancies ? run_moments<true, true>(piece) : run_moments<true, false>(piece);
    else
      terms.has_vacancies ? run_moments<false, true>(piece) : run_moments<false, false>(piece);
  }
  template <bool ExchangeOfSites, bool Vacancies>
  CAYSPIN_DETAIL_NOINLINE void run_moments(RowPiece<Real> const& piece) const {
    piece.for_each(LoopOfMoments<Real, ExchangeOfSites, Vacancies>{
        .terms = terms, .mine = terms.site_of_plane(piece.row.row.z), .fields = piece.fields});
  }
  CAYSPIN_DETAIL_NOINLINE void run_few(RowPiece<Real> const& piece) const {
    piece.for_each(
        LoopOfFew{terms.site_of_plane(piece.row.row.z), terms.applied_in_field, piece.fields});
  }
};

/// The function that FieldAlongRows::evaluate points to.
template <class Terms, class Real>
void evaluate_along(void const* terms, cayspin::detail::RowOfSpins<Real> const& row,
                    std::int32_t begin, std::int32_t end,
                    cayspin::detail::RowFields<Real> const& to) {
  static_cast<Terms const*>(terms)->along({row, begin, end, to});
}

}  // namespace cayspin::simulation
