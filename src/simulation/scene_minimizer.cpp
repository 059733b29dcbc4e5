// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_minimizer.hpp"

#include "failure.hpp"
#include "io/relax.hpp"
#include "ranks.hpp"
#include "run_files.hpp"
#include "space.hpp"
#include "thermal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace cayspin::simulation {

namespace {

// Returns max |m x H|. `field` computes -dE/dm, which is divided by the moments.
template <class Exec, class Spins>
double largest_torque(Exec const& exec, SceneField<Spins> const& field, Spins const& spins,
                      double time, std::vector<double> const& moments) {
  using Real = typename Spins::value_type;
  SiteField<Real, 3, typename Spins::memory_space> const found("SceneMinimizer::field",
                                                               spins.lattice());
  evaluate_field(exec, field, spins, time, found);
  exec.fence("cayspin::SceneMinimizer: field evaluated");
  auto const of_spins = copy_to_host(spins), of_field = copy_to_host(found);
  double largest = 0;
  for (std::size_t site = 0; site < moments.size(); ++site) {
    if (!(moments[site] > 0)) continue;
    auto const at = [&](auto const& numbers) {
      return Vec3<double>{numbers[3 * site], numbers[3 * site + 1], numbers[3 * site + 2]};
    };
    auto const torque = cross(at(of_spins), at(of_field));
    largest = std::max(largest, std::sqrt(dot(torque, torque)) / moments[site]);
  }
  return largest;
}

}  // namespace

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
  without_steps.integrator = {};
  without_steps.integrator.method = io::methods().front();  // any: it takes no step
  without_steps.integrator.dt = 1;
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
  plan.memory.work = plan.memory.spins * (precision == Precision::double_precision
                                              ? Minimizer<SpinField<double>>::work_fields
                                              : Minimizer<SpinField<float>>::work_fields);
  return plan;
}

MomentRange range_of_moments(std::vector<double> moments) {
  std::erase_if(moments, [](double moment) { return !(moment > 0); });
  if (moments.empty()) return {};
  auto const [least, largest] = std::ranges::minmax(moments);
  return {least, largest};
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

template <class Real, class Space>
Minimum SceneMinimizer<Real, Space>::relax(Space const& exec, io::Scene const& scene,
                                           SceneField<Spins> const& field, Spins& spins,
                                           MinimizeOptions const& options) {
  auto const moments = io::all_moments(scene, own_sites(spins.lattice()));
  if (moments.empty() || !(std::ranges::max(moments) > 0))
    return minimize(exec, scene, field, spins, options);
  auto const [least, largest] = range_of_moments(moments);
  auto closer = options;
  auto const bound = [](double torque) {
    return std::max(torque, Minimizer<SpinField<double>>::least_bound);
  };
  closer.torque = bound(options.torque * largest);
  // The energy of a spin with a small moment has a small curvature.
  closer.least_curvature = bound(options.torque * least);
  Minimum all;
  all.iterations = all.evaluations = all.saddles = 0;
  constexpr int tries = 20;
  for (int i = 0; i < tries; ++i) {
    closer.evaluations = options.evaluations - all.evaluations;
    if (closer.evaluations < 1) {  // a search may end above its limit
      all.end = MinimizeEnd::evaluation_limit;
      return all;
    }
    auto found = minimize(exec, scene, field, spins, closer);
    double const of_gradient = found.torque;
    // After an interrupt a program's own field must not be called any more.
    if (found.end != MinimizeEnd::interrupted)
      found.torque = largest_torque(exec, field, spins, options.time, moments);
    found.iterations += all.iterations;
    found.evaluations += all.evaluations + 1;
    found.saddles += all.saddles;
    all = found;
    if (found.end != MinimizeEnd::converged || found.torque <= options.torque) return all;
    closer.torque = bound(0.5 * of_gradient * options.torque / found.torque);
  }
  all.end = MinimizeEnd::stagnated;
  return all;
}

#define CAYSPIN_INSTANTIATE(Space, Real) template class SceneMinimizer<Real, Space>;
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
