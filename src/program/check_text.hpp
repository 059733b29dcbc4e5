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

/// Prints one line, with its name in a column.
void print(std::string_view name, std::string_view text);

inline bool has_stable_dt(Plan const& plan) { return std::isfinite(plan.stable_dt); }
/// Returns the order of the method; with an expensive field, that of its combination with substeps.
int order(io::Scene const& scene, Variant const& variant);
std::optional<std::int64_t> evaluations(io::Scene const& scene, Variant const& variant);

/// Prints method, time, stable dt and cost; also features of fields in t, and noise, if there are
/// any.
void print_steps(io::Scene const& scene, Plan const& plan);

/// Returns a whole number, unless it is so large that the double is not exact.
Json bytes_json(double bytes);

struct CheckedStage {
  io::Stage stage;
  Plan plan;
};

/// Plans all stages of a scene. Throws io::SceneError.
std::vector<CheckedStage> plan_stages(io::Scene const& scene, Precision precision);
/// Prints what each stage changes, and its steps.
void print_stages(std::vector<CheckedStage> const& stages);
Json stages_json(std::vector<CheckedStage> const& stages);

}  // namespace cayspin::program
