// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <optional>
#include <vector>

namespace cayspin::inline v0_2::io::detail {

/// Returns true if the scene has free_boundary = true. Refuses it for atomistic spins, without DMI,
/// and with site-dependent normals.
bool has_free_boundary(Table const& root);

/// Adds the anisotropies that represent DMI with a free boundary. There, m obeys
///   dm/dn = D / (2A) m x d,
/// with the continuum's A and the DMI vector D d of the bond: Rohart and Thiaville, Phys. Rev. B
/// 88, 184422 (2013), eq. 8. An imagined spin outside the side, chosen so that m obeys this
/// condition, acts like a uniaxial anisotropy with d as its hard axis. For each free side, its
/// constant in the continuum is Ku = -D^2 / (4A). (In a scene, the constants of exchange and
/// anisotropy are 2A and 2Ku.) Refuses a scene without exchange, and a uniform exchange that is not
/// above 0.
void add_free_boundaries(Scene& scene);

/// Returns the constants of such an anisotropy at the sites of a box; nothing if `numbers` belong
/// to no such anisotropy.
std::optional<std::vector<double>> numbers_at_free_sides(Scene const& scene,
                                                         SiteNumbers const& numbers,
                                                         SiteBox const& box);

}  // namespace cayspin::inline v0_2::io::detail
