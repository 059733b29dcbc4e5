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
  // In the units of the scene. For adaptive methods it is the interval between observations of the
  // spins.
  double dt;
  std::int64_t steps;
  std::vector<std::string> overrides;  // of the scene, including the whole [integrator]
};

Resolved resolve(io::Scene const& scene, Advice const& advice);

/// Returns a scene of method "auto" with the method advised for its error, in one precision; any
/// other scene unchanged. Call inside a KokkosSession. Throws NumbersFailed when no method meets
/// the error.
io::Scene with_method(io::Scene const& scene, std::string const& space, Precision precision,
                      TrialProgress* progress = nullptr);

/// Returns a scene of method "auto" with the method that an earlier run chose, given that run's
/// scene as typed and as resolved. Empty if there was no such choice, or if it does not fit this
/// scene's error, dt and steps.
std::optional<io::Scene> with_method_of(io::Scene const& scene, std::string const& typed_before,
                                        std::string const& resolved_before);

}  // namespace cayspin::program::trade
