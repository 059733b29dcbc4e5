// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <cayspin/crystal.hpp>

#include <cstdint>

namespace cayspin::inline v0_1::io::detail {

/// Sites in a cell.
constexpr std::int64_t most_sites = 32767;

/// The keys of [lattice] that say what is in a cell. Where the cell is that of a unit-cell file,
/// this is read.
void read_crystal(Table const& root, Table const& lattice_table, Lattice& lattice);

}  // namespace cayspin::inline v0_1::io::detail
