// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_1::mpi::detail {

/// Sites from `begin` to before `end`.
struct Box {
  std::array<std::int64_t, 3> begin, end;

  KOKKOS_FUNCTION std::int64_t extent(std::size_t axis) const { return end[axis] - begin[axis]; }
  std::int64_t rows() const { return extent(1) * extent(2); }
};

/// What goes to the neighbour before and to the one after, and where what comes from them goes.
struct Faces {
  std::array<Box, 2> sent, received;
};

}  // namespace cayspin::inline v0_1::mpi::detail
