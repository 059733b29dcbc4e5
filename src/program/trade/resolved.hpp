// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "advice.hpp"

#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// The keys of a scene with the advised method. Frames and samples keep their times: the steps
/// between two of them are a whole number, so dt may be shorter than advised.
struct Resolved {
  // In the units of the scene. For adaptive methods, the interval between observations of the
  // spins.
  double dt;
  std::int64_t steps;
  std::vector<std::string> overrides;  // KEY=VALUE, among them the whole [integrator]
};

Resolved resolve(io::Scene const& scene, Advice const& advice);

/// For a scene with method "auto", returns the scene with the method advised for its error, in one
/// precision; if `in_parts`, only a method that runs on several ranks. Returns any other scene
/// unchanged. Call inside a KokkosSession. Throws NumbersFailed if no method meets the error.
io::Scene with_method(io::Scene const& scene, std::string const& space, Precision precision,
                      bool in_parts, TrialProgress* progress = nullptr);

/// For a scene with method "auto", returns the scene with the method that an earlier run chose.
/// `typed_before`, `resolved_before`: the scene of the earlier run as typed, and with the chosen
/// method. Returns nothing if there was no such choice, or if it does not fit this scene's error,
/// dt and steps; if `in_parts`, also if it does not run on several ranks.
std::optional<io::Scene> with_method_of(io::Scene const& scene, std::string const& typed_before,
                                        std::string const& resolved_before, bool in_parts);

}  // namespace cayspin::program::trade
