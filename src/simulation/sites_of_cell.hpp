// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "pass_terms.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cayspin::simulation {

inline Vec3<double> vector(io::Triple const& v) { return {v[0], v[1], v[2]}; }

struct SitesOfCell {
  std::vector<CellSite> sites;
  std::vector<CubicAnisotropy> cubics;
};

/// Returns a scene's constants for each site of the cell.
inline SitesOfCell sites_of_cell(io::Scene const& scene) {
  SitesOfCell all;
  auto const& field = scene.field;
  for (std::size_t number = 0; number < scene.lattice.basis.size(); ++number) {
    auto const is_here = [&](int site) { return site < 0 || site == static_cast<int>(number); };
    auto& site = all.sites.emplace_back();
    site.moment = io::of_cell_site(scene.lattice.moments, number);
    site.per_moment = io::over_moment(scene.lattice, number, 1);
    site.gyromagnetic = io::of_cell_site(scene.lattice.gyromagnetic, number);
    for (auto const& term : field.anisotropies)
      if (is_here(term.site) && term.is_plain()) site.quadratic.add(term.constant, term.axis);
    site.first_cubic = static_cast<std::int32_t>(all.cubics.size());
    for (auto const& term : field.crystal_anisotropies)
      if (is_here(term.site) && term.is_plain())
        all.cubics.emplace_back(term.constant, vector(term.axes[0]), vector(term.axes[1]));
    site.last_cubic = static_cast<std::int32_t>(all.cubics.size());
  }
  return all;
}

/// Returns a slab's demagnetising field if it is local and each site has its own moment.
inline std::optional<io::SlabDemagnetization> slab_of_moments(io::Scene const& scene) {
  auto const& slab = scene.field.slab_demag;
  if (!slab || slab->on_host || !scene.lattice.moments_of_sites.there()) return std::nullopt;
  return slab;
}

}  // namespace cayspin::simulation
