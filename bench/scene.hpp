// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "random_spins.hpp"

#include <cayspin/cayspin.hpp>

#include <benchmark/benchmark.h>

#include <string>

// The scene of the benchmarks, and how a stepper is timed on it.
namespace scene {

// The damping is computed, and 0: with any other a small lattice comes to rest in the time that a
// repetition takes, and what is timed are denormal numbers.
inline constexpr double exchange = 1, anisotropy = 0.5, applied = 0.3, damping = 0, dt = 0.02;

/// Small enough for the second cache, and run by the calling thread.
inline cayspin::Lattice in_l2() { return cayspin::Lattice::cubic(128, 4, 4); }

inline cayspin::Lattice cube(std::int64_t n) { return cayspin::Lattice::cubic(n, n, n); }

struct Default {
  static auto field(cayspin::Lattice const& lattice) {
    return cayspin::EffectiveField(cayspin::Exchange(lattice, exchange),
                                   cayspin::UniaxialAnisotropy(anisotropy, {0, 0, 1}),
                                   cayspin::Zeeman{{0, 0, applied}});
  }
  static auto generator(cayspin::Lattice const& lattice) {
    return cayspin::LandauLifshitz(field(lattice), damping);
  }
};

template <class Of>
struct Orthogonal {
  static auto generator(cayspin::Lattice const& lattice) {
    return cayspin::orthogonal(Of::generator(lattice));
  }
};

/// Nanoseconds per spin and step, and what bounds them.
inline void report(benchmark::State& state, std::int64_t sites, double words, double work_bytes) {
  auto const spins = static_cast<double>(sites);
  state.counters["ns/spin"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * spins * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["spins"] = spins;
  state.counters["words"] = words;
  state.counters["work_bytes"] = work_bytes / spins;
}

template <class Spins>
Spins random(cayspin::Lattice const& lattice) {
  Spins spins("spins", lattice);
  copy_from_host(random_spins(lattice.sites()), spins);
  return spins;
}

template <class Stepper>
Stepper make_stepper(typename Stepper::spins_type const& like) {
  if constexpr (requires { typename Stepper::stepper_type; })
    return Stepper(like, typename Stepper::stepper_type(like));
  else
    return Stepper(like);
}

/// Numbers that a step moves per spin where no cache holds them: `of_passes` where each stage is a
/// pass over memory; a sweep reads and writes the spins.
template <class Stepper>
double words_moved(Stepper const& stepper, double of_passes) {
  if constexpr (requires { stepper.path(); })
    return stepper.path() == decltype(stepper.path())::sweep ? 6 : of_passes;
  else
    return of_passes;
}

template <class Stepper>
double work_bytes(Stepper const& stepper) {
  if constexpr (requires { stepper.work_bytes(); })
    return static_cast<double>(stepper.work_bytes());
  else
    return 0;
}

/// Times step after step.
template <class Stepper, class System>
void time_steps(benchmark::State& state, cayspin::Lattice const& lattice, double words_of_passes) {
  auto spins = random<typename Stepper::spins_type>(lattice);
  auto const generator = System::generator(lattice);
  auto stepper = make_stepper<Stepper>(spins);
  Kokkos::DefaultExecutionSpace const exec;
  for (int i = 0; i < 2; ++i) stepper.step(exec, generator, spins, 0, dt);
  exec.fence();
  for (auto _ : state) {
    stepper.step(exec, generator, spins, 0, dt);
    exec.fence();
  }
  report(state, lattice.sites(), words_moved(stepper, words_of_passes), work_bytes(stepper));
}

template <class Run>
void add(std::string const& name, Run run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->UseRealTime()->Unit(benchmark::kMillisecond);
}

}  // namespace scene
