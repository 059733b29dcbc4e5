// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/rows.hpp>
#include <cayspin/detail/sites_of_row.hpp>

#include <cstddef>
#include <cstdint>

// Terms with many neighbours are faster to sum for all sites of a row than spin by spin. The host
// loop of a stage lets them do so for each piece of a row before it works on that piece. The object
// that such a term's prepare_for_rows returns, or a sum of such objects, has
//   static constexpr int row_fields                       how many fields it keeps
//   void begin_row(row, begin, end, RowFields<Real>)      computes H of sites begin .. end - 1
// where `row` has the spins of the stage and their neighbours. If a term has
//   bool rows_need_only_time(exec, spins)
// and it is true, the term reads no other spins, and a sweep need not store them in a field. A
// generator may evaluate the packs at the ends of rows itself, so that a stage's arithmetic is
// compiled once, for the packs between them:
//   void find_row_ends(row, begin, end, fields, turning_alone) const    after begin_row
namespace cayspin::inline v0_2::detail {

/// A row of spins and its neighbour rows along y and z.
template <class Real>
struct RowOfSpins {
  Row const& row;
  RowStencil<Real> const& spins;
};

/// Sites per piece: few enough for the first-level cache.
inline constexpr std::int32_t sites_per_piece = 256;

/// Fields of a piece: component c of site i is data[c * stride + i] in the first field.
template <class Real>
struct RowFields {
  static constexpr std::ptrdiff_t stride =
      sites_per_piece + 8;  // avoids a stride of equal cache sets
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

  /// Returns the fields after the first `fields`.
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
