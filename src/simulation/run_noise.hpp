// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "scene_generator.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/observer/thermal_noise.hpp>

#include <Kokkos_Timer.hpp>

#include <cstdint>
#include <utility>

namespace cayspin::simulation {

/// The thermal noise of a run, and when it takes place: half of it before and half after each step,
/// in one pass where nothing looks at the spins in between.
template <class Spins>
class RunNoise {
 public:
  RunNoise(io::Scene const& scene, SceneGenerator<Spins> const& generator, Spins const& like)
      : noise_(noise(scene, generator, like)) {}

  /// After step `step` of a run that goes on from step `first`. Calls look() where that is
  /// `wanted`; the next step is begun unless look() says to stop, or it is the last.
  template <class Exec, class Look>
  Next operator()(Exec const& exec, Step const& step, std::int64_t first, Spins const& spins,
                  bool wanted, Look const& look) {
    bool const ends = step.number > first;
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

  /// The spins are others now: none has turned at the begin of a step.
  void reset() { begun_ = -1; }
  /// Of the noise since the last call.
  double take_seconds() { return std::exchange(seconds_, 0.0); }

 private:
  using Half = typename ThermalNoise<Spins>::Half;

  static ThermalNoise<Spins> noise(io::Scene const& scene, SceneGenerator<Spins> const& generator,
                                   Spins const& like) {
    ThermalNoiseOptions options{scene.thermal->temperature,
                                static_cast<std::uint64_t>(scene.thermal->seed)};
    auto const& pass = generator.landau_lifshitz().field().pass();
    if (!pass) return {like, scene.system.damping, options};
    options.cell_sites = io::noise_of_sites(scene);
    if (pass->moves()) return {like, scene.system.damping, options, *pass->moves()};
    return {like, scene.system.damping, options};
  }

  // Into the next step, and out of the last one if that `ends`.
  template <class Exec>
  void turn(Exec const& exec, Step const& step, bool ends, Spins const& spins) {
    // A step that failed is taken again from spins that have turned.
    if (begun_ == step.number) return;
    // Not waited for: what a device has left to do then counts with the step that follows.
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
  std::int64_t begun_ = -1;  // the step after which spins turned last into the next one
  double seconds_ = 0;
};

}  // namespace cayspin::simulation
