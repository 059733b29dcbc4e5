// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/along_axis.hpp>

namespace cayspin::inline v0_2 {

/// Uniaxial anisotropy: H = K * (m.e) * e, E = -K * (m.e)^2 / 2 per site. The axis e is normalised.
class UniaxialAnisotropy : public detail::AlongAxis {
 public:
  /// Throws std::invalid_argument when the constant is not finite, or the axis is zero or not
  /// finite.
  UniaxialAnisotropy(double constant, Vec3<double> const& axis)
      : AlongAxis(detail::finite(constant, "cayspin::UniaxialAnisotropy: the constant"), axis,
                  "cayspin::UniaxialAnisotropy: the axis") {}
};

}  // namespace cayspin::inline v0_2
