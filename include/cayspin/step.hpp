// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>

namespace cayspin::inline v0_1 {

/// Where an integration stands when an observer is called.
struct Step {
  std::int64_t number = 0;  // steps taken
  double time = 0, dt = 0;
  bool last = false;
  bool stops = false;  // an observer before this one ends the run here
};

/// What an observer may return to end an integration early. Observers that return nothing proceed.
enum class Next { proceed, stop };

}  // namespace cayspin::inline v0_1
