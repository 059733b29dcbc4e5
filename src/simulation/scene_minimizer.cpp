// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_minimizer.hpp"

#include "failure.hpp"
#include "io/relax.hpp"
#include "run_files.hpp"
#include "space.hpp"
#include "thermal.hpp"

#include <fmt/format.h>

namespace cayspin::simulation {

void require_rest(io::Scene const& scene) {
  if (scene.system.kind != io::SystemKind::llg)
    throw io::scene_error(scene, "system.kind",
                          "rigid bodies have no equilibrium; accepted: \"llg\"");
  if (io::has_torque(scene.field))
    throw io::scene_error(scene, "torque",
                          "moves spins for ever, and an equilibrium needs an energy that falls; "
                          "accepted: no such table");
  if (is_thermal(scene))
    throw io::scene_error(scene, "thermal.temperature",
                          "an equilibrium has no temperature; accepted: temperature = 0");
}

Plan make_plan_to_relax(io::Scene const& scene, Precision precision) {
  io::require_no_ensemble(scene, "this command");
  require_rest(scene);
  auto without_steps = scene;
  without_steps.integrator.steps = 0;
  without_steps.integrator.substeps = 1;
  // A search evaluates all terms equally often.
  if (auto& slab = without_steps.field.slab_demag; slab && slab->multirate) {
    slab->multirate = false;
    slab->on_host = true;
  }
  if (auto& demag = without_steps.field.demag) demag->multirate = false;
  auto plan = make_plan(without_steps, precision);
  auto const states = static_cast<std::int64_t>(io::fields_in_turn(scene).size());
  plan.frames *= states;
  auto const once = static_cast<double>(position_bytes(scene.lattice));
  plan.file_bytes = once + static_cast<double>(states) * (plan.file_bytes - once);
  plan.memory.work = plan.memory.spins * Minimizer<SpinField<double>>::work_fields;
  return plan;
}

template <class Real, class Space>
Minimum SceneMinimizer<Real, Space>::minimize(Space const& exec, io::Scene const& scene,
                                              SceneField<Spins> const& field, Spins& spins,
                                              MinimizeOptions const& options) {
  try {
    return minimizer_.minimize(exec, field, spins, options);
  } catch (FieldNotFinite const&) {
    throw NumbersFailed(fmt::format("{}: the field of the start, or its energy, is not finite",
                                    scene.path.string()));
  }
}

#define CAYSPIN_INSTANTIATE(Space, Real) template class SceneMinimizer<Real, Space>;
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
