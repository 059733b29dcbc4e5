// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and evaluation of methods of high order and of adaptive steps, beside
// RKMK4. Cases are named evaluations/PRECISION/METHOD/SIZE.
#include "context.hpp"
#include "scene.hpp"

#include <string>

namespace {

using namespace cayspin;

/// Own steps of an adaptive method between two times that are asked for.
constexpr int own_steps = 8;

void report(benchmark::State& state, std::int64_t sites, double evaluations) {
  state.counters["ns/evaluation"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(sites) * evaluations * 1e-9,
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Stepper>
void time_equal_steps(benchmark::State& state, Lattice const& lattice) {
  auto spins = scene::random<typename Stepper::spins_type>(lattice);
  auto const generator = scene::Default::generator(lattice);
  Stepper stepper(spins);
  Kokkos::DefaultExecutionSpace const exec;
  for (auto _ : state) {
    stepper.step(exec, generator, spins, 0, scene::dt);
    exec.fence();
  }
  report(state, lattice.sites(), Stepper::evaluations);
}

template <class Stepper>
void time_adaptive_steps(benchmark::State& state, Lattice const& lattice) {
  auto spins = scene::random<typename Stepper::spins_type>(lattice);
  auto const generator = scene::Default::generator(lattice);
  Stepper stepper(spins, {.tolerance = 1, .first_dt = scene::dt, .max_dt = scene::dt});
  Kokkos::DefaultExecutionSpace const exec;
  double t = 0;
  auto const advance = [&] {
    stepper.step(exec, generator, spins, t, own_steps * scene::dt);
    t += own_steps * scene::dt;
  };
  advance();
  auto const begin = stepper.evaluations_done();
  for (auto _ : state) advance();
  report(state, lattice.sites(),
         static_cast<double>(stepper.evaluations_done() - begin) /
             static_cast<double>(state.iterations()));
}

template <class Real>
void register_methods(std::string const& precision) {
  using Spins = SpinField<Real>;
  auto const add = [&](std::string const& method, auto run) {
    auto const on = [&](Lattice const& lattice, std::string const& size) {
      scene::add("evaluations/" + precision + "/" + method + "/" + size,
                 [=](benchmark::State& state) { run(state, lattice); });
    };
    on(Lattice::square(256, 256), "256^2");
    on(scene::cube(64), "64^3");
  };
  add("rkmk4", time_equal_steps<Rkmk4<Spins>>);
  add("rkmk5", time_equal_steps<Rkmk<Spins, tableau::Tsitouras5>>);
  add("rkmk8", time_equal_steps<Rkmk<Spins, tableau::DormandPrince8>>);
  add("tsit5", time_adaptive_steps<AdaptiveRkmk<Spins, tableau::Tsitouras5>>);
  add("dp5", time_adaptive_steps<AdaptiveRkmk<Spins, tableau::DormandPrince5>>);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  register_methods<double>("f64");
  register_methods<float>("f32");
  return run_benchmarks(argc, argv);
}
