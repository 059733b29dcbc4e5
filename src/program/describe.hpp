// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {

/// Describes what a scene models. Returns lines, each a heading and a text.
std::vector<std::pair<std::string, std::string>> describe(io::Scene const& scene);

/// Returns "reduced", or the SI values of the reduced units of time, length, field and energy.
std::string describe_units(io::Units const& units);

/// Returns, for example, "rkmk4, orthogonal generator, cayley rotation, sigma = 0.7".
std::string describe_method(io::Scene const& scene);

/// Returns, for example, "uniform (0, 0, 1)".
std::string describe_start(io::Scene const& scene);

/// Prints the notes on a scene as warnings on standard error.
void warn_of_notes(io::Scene const& scene);

}  // namespace cayspin::program
