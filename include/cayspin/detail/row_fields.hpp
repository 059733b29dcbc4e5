// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/rows.hpp>
#include <cayspin/detail/sites_of_row.hpp>

#include <cstddef>
#include <cstdint>

// Terms with many neighbours are summed faster for all sites of a row than spin by spin. The host
// loop of a stage lets them do so, piece by piece of a row, before it goes along that piece. What
// such a term's prepare_for_rows returns, and what is made of such terms, has
//   static constexpr int row_fields                       how many fields it keeps
//   void begin_row(row, begin, end, RowFields<Real>)      H of sites begin .. end - 1
// where `row` has the spins of the stage and their neighbours. Where the term says
//   bool rows_need_time_alone(exec, spins)
// it looks at no other spins, and a sweep need not have them in a field.
// A generator may find the packs at the ends of rows by itself, so that a stage's arithmetic is
// compiled once, for packs between them:
//   void find_row_ends(row, begin, end, fields, turning_alone) const    after begin_row
namespace cayspin::inline v0_1::detail {

/// A row, its spins, and those beside it along y and z.
template <class Real>
struct RowOfSpins {
  Row const& row;
  RowStencil<Real> const& spins;
};

/// Sites of a piece: few enough for the first cache.
inline constexpr std::int32_t sites_per_piece = 256;

/// Fields of a piece: component c of its site i is data[c * stride + i] in the first of them.
template <class Real>
struct RowFields {
  static constexpr std::ptrdiff_t stride = sites_per_piece + 8;  // not of the same cache sets
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

  /// Those after the first `fields`.
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

}  // namespace cayspin::inline v0_1::detail
