// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "trial.hpp"

#include "exact.hpp"
#include "setting_scene.hpp"
#include "simulation/guard.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/run_noise.hpp"
#include "simulation/simulate.hpp"

#include <cayspin/observer/normalize.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace cayspin::extremes {
namespace {

using cayspin::detail::Maximum;  // of NaN and a number: NaN
using HostSpace = Kokkos::DefaultHostExecutionSpace;

template <class Real>
constexpr auto plan_precision =
    sizeof(Real) == 8 ? Precision::double_precision : Precision::single_precision;

/// Observer that guards a run, and makes the setting's changes to it: Newton steps, or a NaN.
template <class Spins>
class Look : public RunObserver<HostSpace, Spins> {
  using Real = typename Spins::value_type;

 public:
  Look(io::Scene const& scene, Setting const& setting, SceneGenerator<Spins> const& generator,
       Spins const& spins)
      : setting_(setting),
        generator_(generator),
        guard_(scene, std::numeric_limits<Real>::epsilon()) {
    if (is_thermal(scene)) noise_.emplace(scene, generator, spins);
  }

  // Runs of 1000 steps or more are looked at only every 1000 steps, or every `normalized` steps,
  // and after the last step.
  bool due(Step const& step) const override {
    std::int64_t const every = setting_.normalized ? setting_.normalized : 1000;
    return setting_.steps < 1000 || step.last || step.number % every == 0;
  }

  Next operator()(HostSpace const& exec, Step const& step, Spins const& spins) override {
    if (!noise_) return look(exec, step, spins);
    return (*noise_)(exec, step, 0, spins, true, [&] { return look(exec, step, spins); });
  }

  std::int64_t step() const { return step_; }
  std::optional<std::string> const& failure() const { return failure_; }

 private:
  Next look(HostSpace const& exec, Step const& step, Spins const& spins) {
    auto const now = sample(exec, generator_, step, spins);
    if (guard_.due(step) || step.last) failure_ = guard_.judge(step, now.energy, now.norm_defect);
    step_ = step.number;
    if (failure_) return Next::stop;
    if (setting_.normalized && step.number % setting_.normalized == 0) normalize(exec, spins);
    if (step.number == setting_.fault_at) spins.set(spins.sites() / 2, nan());
    return Next::proceed;
  }

  static Vec3<Real> nan() {
    Real const none = std::numeric_limits<Real>::quiet_NaN();
    return {none, Real(0), Real(1)};
  }

  Setting const& setting_;
  SceneGenerator<Spins> const& generator_;
  Guard guard_;
  std::optional<RunNoise<Spins>> noise_;
  std::int64_t step_ = 0;
  std::optional<std::string> failure_;
};

/// Largest distances of the spins from the sphere and from the exact solution.
template <class Spins>
std::pair<double, double> distances(Spins const& spins, Vec3<double> const& exact) {
  double off = 0, error = 0;
  for (std::int64_t site = 0; site < spins.sites(); ++site) {
    auto const m = spins.get(site);
    double const length = std::hypot(double(m.x), double(m.y), double(m.z));
    off = Maximum::combine(off, std::fabs(length - 1));
    error = Maximum::combine(
        error, std::hypot(m.x / length - exact.x, m.y / length - exact.y, m.z / length - exact.z));
  }
  return {off, error};
}

/// A run of a scene in one precision.
template <class Real>
struct Run {
  using Spins = typename Simulation<Real, HostSpace>::Spins;
  Setting const& setting;
  Spins spins;
  std::int64_t stopped_at = -1, own_steps = 0;
  std::string why = {};

  void go(io::Scene const& scene, Plan const& plan) {
    auto numbers = io::initial_spins(scene);
    for (int c = 0; c < 3; ++c) numbers[c] *= setting.start_length;
    Simulation<Real, HostSpace> simulation(scene, plan.lattice, plan.times, numbers);
    Look<Spins> look(scene, setting, simulation.generator, simulation.spins);
    auto const method = open_method(scene, plan, &simulation);
    auto const ending = simulation.advance(*method, look);
    own_steps = ending.summary.own_steps;
    if (ending.failure) {
      stopped_at = look.step() + 1;
      why = *ending.failure;
    } else if (look.failure()) {
      stopped_at = look.step();
      why = *look.failure();
    }
    spins = simulation.spins;
  }
};

/// Returns the largest difference of any component from that of the spin of a one-site lattice.
double largest_difference(auto const& spins, auto const& one) {
  auto const numbers = copy_to_host(spins), expected = copy_to_host(one);
  double largest = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    largest = Maximum::combine(largest, std::fabs(double(numbers[i]) - double(expected[i % 3])));
  return largest;
}

template <class Real>
Outcome try_out(Integrator const& integrator, Situation const& situation, Setting const& setting,
                io::Scene const& scene, Plan const& plan) {
  Run<Real> run{setting, {}};
  run.go(scene, plan);
  bool const warned = dt_warning(plan, scene.units).has_value();
  bool const damaged = setting.start_length != 1 || setting.fault_at >= 0;
  if (run.stopped_at >= 0)
    return {warned && !damaged ? Fate::warned : Fate::detected,
            run.stopped_at,
            setting.steps,
            0,
            0,
            run.why};

  constexpr double eps = std::numeric_limits<Real>::epsilon();
  bool const body = integrator.of_rigid_bodies;
  auto const time = static_cast<long double>(setting.dt) * setting.steps;
  auto const [off, error] = distances(run.spins, exact_end(setting, body, time));
  std::int64_t const counted = setting.normalized
                                   ? setting.normalized
                                   : std::max(setting.steps * setting.substeps, run.own_steps);
  auto const steps = static_cast<double>(counted);
  // Round-off of the steps, and of the angle, which may be large.
  double const angle = std::fabs(static_cast<double>(exact_angle(setting, body, time)));
  double const tolerance = std::fmin(eps * (8 * (steps + 1) + 4 * angle), 1e-4);
  bool exact = situation.against == Against::solution && error <= tolerance;
  auto const spins_of_another = [&](Setting const& another) {
    auto const other_scene = scene_of(integrator, another);
    Run<Real> other{another, {}};
    other.go(other_scene, make_plan(other_scene, plan_precision<Real>));
    return other.spins;
  };
  if (situation.against == Against::one_spin) {
    auto alone = setting;
    alone.shape = {1, 1, 1};
    exact = largest_difference(run.spins, spins_of_another(alone)) <= 8 * eps;
  }
  if (situation.against == Against::no_noise) {
    auto cold = setting;
    cold.temperature.reset();
    exact = copy_to_host(run.spins) == copy_to_host(spins_of_another(cold));
  }
  bool const kept = !integrator.method->keeps_length || off <= 4 * eps * (steps + 1);
  Fate const fate = !kept                              ? Fate::drifts
                    : exact                            ? Fate::exact
                    : warned                           ? Fate::warned
                    : !integrator.method->keeps_length ? Fate::drifts
                                                       : Fate::bounded;
  return {fate, -1, counted, off / eps, error / eps};
}

}  // namespace

Outcome try_out(Integrator const& integrator, Situation const& situation, Precision precision) {
  if (integrator.relaxes) return try_to_relax(integrator, situation, precision);
  bool const in_double = precision == Precision::double_precision;
  auto setting = in_double ? situation.in_double : situation.in_single;
  try {
    auto const scene = scene_of(integrator, setting);
    auto const plan = make_plan(scene, precision);
    require_memory(scene, plan);
    return in_double ? try_out<double>(integrator, situation, setting, scene, plan)
                     : try_out<float>(integrator, situation, setting, scene, plan);
  } catch (io::SceneError const& error) {
    return {Fate::refused, -1, 0, 0, 0, error.what()};
  }
}

}  // namespace cayspin::extremes
