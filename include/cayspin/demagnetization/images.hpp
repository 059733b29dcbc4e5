// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <limits>

namespace cayspin::inline v0_1 {

/// A number of periodic images: all of them, along one or two axes.
inline constexpr int infinitely_many_images = std::numeric_limits<int>::max();

/// The largest ratio of two periods that such images are summed for.
inline constexpr double largest_period_ratio = 1e4;

}  // namespace cayspin::inline v0_1
