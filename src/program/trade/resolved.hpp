// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "advice.hpp"

#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// How a scene runs as advised. Frames and samples come when the scene wants them: a whole number
/// of steps falls between two of them, so dt may be shorter than what is advised.
struct Resolved {
  double dt;  // as the scene has it; of adaptive methods: from one look at the spins to the next
  std::int64_t steps;
  std::vector<std::string> overrides;  // of the scene, the whole [integrator] among them
};

Resolved resolve(io::Scene const& scene, Advice const& advice);

/// A scene of method "auto" with the method that is advised for its error, in one precision; any
/// other scene as it is. Inside a KokkosSession. Throws NumbersFailed when nothing gets there.
io::Scene with_method(io::Scene const& scene, std::string const& space, Precision precision,
                      TrialProgress* progress = nullptr);

/// A scene of method "auto" with the method that was chosen for it in a run before, of which the
/// scene as typed and as resolved are given. None where no such choice was made.
std::optional<io::Scene> with_method_of(io::Scene const& scene, std::string const& typed_before,
                                        std::string const& resolved_before);

}  // namespace cayspin::program::trade
