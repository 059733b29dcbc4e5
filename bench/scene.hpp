// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "random_spins.hpp"

#include <cayspin/cayspin.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

// The scene of the benchmarks, and the timing of a stepper on it.
namespace scene {

// Damping is 0, but its term is computed. With damping, a small lattice would reach equilibrium
// within a repetition, and the benchmark would time denormal numbers.
inline constexpr double exchange = 1, anisotropy = 0.5, applied = 0.3, damping = 0, dt = 0.02;

/// A lattice that fits the second-level cache, and is small enough for the calling thread to do all
/// the work.
inline cayspin::Lattice in_l2() { return cayspin::Lattice::cubic(128, 4, 4); }

/// A lattice, and the text for its size in the names of cases.
struct Size {
  cayspin::Lattice lattice;
  std::string name;
};

inline Size cube(std::int64_t n) { return {cayspin::Lattice::cubic(n, n, n), std::to_string(n)}; }

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

/// Reports nanoseconds per spin and step, and what limits them: the values moved per spin and step
/// (`words`) and the bytes of work memory per spin.
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

/// Returns how many values per spin a step on a large lattice moves between caches and memory:
/// `of_passes` if each stage is a pass over memory, and 6 for a sweep, which reads and writes the
/// spins once.
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

/// Times steps; returns the stepper.
template <class Stepper, class System = Default>
Stepper time_steps(benchmark::State& state, cayspin::Lattice const& lattice) {
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
  return stepper;
}
/// Times steps and reports them.
template <class Stepper, class System>
void time_steps(benchmark::State& state, cayspin::Lattice const& lattice, double words_of_passes) {
  auto const stepper = time_steps<Stepper, System>(state, lattice);
  report(state, lattice.sites(), words_moved(stepper, words_of_passes), work_bytes(stepper));
}

/// Returns the largest difference of any component between `others`, (sites, 3), and the spins
/// after `steps` steps of the library.
template <class Stepper, class System = Default>
double distance_to(std::vector<double> const& others, cayspin::Lattice const& lattice, int steps,
                   double step) {
  using Spins = typename Stepper::spins_type;
  typename Spins::memory_space::execution_space const exec;
  auto spins = random<Spins>(lattice);
  auto stepper = make_stepper<Stepper>(spins);
  auto const generator = System::generator(lattice);
  for (int i = 0; i < steps; ++i) stepper.step(exec, generator, spins, 0, step);
  auto const ours = copy_to_host(spins);
  double most = 0;
  for (std::size_t i = 0; i < others.size(); ++i)
    most = std::max(most, std::abs(static_cast<double>(ours[i]) - others[i]));
  return most;
}

template <class Run>
void add(std::string const& name, Run run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->UseRealTime()->Unit(benchmark::kMillisecond);
}
/// Registers run(state, lattice) as NAME/SIZE for each size.
template <class Run>
void add(std::string const& name, std::vector<Size> const& sizes, Run run) {
  for (auto const& size : sizes)
    add(name + "/" + size.name,
        [run, lattice = size.lattice](benchmark::State& state) { run(state, lattice); });
}

}  // namespace scene
