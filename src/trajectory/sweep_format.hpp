// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/dataset.hpp"
#include "hdf5/handle.hpp"
#include "io/trajectory.hpp"

namespace cayspin::inline v0_2::io {

inline constexpr char const* sweep_format = "sweep_format";
inline constexpr int sweep_format_version = 1;

/// Calls use(name, member) for each dataset with one or three numbers per run, in the order of the
/// file. member(run) returns the dataset's numbers for a SweptRun.
template <class Use>
void for_each_result(Use const& use) {
  use("status", [](auto& run) -> auto& { return run.status; });
  use("step", [](auto& run) -> auto& { return run.step; });
  use("time", [](auto& run) -> auto& { return run.time; });
  for_each_scalar([&](char const* name, auto scalar) {
    use(name, [scalar](auto& run) -> auto& { return run.scalars.*scalar; });
  });
  use("evaluations", [](auto& run) -> auto& { return run.cost.evaluations; });
  use("wall_seconds", [](auto& run) -> auto& { return run.cost.wall_seconds; });
  use("step_seconds", [](auto& run) -> auto& { return run.cost.step_seconds; });
}

}  // namespace cayspin::inline v0_2::io
