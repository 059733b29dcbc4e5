// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "site_numbers.hpp"

namespace cayspin::inline v0_2::io {

/// Returns true for constants that the reader computes from the scene's exchange and DMI, for
/// free_boundary.
bool is_of_free_sides(SiteNumbers const& numbers);

}  // namespace cayspin::inline v0_2::io
