// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "site_numbers.hpp"

namespace cayspin::inline v0_2::io {

/// Returns true for site-dependent anisotropy constants that represent free_boundary. These are
/// computed from the scene's exchange and DMI.
bool is_of_free_sides(SiteNumbers const& numbers);

}  // namespace cayspin::inline v0_2::io
