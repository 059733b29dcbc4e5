// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/stages.hpp"
#include "print_json.hpp"
#include "simulation/plan.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Output of `cayspin check` about the steps and stages of a run.
namespace cayspin::program {

using namespace simulation;

/// Prints one line: the name, padded to the width of a column, and the text.
void print(std::string_view name, std::string_view text);

inline bool has_stable_dt(Plan const& plan) { return std::isfinite(plan.stable_dt); }
/// Returns the order of the method. With an expensive field, that is the order of the multirate
/// method.
int order(io::Scene const& scene, Variant const& variant);
std::optional<std::int64_t> evaluations(io::Scene const& scene, Variant const& variant);

/// Prints the method, the time, the stable dt and the cost. Also prints the features of fields that
/// depend on t, and the thermal noise, if the scene has them.
void print_steps(io::Scene const& scene, Plan const& plan);

/// Returns `bytes` as an integer, or as a double from 2^53 on, where doubles skip integers.
Json bytes_json(double bytes);

struct CheckedStage {
  io::Stage stage;
  Plan plan;
};

/// Plans all stages of a scene. Throws io::SceneError.
std::vector<CheckedStage> plan_stages(io::Scene const& scene, Precision precision);
/// Prints for each stage where it starts, how its scene differs from that of the stage before, and
/// its steps or its relaxation.
void print_stages(std::vector<CheckedStage> const& stages);
Json stages_json(std::vector<CheckedStage> const& stages);

}  // namespace cayspin::program
