// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "time_features.hpp"

#include <optional>

namespace cayspin::simulation {

class TimeSamples;

/// The shortest pulse or half period of any component, by its width at half height. What is lower
/// than a thousandth of the component's range is left out. None where all rise or fall only.
std::optional<TimeFeatures::Shortest> shortest_feature(TimeSamples const& samples);

}  // namespace cayspin::simulation
