// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/rows.hpp>
#include <cayspin/detail/sites_of_row.hpp>

#include <cstddef>
#include <cstdint>

// H of a term with many neighbours is faster to compute for all sites of a row together than site
// by site. The host loop of a stage therefore lets such terms compute H on a piece of a row before
// it works on this piece. The object that such a term's prepare_for_rows returns, or a sum of such
// objects, has
//   static constexpr int row_fields                       how many fields it keeps
//   void begin_row(row, begin, end, RowFields<Real>)      computes H of sites begin .. end - 1
// where `row` has the spins of the stage and their neighbours. A term may have
//   bool rows_need_only_time(exec, spins)
// If this returns true, prepare_for_rows needs t but not the spins, so that a sweep need not store
// the spins of a stage in a field. A generator may evaluate the packs at the ends of rows itself,
// so that a stage's arithmetic is compiled only once, for the packs between them:
//   void find_row_ends(row, begin, end, fields, turning_alone) const    called after begin_row
namespace cayspin::inline v0_2::detail {

/// A row of spins and its neighbour rows along y and z.
template <class Real>
struct RowOfSpins {
  Row const& row;
  RowStencil<Real> const& spins;
};

/// Sites per piece: few enough for the first-level cache.
inline constexpr std::int32_t sites_per_piece = 256;

/// Fields of a piece: in the first field, component c of site begin + i is data[c * stride + i].
template <class Real>
struct RowFields {
  static constexpr std::ptrdiff_t stride =
      sites_per_piece + 8;  // a stride of 256 would put components into the same cache sets
  Real* data = nullptr;

  template <class Value>
  Vec3<Value> load(std::ptrdiff_t i) const {
    return {detail::load<Value>(data + i), detail::load<Value>(data + stride + i),
            detail::load<Value>(data + 2 * stride + i)};
  }
  template <class Value>
  void store(Vec3<Value> const& v, std::ptrdiff_t i) const {
    detail::store(v.x, data + i);
    detail::store(v.y, data + stride + i);
    detail::store(v.z, data + 2 * stride + i);
  }

  /// Returns the memory after the first `fields` fields.
  RowFields after(int fields) const { return {data + fields * 3 * stride}; }
};

template <class Real, int Fields>
class RowFieldMemory {
 public:
  RowFields<Real> all() { return {memory_}; }

 private:
  alignas(cache_line_bytes) Real memory_[std::size_t{3 * Fields * RowFields<Real>::stride}];
};

template <class Generator, class Real>
concept FindsRowEnds =
    requires(Generator const& generator, RowOfSpins<Real> const& row, RowFields<Real> fields) {
      generator.find_row_ends(row, std::int32_t{}, std::int32_t{}, fields, true);
    };

template <class Term>
inline constexpr int row_fields = 0;
template <class Term>
  requires requires { Term::row_fields; }
inline constexpr int row_fields<Term> = Term::row_fields;

}  // namespace cayspin::inline v0_2::detail
