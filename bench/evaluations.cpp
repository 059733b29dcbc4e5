// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin per evaluation, for high-order and adaptive methods, with RKMK4 for
// comparison. Cases are named evaluations/PRECISION/METHOD/SIZE.
#include "main.hpp"
#include "scene.hpp"

#include <string>
#include <vector>

namespace {

using namespace cayspin;

/// Internal steps of an adaptive method between two requested times.
constexpr int own_steps = 8;

void report(benchmark::State& state, std::int64_t sites, double evaluations) {
  state.counters["ns/evaluation"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(sites) * evaluations * 1e-9,
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Stepper>
void time_equal_steps(benchmark::State& state, Lattice const& lattice) {
  scene::time_steps<Stepper>(state, lattice);
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
  std::vector<scene::Size> const sizes{{Lattice::square(256, 256), "256^2"},
                                       {scene::cube(64).lattice, "64^3"}};
  auto const add = [&](std::string const& method, auto run) {
    scene::add("evaluations/" + precision + "/" + method, sizes, run);
  };
  add("rkmk4", time_equal_steps<Rkmk4<Spins>>);
  add("rkmk5", time_equal_steps<Rkmk<Spins, tableau::Tsitouras5>>);
  add("rkmk8", time_equal_steps<Rkmk<Spins, tableau::DormandPrince8>>);
  add("tsit5", time_adaptive_steps<AdaptiveRkmk<Spins, tableau::Tsitouras5>>);
  add("dp5", time_adaptive_steps<AdaptiveRkmk<Spins, tableau::DormandPrince5>>);
}

}  // namespace

void register_benchmarks() {
  register_methods<double>("f64");
  register_methods<float>("f32");
}
