// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/coupling.hpp>
#include <cayspin/crystal.hpp>

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

// Unit-cell files of Vampire, which other programs write, too. Both functions throw
// std::runtime_error with a message of one line, which names the file and the line reached.
namespace cayspin::inline v0_2::io::detail {

/// Largest number of sites in a cell.
constexpr std::int64_t most_sites = 32767;

constexpr std::string_view accepted_unit_cell_file = "the name of a unit-cell file of Vampire";

/// Returns the cell with its atoms, scaled so that the first vector has length 1.
Crystal read_unit_cell(std::filesystem::path const& path);

/// Returns the bonds, each once, with their values multiplied by `scale`. The file's atoms must be
/// the sites of `crystal`, and each bond must be listed from both ends. Without `scale_is_given`,
/// the numbers must be energies, not normalised.
std::vector<Coupling> read_unit_cell_couplings(std::filesystem::path const& path,
                                               Crystal const& crystal, double scale,
                                               bool scale_is_given);

}  // namespace cayspin::inline v0_2::io::detail
