// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step of small lattices: many replicas in one field, or a single lattice.
// In the cases replicas/PRECISION METHOD/REPLICAS of SIZE, cayspin::integrate takes the steps, and
// can take many in one launch. If "one by one" is added, each step is a call of step(). On a
// device, "in pairs" takes all stages of a step of a film in one launch (PairedStages).
#include "main.hpp"
#include "scene.hpp"

#include <cayspin/stepper/paired_stages.hpp>

#include <cstdint>
#include <string>

namespace {

constexpr std::int64_t steps = 100;

template <class Stepper>
void run(benchmark::State& state, cayspin::Lattice const& lattice, bool one_by_one) {
  auto spins = scene::random<typename Stepper::spins_type>(lattice);
  auto const generator = scene::Default::generator(lattice);
  Stepper stepper(spins);
  Kokkos::DefaultExecutionSpace const exec;
  auto const advance = [&] {
    if (one_by_one)
      for (std::int64_t i = 0; i < steps; ++i) stepper.step(exec, generator, spins, 0, scene::dt);
    else
      cayspin::integrate(exec, stepper, generator, spins,
                         {.begin = 0, .dt = scene::dt, .steps = steps});
    exec.fence();
  };
  advance();
  for (auto _ : state) advance();
  scene::report(state, steps * lattice.sites(), 0, scene::work_bytes(stepper));
}

template <class Stepper>
void add(std::string const& name) {
  using cayspin::Lattice;
  for (auto const& [lattice, size] :
       {scene::Size{Lattice::cubic(10, 10, 10).with_replicas(1000), "1000 of 10^3"},
        scene::Size{Lattice::square(16, 16).with_replicas(1000), "1000 of 16^2"},
        scene::Size{Lattice::chain(100).with_replicas(1000), "1000 of 100"},
        scene::Size{Lattice::chain(1).with_replicas(100000), "100000 of 1"},
        scene::Size{Lattice::cubic(10, 10, 10), "1 of 10^3"},
        scene::Size{Lattice::square(64, 64), "1 of 64^2"},
        scene::Size{Lattice::cubic(16, 16, 16), "1 of 16^3"}})
    for (bool const one_by_one : {false, true})
      scene::add(name + "/" + size + (one_by_one ? ", one by one" : ""),
                 [=, lattice = lattice](benchmark::State& state) {
                   run<Stepper>(state, lattice, one_by_one);
                 });
}

template <class Real>
void add_methods(std::string const& precision) {
  using Spins = cayspin::SpinField<Real>;
  add<cayspin::LieHeun<Spins>>("replicas/" + precision + " Heun");
  add<cayspin::Rkmk4<Spins>>("replicas/" + precision + " RKMK4");
  add<cayspin::PairedStages<cayspin::LieHeun<Spins>>>("replicas/" + precision + " Heun in pairs");
  add<cayspin::PairedStages<cayspin::Rkmk4<Spins>>>("replicas/" + precision + " RKMK4 in pairs");
}

}  // namespace

void register_benchmarks() {
  add_methods<double>("f64");
  add_methods<float>("f32");
}
