// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "ranks.hpp"
#include "scene_generator.hpp"
#include "thermal.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/observer/thermal_noise.hpp>

#include <Kokkos_Timer.hpp>

#include <cstdint>
#include <utility>

namespace cayspin::simulation {

/// The thermal noise of a run: half before each step and half after it. Between two steps, the
/// halves of both are applied in one pass, unless the spins are observed in between. Both halves
/// use the temperature at the time between the steps.
template <class Spins>
class RunNoise {
 public:
  RunNoise(io::Scene const& scene, SceneGenerator<Spins> const& generator, Spins const& like)
      : noise_(noise(scene, generator, like)), temperature_(*scene.thermal, scene.units) {}

  /// Applies the noise after step `step`, calls look() if `wanted`, and applies the noise before
  /// the next step, unless look() returns stop or the step is the last. `first`: the step from
  /// which the run continues; the noise after step `first` is not applied.
  template <class Exec, class Look>
  Next operator()(Exec const& exec, Step const& step, std::int64_t first, Spins const& spins,
                  bool wanted, Look const& look) {
    bool const ends = step.number > first;
    noise_.set_temperature(temperature_(step.time));
    if (!wanted && !step.last) {
      turn(exec, step, ends, spins);
      return Next::proceed;
    }
    if (ends)
      timed([&] {
        noise_.turn(exec, step.number, Half::after, step.dt, spins);
        exec.fence("cayspin::RunNoise: before a look");
      });
    if (Next const next = wanted ? look() : Next::proceed; next == Next::stop) return next;
    if (!step.last) turn(exec, step, false, spins);
    return Next::proceed;
  }

  /// Call it after the spins were replaced: no half of the noise has been applied to the new spins.
  void reset() { begun_ = -1; }
  /// Calls visit(name, number) for the state that a run needs to continue after a failed step.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("noise.begun", begun_);
  }
  /// Takes over the state of the noise from another run. The spins must be those of that run, at
  /// the same step.
  void go_on_from(RunNoise const& other) { begun_ = other.begun_; }
  /// Returns the seconds spent on noise since the last call.
  double take_seconds() { return std::exchange(seconds_, 0.0); }

 private:
  using Factors = ScalarField<typename Spins::value_type, typename Spins::memory_space>;
  using Half = typename ThermalNoise<Spins>::Half;

  static ThermalNoise<Spins> noise(io::Scene const& scene, SceneGenerator<Spins> const& generator,
                                   Spins const& like) {
    ThermalNoiseOptions options{.seed = static_cast<std::uint64_t>(scene.thermal->seed)};
    double const damping = scene.system.dampings.there() ? 1 : scene.system.damping;
    if (scene.columns) {
      options.replicas = scene.columns->heats();
      options.columns_are_replicas = true;
      return {like, scene.columns->dampings.empty() ? damping : 1, options};
    }
    auto const& pass = generator.landau_lifshitz().field().pass();
    if (io::has_noise_of_sites(scene)) {
      auto const& lattice = like.lattice();
      Factors factors("RunNoise::factors", lattice);
      copy_from_host(io::noise_of_sites(scene, own_sites(lattice)), factors);
      cayspin::detail::update_ghosts(typename Spins::memory_space::execution_space(), lattice,
                                     factors);
      return {like, damping, options, factors};
    }
    if (!pass) return {like, damping, options};
    options.cell_sites = io::noise_of_cell_sites(scene);
    if (pass->moves()) return {like, damping, options, *pass->moves()};
    return {like, damping, options};
  }

  // Applies the noise before the next step and, if `ends` is true, also the noise after this step.
  template <class Exec>
  void turn(Exec const& exec, Step const& step, bool ends, Spins const& spins) {
    // A step that failed is repeated from spins that already have their noise.
    if (begun_ == step.number) return;
    // Does not wait for a device: work that remains there is timed with the step that follows.
    timed([&] {
      if (ends)
        noise_.turn_between_steps(exec, step.number, step.dt, spins);
      else
        noise_.turn(exec, step.number + 1, Half::before, step.dt, spins);
    });
    begun_ = step.number;
  }

  template <class Work>
  void timed(Work const& work) {
    Kokkos::Timer const clock;
    work();
    seconds_ += clock.seconds();
  }

  ThermalNoise<Spins> noise_;
  TemperatureInTime temperature_;
  std::int64_t begun_ = -1;  // step after which the noise before the next step was applied
  double seconds_ = 0;
};

}  // namespace cayspin::simulation
