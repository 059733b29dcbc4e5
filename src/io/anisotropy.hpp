// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"
#include "io/site_numbers.hpp"

#include <array>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// H = (K (m.e) + K2 (m.e)^3) e.
struct Anisotropy {
  double constant = 0;        ///< K
  Triple axis = {};           ///< unit vector e
  int site = -1;              ///< index in the cell; below 0: all sites
  SiteNumbers factors = {};   ///< multiply the constant, which then is 1
  double constant2 = 0;       ///< K2
  SiteNumbers factors2 = {};  ///< multiply K2, which then is 1
  SiteVectors axes = {};      ///< instead of one axis; normalised when used

  /// Returns true if the term has one constant and one axis.
  bool is_plain() const {
    return !factors.there() && constant2 == 0 && !factors2.there() && !axes.there();
  }

  static constexpr std::string_view formula = "H = {} (m.e) e, e = {}";
  static constexpr auto keys() {
    return std::to_array<Key<Anisotropy>>(
        {{"constant", &Anisotropy::constant}, {"axis", &Anisotropy::axis}});
  }
};

/// Anisotropy of a crystal. Its energy depends on the components of m along two orthogonal axes and
/// their cross product, in this order. Cubic, with the components a, b, c:
///   E = constant (a^2 b^2 + b^2 c^2 + c^2 a^2) + constant2 a^2 b^2 c^2.
/// Hexagonal, with the components c, a, b: E = constant Re (a + i b)^6.
struct CrystalAnisotropy {
  bool hexagonal = false;
  double constant = 0;
  std::array<Triple, 2> axes = {};  ///< unit vectors
  int site = -1;                    ///< index in the cell; below 0: all sites
  SiteNumbers factors = {};         ///< multiply the constant, which then is 1
  double constant2 = 0;
  SiteNumbers factors2 = {};                      ///< multiply constant2, which then is 1
  std::array<SiteVectors, 2> axes_of_sites = {};  ///< each replaces its axis if set

  /// Returns true if it is cubic, of the lowest order, and equal on all sites that have it.
  bool is_plain() const {
    return !hexagonal && constant2 == 0 && !factors.there() && !factors2.there() &&
           !axes_of_sites[0].there() && !axes_of_sites[1].there();
  }
};

}  // namespace cayspin::inline v0_2::io
