// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "pass_terms.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::simulation {

inline Vec3<double> vector(io::Triple const& v) { return {v[0], v[1], v[2]}; }

/// A number per site of the cell; none are all 1.
inline double of_site(std::vector<double> const& numbers, std::size_t site) {
  return numbers.empty() ? 1 : numbers[site];
}

struct SitesOfCell {
  std::vector<CellSite> sites;
  std::vector<CubicAnisotropy> cubics;
};

/// What a scene says of each.
inline SitesOfCell sites_of_cell(io::Scene const& scene) {
  SitesOfCell all;
  auto const& field = scene.field;
  for (std::size_t number = 0; number < scene.lattice.basis.size(); ++number) {
    auto const is_here = [&](int site) { return site < 0 || site == static_cast<int>(number); };
    auto& site = all.sites.emplace_back();
    site.moment = of_site(scene.lattice.moments, number);
    site.per_moment = site.moment > 0 ? 1 / site.moment : 0;  // a moment of 0 is no spin
    site.gyromagnetic = of_site(scene.lattice.gyromagnetic, number);
    for (auto const& term : field.anisotropies)
      if (is_here(term.site) && !term.factors.there()) site.quadratic.add(term.constant, term.axis);
    site.first_cubic = static_cast<std::int32_t>(all.cubics.size());
    for (auto const& term : field.cubic_anisotropies)
      if (is_here(term.site))
        all.cubics.emplace_back(term.constant, vector(term.axes[0]), vector(term.axes[1]));
    site.last_cubic = static_cast<std::int32_t>(all.cubics.size());
  }
  return all;
}

}  // namespace cayspin::simulation
