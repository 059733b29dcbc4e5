// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"
#include "io/site_numbers.hpp"

#include <array>
#include <optional>

namespace cayspin::inline v0_2::io {

/// The torque of Zhang and Li 2004: t = -(u.grad) m + xi * m x (u.grad) m.
struct ZhangLi {
  std::array<AppliedComponent, 3> velocity = {};  ///< u
  double nonadiabaticity = 0;                     ///< xi
  bool per_moment = false;                        ///< u is divided by the moment of each site

  static constexpr auto keys() {
    return std::to_array<Key<ZhangLi>>({{"velocity"},
                                        {"current_density"},
                                        {"polarization"},
                                        {"nonadiabaticity", &ZhangLi::nonadiabaticity}});
  }
};

/// The torque of Slonczewski 1996:
///   t = a * c * m x (p x m) - b * m x p, c = 2 * L^2 / ((L^2 + 1) + (L^2 - 1) * m.p).
struct Slonczewski {
  AppliedComponent damping_like = 0.0, field_like = 0.0;   ///< a, b
  Triple polarization = {};                                ///< unit vector p
  double lambda = 1;                                       ///< L
  SiteNumbers damping_like_of_sites, field_like_of_sites;  ///< if set, multiply a and b
  SiteVectors polarizations;  ///< if set, replace p; normalised when used
  bool damping_like_per_moment = false,
       field_like_per_moment = false;  ///< a or b is divided by the moment of each site

  /// Returns true if a, b and p are uniform, and c does not depend on the angle between m and p.
  bool is_plain() const {
    return lambda == 1 && !damping_like_of_sites.there() && !field_like_of_sites.there() &&
           !polarizations.there() && !damping_like_per_moment && !field_like_per_moment;
  }

  static constexpr auto keys() {
    return std::to_array<Key<Slonczewski>>({{"damping_like"},
                                            {"field_like"},
                                            {"polarization"},
                                            {"lambda", &Slonczewski::lambda, {"a number >= 1", 1}},
                                            {"current_density"},
                                            {"efficiency"},
                                            {"thickness"},
                                            {"epsilon_prime"}});
  }
};

/// The table [torque].
struct Torque {
  std::optional<ZhangLi> zhang_li;
  std::optional<Slonczewski> slonczewski;
};

}  // namespace cayspin::inline v0_2::io
