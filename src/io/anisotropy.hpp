// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"
#include "io/site_numbers.hpp"

#include <array>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// Uniaxial anisotropy: H = (K * (m.e) + K2 * (m.e)^3) e.
struct Anisotropy {
  double constant = 0;        ///< K
  Triple axis = {};           ///< unit vector e
  int site = -1;              ///< index in the cell; below 0: all sites
  SiteNumbers factors = {};   ///< K of each site, if site-dependent; `constant` is then 1
  double constant2 = 0;       ///< K2
  SiteNumbers factors2 = {};  ///< K2 of each site, if site-dependent; `constant2` is then 1
  SiteVectors axes = {};      ///< e of each site, if site-dependent; normalised when used

  /// Returns true if K and e are the same on all sites that have the term, and there is no K2.
  bool is_plain() const {
    return !factors.there() && constant2 == 0 && !factors2.there() && !axes.there();
  }

  static constexpr std::string_view formula = "H = {} (m.e) e, e = {}";
  static constexpr auto keys() {
    return std::to_array<Key<Anisotropy>>(
        {{"constant", &Anisotropy::constant}, {"axis", &Anisotropy::axis}});
  }
};

/// Anisotropy of a crystal. Its energy depends on three components of m: those along two orthogonal
/// axes and that along their cross product. If cubic, these are called a, b and c:
///   E = constant * (a^2 b^2 + b^2 c^2 + c^2 a^2) + constant2 * a^2 b^2 c^2.
/// If hexagonal, they are called c, a and b: E = constant * Re[(a + i b)^6].
struct CrystalAnisotropy {
  bool hexagonal = false;
  double constant = 0;
  std::array<Triple, 2> axes = {};  ///< unit vectors
  int site = -1;                    ///< index in the cell; below 0: all sites
  SiteNumbers factors = {};         ///< values per site; `constant` is then 1
  double constant2 = 0;
  SiteNumbers factors2 = {};                      ///< values per site; `constant2` is then 1
  std::array<SiteVectors, 2> axes_of_sites = {};  ///< each, if set, replaces the axis of its index

  /// Returns true if the anisotropy is cubic, without constant2, and equal on all sites that have
  /// it.
  bool is_plain() const {
    return !hexagonal && constant2 == 0 && !factors.there() && !factors2.there() &&
           !axes_of_sites[0].there() && !axes_of_sites[1].there();
  }
};

}  // namespace cayspin::inline v0_2::io
