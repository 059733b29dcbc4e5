// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "resolved.hpp"

#include "simulation/failure.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/variant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

namespace cayspin::program::trade {
namespace {

// Limits a period of output to the number of steps: nothing is due beyond the last step.
std::int64_t within(io::Integrator const& integrator, std::int64_t every) {
  return std::clamp<std::int64_t>(integrator.steps, 1, every);
}

// Returns the longest interval, in steps of the scene, that divides the run and the periods of all
// outputs that the advised method must keep.
std::int64_t steps_between_looks(io::Scene const& scene, bool adaptive) {
  auto const& integrator = scene.integrator;
  bool const looks_at_each = !integrator.method->has_equal_steps() || integrator.until_torque;
  if (adaptive && looks_at_each) return 1;
  return std::gcd(std::max<std::int64_t>(integrator.steps, 1),
                  std::gcd(within(integrator, scene.output.every),
                           within(integrator, scene.output.scalars_every)));
}

// Returns the flags of [integrator] that the choice of a method does not set, in the order of the
// keys. These include energy_control only if the method is not adaptive.
std::vector<std::pair<std::string_view, bool>> flags_for_any_method(
    io::Integrator const& integrator, bool adaptive) {
  std::vector<std::pair<std::string_view, bool>> flags;
  for (auto const& key : io::Integrator::keys()) {
    bool const belongs_to_method =
        key.name == "compensated" || (key.name == "energy_control" && adaptive);
    auto const* const flag = std::get_if<bool io::Integrator::*>(&key.member);
    if (flag && !belongs_to_method) flags.emplace_back(key.name, integrator.**flag);
  }
  return flags;
}

// Returns the complete table [integrator], since that of the scene may have keys that the method
// does not accept.
std::string integrator_table(io::Scene const& scene, Advice const& advice, double dt,
                             std::int64_t steps) {
  auto const& of_scene = scene.integrator;
  auto candidate = advice.candidate;
  candidate.sigma /= scene.units.time;
  auto keys = candidate.keys();
  if (candidate.method->adaptive) keys += fmt::format(",tolerance={:.3g}", advice.steps.tolerance);
  if (candidate.method->adaptive && std::isfinite(of_scene.max_dt))
    keys += fmt::format(",max_dt={}", of_scene.max_dt * scene.units.time);
  keys += fmt::format(",dt={},steps={}", dt, steps);
  bool const adaptive = candidate.method->adaptive;
  auto const defaults = flags_for_any_method({}, adaptive);
  for (auto const& flag : flags_for_any_method(of_scene, adaptive))
    if (std::ranges::find(defaults, flag) == defaults.end())
      keys += fmt::format(",{}={}", flag.first, flag.second);
  if (of_scene.until_torque)
    keys += fmt::format(",until_torque={}", *of_scene.until_torque * scene.units.field);
  return fmt::format("integrator={{{}}}", keys);
}

// Adds overrides of those periods of frames, samples and checkpoints that the scene sets in steps.
// `steps_of` converts them to steps of the new method.
template <class StepsOf>
void add_output_keys(io::Scene const& scene, std::vector<std::string>& overrides,
                     StepsOf const& steps_of) {
  for (auto const& [key, every] : {std::pair{"output.every", scene.output.every},
                                   {"output.scalars_every", scene.output.scalars_every}})
    if (scene.places.contains(key)) overrides.push_back(fmt::format("{}={}", key, steps_of(every)));
  if (auto const every = scene.output.checkpoint_every.steps; every > 0)
    overrides.push_back(fmt::format("output.checkpoint_every=\"{} steps\"", steps_of(every)));
}

}  // namespace

Resolved resolve(io::Scene const& scene, Advice const& advice) {
  auto const& integrator = scene.integrator;
  auto const together = steps_between_looks(scene, advice.candidate.method->adaptive);
  double const time = integrator.dt * static_cast<double>(together);  // in reduced units
  auto const looks = integrator.steps / together;
  std::int64_t parts = 1;
  if (!advice.candidate.method->adaptive) {
    // The total is a multiple of four steps, so that a run can end at a quarter, and be continued
    // by a restart.
    std::int64_t const unit = looks > 0 ? 4 / std::gcd<std::int64_t>(4, looks) : 1;
    auto const least = static_cast<std::int64_t>(std::ceil(time / advice.dt - 1e-9));
    parts = (least + unit - 1) / unit * unit;
  }
  Resolved resolved{time * scene.units.time / static_cast<double>(parts), looks * parts, {}};
  resolved.overrides.push_back(integrator_table(scene, advice, resolved.dt, resolved.steps));
  if (has_slow_field(scene) && advice.candidate.substeps == 0)
    resolved.overrides.emplace_back(without_multirate(scene));
  add_output_keys(scene, resolved.overrides, [&](std::int64_t every) {
    // Periods of checkpoints need not be multiples of `together`.
    auto const all = within(integrator, every);
    return std::max<std::int64_t>(1, all / together * parts + all % together * parts / together);
  });
  return resolved;
}

io::Scene with_method(io::Scene const& scene, std::string const& space, Precision precision,
                      bool in_parts, TrialProgress* progress) {
  auto const& integrator = scene.integrator;
  if (!integrator.method->automatic) return scene;
  Advised advised;
  if (integrator.steps == 0)
    advised.choice = {{{.method = io::find_method("rkmk4")}}, {}, integrator.dt};  // no steps
  else
    advised = advise(Pilot(scene, space, *integrator.error),
                     {*integrator.error, {}, precision, progress, in_parts});
  if (!advised.choice)
    throw NumbersFailed(
        fmt::format("{}: no method reaches an error of {:g} in {} precision; accepted: a larger "
                    "integrator.error",
                    scene.path.string(), *integrator.error, to_string(precision)));
  return io::with_overrides(scene, resolve(scene, *advised.choice).overrides);
}

std::optional<io::Scene> with_method_of(io::Scene const& scene, std::string const& typed_before,
                                        std::string const& resolved_before, bool in_parts) {
  if (!scene.integrator.method->automatic || resolved_before.empty()) return std::nullopt;
  auto const parsed = [&](std::string const& text) {
    return io::parse_scene(text, scene.path, {}, scene.given);
  };
  auto const typed = parsed(typed_before), resolved = parsed(resolved_before);
  if (in_parts && find_variant(resolved).ghosts == 0) return std::nullopt;
  // The periods of frames and samples are in steps of the scene. They are scaled to steps of the
  // chosen method.
  double const ratio = typed.integrator.dt / resolved.integrator.dt;
  auto const steps = [&](std::int64_t of_scene) {
    return std::llround(static_cast<double>(of_scene) * ratio);
  };
  auto const& before = typed.integrator;
  auto const& now = scene.integrator;
  bool const same_choice = before.error == now.error && before.dt == now.dt &&
                           before.max_dt == now.max_dt &&
                           before.until_torque.has_value() == now.until_torque.has_value();
  double const whole = static_cast<double>(scene.integrator.steps) * ratio;
  if (!same_choice || std::abs(whole - std::round(whole)) > 1e-6) return std::nullopt;
  std::vector overrides{io::as_override(resolved_before, "integrator"),
                        fmt::format("integrator.steps={}", steps(scene.integrator.steps))};
  bool const adaptive = resolved.integrator.method->adaptive;
  auto const kept = flags_for_any_method(resolved.integrator, adaptive);
  for (auto const& flag : flags_for_any_method(now, adaptive))
    if (std::ranges::find(kept, flag) == kept.end())
      overrides.push_back(fmt::format("integrator.{}={}", flag.first, flag.second));
  if (now.until_torque)
    overrides.push_back(
        fmt::format("integrator.until_torque={}", *now.until_torque * scene.units.field));
  if (has_slow_field(scene) && !has_slow_field(resolved))
    overrides.emplace_back(without_multirate(scene));
  add_output_keys(scene, overrides,
                  [&](std::int64_t every) { return std::max<std::int64_t>(1, steps(every)); });
  return io::with_overrides(scene, overrides);
}

}  // namespace cayspin::program::trade
