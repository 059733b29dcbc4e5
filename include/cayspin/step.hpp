// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>

namespace cayspin::inline v0_2 {

/// Progress of an integration when an observer is called.
struct Step {
  std::int64_t number = 0;  // steps taken
  double time = 0, dt = 0;
  bool last = false;
  bool stops = false;  // an earlier observer ends the run here
};

/// Return value by which an observer says whether an integration goes on. An observer that returns
/// nothing never stops it.
enum class Next { proceed, stop };

}  // namespace cayspin::inline v0_2
