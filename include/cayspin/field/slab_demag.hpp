// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/along_axis.hpp>

namespace cayspin::inline v0_2 {

/// The demagnetising field of an infinite slab, for each spin from that spin only:
/// H = -strength * (m.n) * n, E = strength * (m.n)^2 / 2 per site. The normal n is normalised.
class SlabDemag : public detail::AlongAxis {
 public:
  /// Throws std::invalid_argument when the strength is not finite, or the normal is zero or not
  /// finite.
  explicit SlabDemag(Vec3<double> const& normal, double strength = 1)
      : AlongAxis(-detail::finite(strength, "cayspin::SlabDemag: the strength"), normal,
                  "cayspin::SlabDemag: the normal") {}
};

}  // namespace cayspin::inline v0_2
