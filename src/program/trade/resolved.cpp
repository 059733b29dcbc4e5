// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "resolved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cayspin::program::trade {
namespace {

// Beyond the last step nothing is due.
std::int64_t within(io::Integrator const& integrator, std::int64_t every) {
  return std::clamp<std::int64_t>(integrator.steps, 1, every);
}

// How many of the scene's steps lie between looks that the advised method cannot leave out.
std::int64_t steps_between_looks(io::Scene const& scene, bool adaptive) {
  auto const& integrator = scene.integrator;
  bool const looks_at_each = io::is_adaptive(integrator.method) ||
                             integrator.method == io::Method::automatic || integrator.until_torque;
  if (adaptive && looks_at_each) return 1;
  return std::gcd(std::max<std::int64_t>(integrator.steps, 1),
                  std::gcd(within(integrator, scene.output.every),
                           within(integrator, scene.output.scalars_every)));
}

// All of the table, since the scene's may have keys that the method does not take.
std::string integrator_table(io::Integrator const& of_scene, Advice const& advice, double dt,
                             std::int64_t steps) {
  auto const& candidate = advice.candidate;
  std::string keys = fmt::format("method=\"{}\"", io::to_string(candidate.method));
  if (candidate.generator != io::Generator::standard)
    keys += fmt::format(",generator=\"{}\"", io::to_string(candidate.generator));
  if (candidate.rotation != io::Rotation::cayley)
    keys += fmt::format(",rotation=\"{}\"", io::to_string(candidate.rotation));
  if (candidate.sigma != 0) keys += fmt::format(",isotropy={{constant={:#}}}", candidate.sigma);
  if (candidate.compensated) keys += ",compensated=true";
  if (candidate.is_adaptive()) keys += fmt::format(",tolerance={:.3g}", advice.steps.tolerance);
  keys += fmt::format(",dt={:#},steps={}", dt, steps);
  if (!of_scene.energy_guard) keys += ",energy_guard=false";
  if (of_scene.energy_control && !candidate.is_adaptive()) keys += ",energy_control=true";
  if (of_scene.until_torque) keys += fmt::format(",until_torque={:#}", *of_scene.until_torque);
  return fmt::format("integrator={{{}}}", keys);
}

}  // namespace

Resolved resolve(io::Scene const& scene, Advice const& advice) {
  auto const& integrator = scene.integrator;
  auto const together = steps_between_looks(scene, advice.candidate.is_adaptive());
  double const time = integrator.dt * static_cast<double>(together);
  std::int64_t const parts = advice.candidate.is_adaptive()
                                 ? 1
                                 : static_cast<std::int64_t>(std::ceil(time / advice.dt - 1e-9));
  Resolved resolved{time / static_cast<double>(parts), integrator.steps / together * parts, {}};
  resolved.overrides.push_back(integrator_table(integrator, advice, resolved.dt, resolved.steps));
  auto const keep = [&](char const* key, std::int64_t every) {
    if (!scene.places.contains(std::string("output.") + key)) return;
    resolved.overrides.push_back(
        fmt::format("output.{}={}", key, within(integrator, every) / together * parts));
  };
  keep("every", scene.output.every);
  keep("scalars_every", scene.output.scalars_every);
  return resolved;
}

}  // namespace cayspin::program::trade
