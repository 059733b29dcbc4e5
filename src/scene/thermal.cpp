// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

namespace cayspin::inline v0_1::io::detail {

std::optional<Thermal> read_thermal(Table const& root, SystemKind kind) {
  auto const table = table_of_spins(root, "thermal", kind);
  if (!table) return std::nullopt;
  table->accept_only(names_of_keys<Thermal>());
  Thermal thermal;
  read_keys(*table, thermal);
  return thermal;
}

void check_thermal(Scene const& scene) {
  if (!scene.thermal || scene.thermal->temperature == 0) return;
  auto const& [system, integrator] = std::tie(scene.system, scene.integrator);
  auto const& method = *integrator.method;
  if (system.dampings.there())
    refuse(scene, "thermal.temperature", "a temperature needs one damping for all sites",
           "a number as damping, or temperature = 0");
  if (!(system.damping > 0))
    refuse(scene, "thermal.temperature",
           "a temperature needs damping: it is what spins take heat by",
           "a damping > 0, or temperature = 0");
  if (!method.has_equal_steps() || !method.keeps_length)
    refuse(scene, "integrator.method",
           fmt::format("\"{}\" does not go with a temperature: it {}", method.word,
                       method.keeps_length ? "chooses its steps" : "does not keep |m| = 1"),
           "a method with steps of dt, such as \"heun\", \"rkmk4\", \"red_black2\"");
  if (integrator.compensated)
    refuse(scene, "integrator.compensated",
           "does not go with a temperature, whose noise is rounded, too", "no such key");
  if (integrator.until_torque)
    refuse(scene, "integrator.until_torque", "spins at a temperature do not come to rest",
           "no such key");
  double const half =
      largest_noise(scene) * system.damping * scene.thermal->temperature * integrator.dt;
  if (!(half <= 1))
    refuse(scene, "integrator.dt",
           fmt::format("damping times temperature times dt{} is {:.3g}: the noise of a step would "
                       "lose all memory of a direction",
                       scene.lattice.moments.empty() ? "" : " over the least moment", half),
           fmt::format("a dt up to {:.6g}, better a tenth of it",
                       integrator.dt / half * scene.units.time));
}

}  // namespace cayspin::inline v0_1::io::detail
