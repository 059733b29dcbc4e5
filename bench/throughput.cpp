// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and evaluation of the generator, beside the hand-written loop, in one run.
// Repetitions of all cases are interleaved at random; the clock is read behind a fence.
//   bench_throughput                       the table
//   bench_throughput --benchmark_filter=.. any of Google Benchmark's options
#include "hand_written.hpp"
#include "median_table.hpp"
#include "random_spins.hpp"

#include <cayspin/cayspin.hpp>

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

namespace {

constexpr double exchange = 1, anisotropy = 0.5, applied = 0.3, damping = 0.1, dt = 0.02;

void report(benchmark::State& state, std::int64_t sites, int evaluations) {
  auto const done = static_cast<double>(state.iterations()) * static_cast<double>(sites);
  state.counters["ns/spin"] =
      benchmark::Counter(done * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["ns/evaluation"] = benchmark::Counter(
      done * evaluations * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Stepper, class Real>
void run_cayspin(benchmark::State& state) {
  using namespace cayspin;
  auto const lattice = Lattice::cubic(state.range(0), state.range(0), state.range(0));
  SpinField<Real> spins("spins", lattice);
  copy_from_host(random_spins(lattice.sites()), spins);
  LandauLifshitz const generator(
      EffectiveField(Exchange(lattice, exchange), UniaxialAnisotropy(anisotropy, {0, 0, 1}),
                     Zeeman{{0, 0, applied}}),
      damping);
  Stepper stepper(spins);
  Kokkos::DefaultExecutionSpace const exec;
  stepper.step(exec, generator, spins, 0, dt);
  exec.fence();
  for (auto _ : state) {
    stepper.step(exec, generator, spins, 0, dt);
    exec.fence();
  }
  report(state, lattice.sites(), Stepper::evaluations);
}

template <template <class> class Method, class Real, int Evaluations>
void run_hand_written(benchmark::State& state) {
  hand_written::Cube<Real> const cube{static_cast<int>(state.range(0)), static_cast<Real>(exchange),
                                      static_cast<Real>(anisotropy), static_cast<Real>(applied),
                                      static_cast<Real>(damping)};
  auto const sites = cube.sites();
  hand_written::Vectors<Real> spins(sites);
  auto const start = random_spins(static_cast<std::int64_t>(sites));
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < sites; ++i) {
    spins.x.data[i] = static_cast<Real>(start[3 * i]);
    spins.y.data[i] = static_cast<Real>(start[3 * i + 1]);
    spins.z.data[i] = static_cast<Real>(start[3 * i + 2]);
  }
  Method<Real> method(cube);
  method.step(spins, static_cast<Real>(dt));
  for (auto _ : state) method.step(spins, static_cast<Real>(dt));
  report(state, static_cast<std::int64_t>(sites), Evaluations);
}

template <class Spins, class Tableau>
using Chart = cayspin::StereographicRungeKutta<Spins, Tableau>;

template <class Real>
void register_cases(std::string const& precision) {
  using Spins = cayspin::SpinField<Real>;
  auto const add = [&](char const* name, void (*run)(benchmark::State&)) {
    benchmark::RegisterBenchmark((precision + "/" + name).c_str(), run)
        ->Arg(32)
        ->Arg(128)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("hand-written Heun", run_hand_written<hand_written::Heun, Real, 2>);
  add("hand-written RK4", run_hand_written<hand_written::RungeKutta4, Real, 4>);
  add("LieEuler", run_cayspin<cayspin::LieEuler<Spins>, Real>);
  add("LieHeun", run_cayspin<cayspin::LieHeun<Spins>, Real>);
  add("Rkmk4", run_cayspin<cayspin::Rkmk4<Spins>, Real>);
  add("ChartHeun", run_cayspin<Chart<Spins, cayspin::tableau::Heun>, Real>);
  add("ChartRk4", run_cayspin<Chart<Spins, cayspin::tableau::Classical4>, Real>);
  add("ProjectedHeun", run_cayspin<cayspin::ProjectedHeun<Spins>, Real>);
  add("ProjectedRk4", run_cayspin<cayspin::ProjectedRk4<Spins>, Real>);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  register_cases<double>("f64");
  register_cases<float>("f32");
  MedianTable table("ns/evaluation", {{"LieEuler", "hand-written Heun"},
                                      {"LieHeun", "hand-written Heun"},
                                      {"ProjectedHeun", "hand-written Heun"},
                                      {"ChartHeun", "hand-written Heun"},
                                      {"Rkmk4", "hand-written RK4"},
                                      {"ChartRk4", "hand-written RK4"},
                                      {"ProjectedRk4", "hand-written RK4"}});
  return table.run(argc, argv);
}
