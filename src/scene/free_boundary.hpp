// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <optional>
#include <vector>

namespace cayspin::inline v0_2::io::detail {

/// Returns true if the scene has free_boundary. Refuses it for atomistic spins, without DMI, and
/// with site-dependent normals.
bool has_free_boundary(Table const& root);

/// Adds the anisotropies that represent DMI with a free boundary. A spin beyond an open side that
/// obeys dm/dn = (D/2A) m x d, with the continuum's A and the vector d of the bond, acts as a hard
/// axis of -D^2/(4A) along d: Rohart and Thiaville, Phys. Rev. B 88, 184422 (2013), eq. 8. Here the
/// exchange constant is 2A. Refuses a scene without exchange.
void add_free_boundaries(Scene& scene);

/// Returns the constants of such an anisotropy at the sites of a box; nothing for other numbers.
std::optional<std::vector<double>> numbers_at_free_sides(Scene const& scene,
                                                         SiteNumbers const& numbers,
                                                         SiteBox const& box);

}  // namespace cayspin::inline v0_2::io::detail
