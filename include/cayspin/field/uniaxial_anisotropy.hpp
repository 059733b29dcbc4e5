// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/along_axis.hpp>

namespace cayspin {

/// Uniaxial anisotropy: H = K (m.e) e, E = -K (m.e)^2 / 2 per site. The axis e is normalised.
class UniaxialAnisotropy : public detail::AlongAxis {
 public:
  UniaxialAnisotropy(double constant, Vec3<double> const& axis)
      : AlongAxis(constant, axis, "cayspin::UniaxialAnisotropy: the axis") {}
};

}  // namespace cayspin
