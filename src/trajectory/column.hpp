// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/dataset.hpp"

#include <cstdint>
#include <type_traits>
#include <vector>

namespace cayspin::inline v0_2::io {

/// How a dataset stores one integer, one double or three doubles per row, each of 64 bits.
template <class Value>
struct Column {
  static constexpr bool is_integer = std::is_same_v<Value, std::int64_t>;
  static constexpr bool is_triple = sizeof(Value) == 3 * sizeof(double);

  static hid_t type() { return is_integer ? H5T_STD_I64LE : H5T_IEEE_F64LE; }
  static hid_t memory_type() { return is_integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE; }
  static Extents extents(hsize_t rows) { return is_triple ? Extents{rows, 3} : Extents{rows}; }
  static Extents begin(hsize_t row) { return is_triple ? Extents{row, 0} : Extents{row}; }
};

/// The type that `Member` returns for a Row, without a reference.
template <class Row, class Member>
using MemberValue = std::decay_t<std::invoke_result_t<Member, Row&>>;

template <class Row, class Member>
auto values_of(std::vector<Row> const& rows, Member const& member) {
  std::vector<MemberValue<Row, Member>> values;
  values.reserve(rows.size());
  for (auto const& row : rows) values.push_back(member(row));
  return values;
}

}  // namespace cayspin::inline v0_2::io
