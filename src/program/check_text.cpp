// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "check_text.hpp"

#include "describe.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/text.hpp"
#include "simulation/thermal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cayspin::program {
namespace {

// Returns a time in the scene's units. In SI, the value in reduced units follows in parentheses.
std::string both(io::Units const& units, double time, int digits) {
  auto const text = time_text(units, time, digits);
  return units.si ? fmt::format("{} ({:.{}g})", text, time, digits) : text;
}

std::string evaluations_text(io::Scene const& scene, Variant const& variant) {
  if (has_slow_field(scene))
    return fmt::format("1 evaluation of the expensive field and {} of the others",
                       *evaluations(scene, variant));
  if (variant.method->adaptive) return "as many evaluations of the field as the tolerance takes";
  if (!variant.evaluations) return "as many evaluations of the field as the iteration takes";
  if (variant.evaluations == 1) return "1 evaluation of the field";
  return fmt::format("{} evaluations of the field", *variant.evaluations);
}

std::string stability_text(io::Units const& units, Plan const& plan) {
  if (!has_stable_dt(plan)) return "no limit known beforehand";
  if (plan.stable_dt == 0) return "none: at this damping errors grow at every dt";
  return fmt::format("{}; dt is {:.3g} of it{}", both(units, plan.stable_dt, 6),
                     std::min(plan.times.dt / plan.stable_dt, std::numeric_limits<double>::max()),
                     plan.times.dt > plan.stable_dt ? ", which is too large" : "");
}

std::string noise_text(io::Scene const& scene, Plan const& plan) {
  bool const is_plain = !io::has_noise_of_sites(scene) && io::largest_noise(scene) == 1;
  double const per_step = plan.noise_turn * plan.noise_turn / 4;
  return fmt::format(
      "{}damping x temperature x dt = {:.3g}, turns a spin by {:.3g} radians a step{}",
      is_plain ? "" : "gyromagnetic / moment x ", per_step, plan.noise_turn,
      plan.noise_turn > Plan::most_noise ? ", which is too large" : "");
}

// Describes the shortest feature and the number of jumps of the fields and torques that depend on
// t.
std::string features_text(io::Scene const& scene, TimeFeatures const& features) {
  std::string text;
  if (auto const& shortest = features.shortest)
    text = fmt::format("the shortest is {} long, of {} at t = {}; ",
                       time_text(scene.units, shortest->length, 3), shortest->key,
                       time_text(scene.units, shortest->time, 6));
  return text + counted(features.jumps, "jump");
}

}  // namespace

Json bytes_json(double bytes) {
  constexpr double largest_whole = 0x1p53;
  return bytes < largest_whole ? Json(std::llround(bytes)) : Json(bytes);
}

void print(std::string_view name, std::string_view text) { fmt::print("{:<11} {}\n", name, text); }

int order(io::Scene const& scene, Variant const& variant) {
  return has_slow_field(scene) ? order_with_multirate(scene, variant) : variant.order;
}

// With an expensive field, each step takes all its substeps twice.
std::optional<std::int64_t> evaluations(io::Scene const& scene, Variant const& variant) {
  if (!variant.evaluations || !has_slow_field(scene)) return variant.evaluations;
  return 2 * scene.integrator.substeps * *variant.evaluations;
}

void print_steps(io::Scene const& scene, Plan const& plan) {
  print("method", fmt::format("{}, order {}, {} per step", describe_method(scene),
                              order(scene, plan.variant), evaluations_text(scene, plan.variant)));
  print("time", fmt::format("{} of {}, to t = {}", counted(scene.integrator.steps, "step"),
                            both(scene.units, plan.times.dt, 9),
                            both(scene.units, plan.times.at(plan.times.steps), 9)));
  print("stable dt", stability_text(scene.units, plan));
  if (scene.system.kind == io::SystemKind::llg && io::depends_on_time(scene.field))
    print("features", features_text(scene, *plan.features));
  if (is_thermal(scene)) print("noise", noise_text(scene, plan));
  auto const updates =
      static_cast<double>(scene.integrator.steps) * static_cast<double>(plan.lattice.sites());
  auto cost = evaluations_text(scene, plan.variant);
  if (!plan.variant.method->adaptive)
    cost += fmt::format(" per step, {:.4g} spin updates in all", updates);
  print("cost", cost);
}

}  // namespace cayspin::program
