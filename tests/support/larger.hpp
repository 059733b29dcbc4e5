// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cmath>

namespace cayspin::test {

/// Returns the larger number, or NaN if either is NaN. std::max(a, NaN) is a, so that an error that
/// is NaN would pass.
inline double larger(double a, double b) { return std::isnan(a) || b <= a ? a : b; }

}  // namespace cayspin::test
