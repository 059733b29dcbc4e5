// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Steps per second of a chain of 100 spins through cayspin::integrate, with an observer every 100
// steps, next to two hand-written loops for this scene: one scalar, one vectorised by the compiler.
// Cases are named few spins/METHOD/EXECUTION SPACE, few spins/scalar METHOD and few
// spins/vectorized METHOD.
#include "hand_written.hpp"
#include "main.hpp"
#include "scene.hpp"

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace {

using Spins = cayspin::SpinField<double, Kokkos::HostSpace>;

constexpr std::int64_t sites = 100, steps = 10000;

cayspin::Lattice chain() { return cayspin::Lattice::chain(sites); }

void report(benchmark::State& state) {
  state.counters["steps/s"] = benchmark::Counter(static_cast<double>(state.iterations()) * steps,
                                                 benchmark::Counter::kIsRate);
}

template <class Stepper, class Exec>
void run(benchmark::State& state) {
  auto spins = scene::random<typename Stepper::spins_type>(chain());
  auto const generator = scene::Default::generator(chain());
  Stepper stepper(spins);
  Exec const exec;
  std::vector<cayspin::Sample> samples;
  cayspin::Every every(100, cayspin::Record(scene::Default::field(chain()), samples));
  for (auto _ : state) {
    samples.clear();
    cayspin::integrate(exec, stepper, generator, spins,
                       {.begin = 0, .dt = scene::dt, .steps = steps}, every);
  }
  report(state);
}

template <class Renormalized, class Loop, class Method>
void run_hand_written(benchmark::State& state, Method method) {
  constexpr int few = 11;
  Loop loop({sites, scene::exchange, scene::anisotropy, scene::applied, scene::damping});
  hand_written::Vectors<double> m(sites);
  hand_written::fill(m, random_spins(sites));
  (loop.*method)(m, scene::dt, few);
  if (!(scene::distance_to<Renormalized>(hand_written::numbers_of(m, sites), chain(), few,
                                         scene::dt) < 1e-13))
    return state.SkipWithError("the loop does not take the steps that it stands for");
  hand_written::fill(m, random_spins(sites));
  for (auto _ : state) (loop.*method)(m, scene::dt, steps);
  report(state);
}

template <class Renormalized, class Loop, class Method>
void add_hand_written(std::string const& name, Method method) {
  scene::add("few spins/" + name, [method](benchmark::State& state) {
    run_hand_written<Renormalized, Loop>(state, method);
  });
}

using hand_written::Chain, hand_written::Loops;
using Scalar = hand_written::Steps<Chain<Loops::scalar>>;
using Vectorized = hand_written::Steps<Chain<Loops::vectorized>>;
template <class Loop>
using MethodOf = void (Loop::*)(hand_written::Vectors<double>&, double, std::int64_t);

/// Registers benchmarks of the library's Stepper and of the hand-written loops. A loop is an error
/// unless it takes the same steps as the stepper Renormalized.
template <class Stepper, class Renormalized>
void add(std::string const& name, MethodOf<Scalar> scalar, MethodOf<Vectorized> vectorized) {
  using Default = Kokkos::DefaultHostExecutionSpace;
  scene::add("few spins/" + name + "/" + Default::name(), run<Stepper, Default>);
#if defined(KOKKOS_ENABLE_SERIAL)
  if constexpr (!std::is_same_v<Default, Kokkos::Serial>)
    scene::add("few spins/" + name + "/Serial", run<Stepper, Kokkos::Serial>);
#endif
  add_hand_written<Renormalized, Scalar>("scalar " + name, scalar);
  add_hand_written<Renormalized, Vectorized>("vectorized " + name, vectorized);
}

}  // namespace

void register_benchmarks() {
  add<cayspin::LieEuler<Spins>, cayspin::ProjectedEuler<Spins>>("Euler", &Scalar::euler,
                                                                &Vectorized::euler);
  add<cayspin::LieHeun<Spins>, cayspin::ProjectedHeun<Spins>>("Heun", &Scalar::heun,
                                                              &Vectorized::heun);
  add<cayspin::Rkmk4<Spins>, cayspin::ProjectedRk4<Spins>>("RKMK4", &Scalar::runge_kutta4,
                                                           &Vectorized::runge_kutta4);
}
