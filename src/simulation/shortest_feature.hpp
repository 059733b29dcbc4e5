// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "time_features.hpp"

#include <optional>

namespace cayspin::simulation {

class TimeSamples;

/// Returns the shortest pulse or half period of any component. Its length is its width at half
/// height. Ignores features lower than a thousandth of the component's range. Empty if all
/// components are monotonic.
std::optional<TimeFeatures::Shortest> shortest_feature(TimeSamples const& samples);

}  // namespace cayspin::simulation
