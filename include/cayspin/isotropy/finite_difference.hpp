// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/pack.hpp>

#include <limits>

namespace cayspin::isotropy {

/// sigma from a forward difference of A_o = A - (m.A) m: xi = A_o + sigma m with
/// sigma = -<w', w x m> / |w|^2, w = A_o, w' by a second evaluation at cay(dt w) m, t + dt.
/// For LieEuler, whose energy error it makes one order smaller. Lewis and Nigam 2002, Sec. 4.1,
/// with the sign and the norm mended. Zero where A_o is.
struct FiniteDifference {
  double cap = std::numeric_limits<double>::infinity();  ///< of |dt sigma|
};

/// The same with w' = (w_n - w_(n-1)) / dt: one evaluation a step, and a field that keeps w. The
/// first step takes the forward difference.
struct FiniteDifferenceBackward {
  double cap = std::numeric_limits<double>::infinity();  ///< of |dt sigma|
};

}  // namespace cayspin::isotropy
