// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <limits>

namespace cayspin::inline v0_2 {

/// Value of `periodic_images` that stands for infinitely many.
inline constexpr int infinitely_many_images = std::numeric_limits<int>::max();

/// Largest ratio of two periods along which DemagnetizingField and DipolarField sum infinitely many
/// images.
inline constexpr double largest_period_ratio = 1e4;

}  // namespace cayspin::inline v0_2
