// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>

namespace cayspin::inline v0_2::io {

/// Start of a stage of a run: its number, which is 0 for the scene's own tables, and the step and
/// time from which its steps are counted. The time is in the reduced units of the stage's scene,
/// even in files, so that a continued run computes bitwise the same times.
struct StageBegin {
  std::int64_t stage = 0, step = 0;
  double time = 0;

  bool operator==(StageBegin const&) const = default;
};

}  // namespace cayspin::inline v0_2::io
