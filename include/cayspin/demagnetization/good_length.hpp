// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <initializer_list>

namespace cayspin::inline v0_2::detail {

/// Returns the smallest number from `least` on with no prime factors but 2, 3, 5 and 7: FFTs of
/// such lengths are fast.
inline int good_length(int least) {
  for (int length = least;; ++length) {
    int rest = length;
    for (int const factor : {2, 3, 5, 7})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return length;
  }
}

}  // namespace cayspin::inline v0_2::detail
