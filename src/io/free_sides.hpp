// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "site_numbers.hpp"

namespace cayspin::inline v0_2::io {

/// Returns true for the anisotropy constants that represent the key free_boundary. They are not
/// typed in the scene, but computed from its exchange and DMI.
bool is_of_free_sides(SiteNumbers const& numbers);

}  // namespace cayspin::inline v0_2::io
