// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "guard.hpp"

#include "io/site_box.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cayspin::simulation {

bool all_are_damped(io::Scene const& scene) {
  auto const& dampings = scene.system.dampings;
  if (!dampings.there()) return scene.system.damping > 0;
  bool all = true;
  io::for_each_box_of_planes(scene.lattice.shape, sizeof(double), [&](io::SiteBox const& box) {
    if (!all) return;
    auto const values = io::numbers_of_sites(scene, dampings, "system.damping", box);
    auto const moments = io::all_moments(scene, box);
    auto const frozen = io::frozen(scene, box);
    for (std::size_t site = 0; site < values.size(); ++site) {
      bool const moves =
          (moments.empty() || moments[site] > 0) && (frozen.empty() || !frozen[site]);
      if (moves && !(values[site] > 0)) all = false;
    }
  });
  return all;
}

std::optional<std::string> Guard::judge(Step const& step, Energy const& energy,
                                        double norm_defect) {
  auto const time = time_text(units_, step.time);
  if (!std::isfinite(norm_defect))
    return fmt::format("step {}, t = {}: a spin is not finite any more", step.number, time);
  if (!std::isfinite(energy.value))
    return fmt::format("step {}, t = {}: the energy is not finite any more", step.number, time);
  double const steps = step.number == 0 ? 1 : std::max(1e6, static_cast<double>(step.number));
  if (keeps_norm_ && !(norm_defect <= std::min(64 * epsilon_ * steps, 0.01)))
    return fmt::format("step {}, t = {}: a spin left the sphere: | |m| - 1 | = {:.3g}", step.number,
                       time, norm_defect);
  auto const before = last_;
  last_ = {step.number, energy.value};
  if (!first_) first_ = last_;
  if (!energy_must_fall_ || !before) return std::nullopt;
  double const rise = energy.value - before->energy;
  if (!(rise > most_rise_ * energy.magnitude)) return std::nullopt;
  return fmt::format(
      "step {}, t = {}: the energy rose by {}, from {} at step {} to {}, where "
      "damping lets it only fall",
      step.number, time, energy_text(units_, rise, 3), energy_text(units_, before->energy),
      before->step, energy_text(units_, energy.value));
}

}  // namespace cayspin::simulation
