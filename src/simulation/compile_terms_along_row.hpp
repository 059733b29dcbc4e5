// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "moments_along_row.hpp"
#include "row_piece.hpp"
#include "terms_along_row.hpp"

#include <cstddef>
#include <cstdint>

// The loops of AddedTerms and WholeTerms, for the two files that each compile one precision.
namespace cayspin::simulation {

template <class Real, class Loop>
CAYSPIN_DETAIL_NOINLINE void run_along(Loop const& loop, RowPiece<Real> const& piece) {
  piece.for_each(loop);
}

template <class Real>
struct AddTerms {
  AddedTerms<Real> const& added;
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

template <class Real, class Term>
struct StoreTerm {
  Term const term;
  cayspin::detail::RowFields<Real> const fields;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Stencil const& stencil, std::ptrdiff_t i) const {
    fields.store(term.field(stencil), i);
  }
};

template <class Real>
void along(AddedTerms<Real> const& added, RowPiece<Real> const& piece) {
  auto const& terms = added.terms;
  auto const store = [&]<class Term>(Term const& term) {
    run_along(StoreTerm<Real, Term>{term, piece.fields}, piece);
  };
  auto const add = [&] { run_along(AddTerms<Real>{added, piece.fields}, piece); };
  bool const changes = terms.exchange_factor != 1 || terms.anisotropy_factor != 1;
  if (added.count() > 1 || added.scale != 1 || added.gyromagnetic != 1 || changes ||
      terms.per_gyromagnetic.data)
    return add();
  if (added.missing.exchange.data) return store(added.missing);
  if (terms.anisotropies > 0) return store(terms.anisotropies_of_sites[0]);
  if (terms.cubics_of_cell > 0) return store(terms.cubics[0]);
  if (terms.crystals > 0) return store(terms.crystals_of_sites[0]);
  if (terms.has_vacancies) return add();
  if (terms.exchange_of_sites.any()) return store(terms.exchange_of_sites);
  if (terms.dmis > 0) return store(terms.dmi_of_sites[0]);
  if (terms.interlayer_of_sites.any()) return store(terms.interlayer_of_sites);
  if (terms.has_zhang_li) return store(terms.zhang_li);
  if (terms.has_slonczewski) return store(terms.slonczewski);
  if (terms.has_slonczewski_of_sites) return store(terms.slonczewski_of_sites);
  if (terms.sources.count > 0) return store(terms.sources);
  add();
}

template <class Real>
struct StoreTerms {
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

template <class Real>
struct StoreFewTerms {
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

template <bool ExchangeOfSites, bool Vacancies, class Real>
void run_moments(PassTerms<Real> const& terms, RowPiece<Real> const& piece) {
  run_along(
      LoopOfMoments<Real, ExchangeOfSites, Vacancies>{
          .terms = terms, .mine = terms.site_of_plane(piece.row.row.z), .fields = piece.fields},
      piece);
}
template <class Real>
void run_moments(PassTerms<Real> const& terms, RowPiece<Real> const& piece) {
  if (terms.exchange_of_sites.any())
    terms.has_vacancies ? run_moments<true, true>(terms, piece)
                        : run_moments<true, false>(terms, piece);
  else
    terms.has_vacancies ? run_moments<false, true>(terms, piece)
                        : run_moments<false, false>(terms, piece);
}

template <class Real>
void along(WholeTerms<Real> const& whole, RowPiece<Real> const& piece) {
  auto const& terms = whole.terms;
  if (terms.has_pairs)
    terms.pairs.evaluate_row(piece.row.row, piece.begin, piece.end, piece.fields);
  if (whole.lacks_local) return;
  if (terms.has_pairs && terms.has_few())
    run_along(StoreFewTerms<Real>{terms.site_of_plane(piece.row.row.z), terms.applied_in_field,
                                  piece.fields},
              piece);
  else if (has_few_beside_moments(terms))
    run_moments(terms, piece);
  else
    run_along(StoreTerms<Real>{terms, piece.fields}, piece);
}

template <class Terms, class Real>
void evaluate_along(void const* terms, cayspin::detail::RowOfSpins<Real> const& row,
                    std::int32_t begin, std::int32_t end,
                    cayspin::detail::RowFields<Real> const& to) {
  along(*static_cast<Terms const*>(terms), RowPiece<Real>{row, begin, end, to});
}

#define CAYSPIN_COMPILE_TERMS_ALONG_ROW(Terms, Real)                                     \
  template void evaluate_along<Terms<Real>, Real>(                                       \
      void const*, cayspin::detail::RowOfSpins<Real> const&, std::int32_t, std::int32_t, \
      cayspin::detail::RowFields<Real> const&);

}  // namespace cayspin::simulation
