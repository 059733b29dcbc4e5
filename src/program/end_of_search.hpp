// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/text.hpp"

#include <cayspin/minimizer/minimum.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace cayspin::program {

/// Returns "converged after 20 evaluations" or "stopped at the limit of 20 evaluations", for
/// example.
inline std::string end_text(MinimizeEnd end, std::int64_t evaluations) {
  auto const count = simulation::counted(evaluations, "evaluation");
  if (end == MinimizeEnd::evaluation_limit) return "stopped at the limit of " + count;
  return std::string(to_string(end)) + " after " + count;
}

/// Returns why a search ended without converging, such as "evaluation limit reached". `end`: the
/// text of the enumerator, from to_string().
inline std::string why_ended(std::string_view end) {
  return std::string(end) + (end == to_string(MinimizeEnd::evaluation_limit) ? " reached" : "");
}

}  // namespace cayspin::program
