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
///   dm/dn = D / (2A) * m x d,
/// where n is the outward normal, A the exchange of the continuum, and D * d the DMI vector of the
/// bond: Rohart and Thiaville, Phys. Rev. B 88, 184422 (2013), eq. 8. A fictitious spin beyond the
/// side, chosen so that m obeys this condition, acts like a uniaxial anisotropy with d as its hard
/// axis. Each free side adds -|D * d|^2 / (4A) to the constant Ku of this anisotropy in the
/// continuum. (In a scene, the constants of exchange and anisotropy are 2A and 2Ku.) Refuses a
/// scene without exchange, and a uniform exchange that is not above 0.
void add_free_boundaries(Scene& scene);

/// Returns the constants of an anisotropy that add_free_boundaries() has added, at the sites of a
/// box. Returns nothing if `numbers` belong to any other term.
std::optional<std::vector<double>> numbers_at_free_sides(Scene const& scene,
                                                         SiteNumbers const& numbers,
                                                         SiteBox const& box);

}  // namespace cayspin::inline v0_2::io::detail
