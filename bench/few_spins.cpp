// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Steps per second of a chain of 100 spins through cayspin::integrate, with an observer every 100
// steps. Cases are named few spins/METHOD/EXECUTION SPACE.
#include "context.hpp"
#include "scene.hpp"

#include <string>
#include <type_traits>
#include <vector>

namespace {

using Spins = cayspin::SpinField<double, Kokkos::HostSpace>;

template <class Stepper, class Exec>
void run(benchmark::State& state) {
  constexpr std::int64_t steps = 10000;
  auto const chain = cayspin::Lattice::chain(100);
  auto spins = scene::random<typename Stepper::spins_type>(chain);
  auto const generator = scene::Default::generator(chain);
  Stepper stepper(spins);
  Exec const exec;
  std::vector<cayspin::Sample> samples;
  cayspin::Every every(100, cayspin::Record(scene::Default::field(chain), samples));
  for (auto _ : state) {
    samples.clear();
    cayspin::integrate(exec, stepper, generator, spins,
                       {.begin = 0, .dt = scene::dt, .steps = steps}, every);
  }
  state.counters["steps/s"] = benchmark::Counter(static_cast<double>(state.iterations()) * steps,
                                                 benchmark::Counter::kIsRate);
}

template <class Stepper>
void add(std::string const& name) {
  using Default = Kokkos::DefaultHostExecutionSpace;
  scene::add("few spins/" + name + "/" + Default::name(), run<Stepper, Default>);
#if defined(KOKKOS_ENABLE_SERIAL)
  if constexpr (!std::is_same_v<Default, Kokkos::Serial>)
    scene::add("few spins/" + name + "/Serial", run<Stepper, Kokkos::Serial>);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  add<cayspin::LieEuler<Spins>>("Euler");
  add<cayspin::LieHeun<Spins>>("Heun");
  add<cayspin::Rkmk4<Spins>>("RKMK4");
  return run_benchmarks(argc, argv);
}
