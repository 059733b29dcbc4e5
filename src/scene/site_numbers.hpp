// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_1::io::detail {

/// The values of an expression at the sites of a box. Throws SceneError.
std::vector<double> values_at_sites(Scene const& scene, std::string const& text,
                                    std::string_view key, SiteBox const& box);

/// Reads an expression or a file, and returns 1; or a number, and returns that.
double number_of_sites(Item const& item, Scene& scene, SiteNumbers& numbers);
/// False where it is neither an expression nor a file.
bool read_site_numbers(Item const& item, Scene& scene, SiteNumbers& numbers);

/// Opens the files. Throws SceneError.
void check_site_numbers(Scene const& scene);

}  // namespace cayspin::inline v0_1::io::detail
