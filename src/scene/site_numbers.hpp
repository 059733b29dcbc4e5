// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_1::io::detail {

/// What a key of numbers of sites takes in place of one number.
std::string accepted_site_numbers(Lattice const& lattice);
/// Reads numbers of sites, and returns 1; or a number, and returns that.
double number_of_sites(Item const& item, Scene& scene, SiteNumbers& numbers);
/// False where it is neither an expression nor a table.
bool read_site_numbers(Item const& item, Scene& scene, SiteNumbers& numbers);

/// Opens the files. Throws SceneError.
void check_site_numbers(Scene const& scene);

}  // namespace cayspin::inline v0_1::io::detail
