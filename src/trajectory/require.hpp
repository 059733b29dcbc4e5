// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "format.hpp"
#include "hdf5/error.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_2::io {

/// Throws std::invalid_argument unless the precision is "single" or "double".
inline void require_precision(std::string const& precision) {
  if (precision != single_precision && precision != double_precision)
    throw std::invalid_argument("precision is '" + precision + "'; accepted: single, double");
}

/// Throws std::invalid_argument unless all extents are at least 1, and 64 times the number of sites
/// is below 2^63.
inline void require_shape(std::array<std::int64_t, 3> const& shape) {
  std::int64_t room = std::numeric_limits<std::int64_t>::max() / 64;
  for (auto const extent : shape) {
    if (extent < 1) throw std::invalid_argument("an extent of the lattice is below 1");
    room /= extent;
  }
  if (room == 0) throw std::invalid_argument("the lattice has more sites than a file can hold");
}

/// Throws std::runtime_error unless these extents and this number of sites per cell, read from the
/// extents of /spins in a file, are those of a lattice that require_shape accepts.
inline void require_lattice_of_file(std::array<std::int64_t, 3> const& cells,
                                    std::int64_t cell_sites, std::filesystem::path const& path) {
  std::int64_t room = std::numeric_limits<std::int64_t>::max() / 64;
  for (auto const extent : {cells[0], cells[1], cells[2], cell_sites})
    room = extent < 1 ? 0 : room / extent;
  if (room == 0)
    throw_failure(path, "cannot read dataset spins", "its extents are not those of a lattice");
}

/// Returns the implementation of a writer. Throws std::logic_error if the writer was moved from.
template <class Implementation>
Implementation& not_moved(std::unique_ptr<Implementation> const& writer) {
  if (!writer)
    throw std::logic_error("the writer was moved from; use the object that it was moved to");
  return *writer;
}

}  // namespace cayspin::inline v0_2::io
