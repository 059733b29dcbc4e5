// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// What each option of the integrators costs: nanoseconds per spin and step, beside the plain form
// of the same method, in one run. Size 100 is a chain, the others are cubes.
#include "median_table.hpp"
#include "random_spins.hpp"

#include <cayspin/cayspin.hpp>

#include <benchmark/benchmark.h>

#include <string>

namespace {

using Spins = cayspin::SpinField<double>;
using namespace cayspin;

constexpr double dt = 0.02;

Lattice lattice_of(std::int64_t size) {
  return size == 100 ? Lattice::chain(100) : Lattice::cubic(size, size, size);
}

// The damping is computed, and 0: with any other the chain of 100 comes to rest in the time that a
// repetition takes, and what is timed are denormal numbers.
struct Coupled {
  static auto generator(Lattice const& lattice) {
    return LandauLifshitz(EffectiveField(Exchange(lattice, 1), UniaxialAnisotropy(0.5, {0, 0, 1}),
                                         Zeeman{{0, 0, 0.3}}),
                          0);
  }
};
struct Bodies {
  static auto generator(Lattice const&) { return RigidBody::principal(1, 2, 3); }
};
template <class Of>
struct OrthogonalOf {
  static auto generator(Lattice const& lattice) { return orthogonal(Of::generator(lattice)); }
};

template <class Stepper>
Stepper make(Spins const& like) {
  if constexpr (requires { typename Stepper::stepper_type; })
    return Stepper(like, typename Stepper::stepper_type(like));
  else
    return Stepper(like);
}

template <class Stepper, class System>
void run(benchmark::State& state) {
  auto const lattice = lattice_of(state.range(0));
  Spins spins("spins", lattice);
  copy_from_host(random_spins(lattice.sites()), spins);
  auto const generator = System::generator(lattice);
  auto stepper = make<Stepper>(spins);
  Kokkos::DefaultExecutionSpace const exec;
  for (int i = 0; i < 2; ++i) stepper.step(exec, generator, spins, 0, dt);
  exec.fence();
  for (auto _ : state) {
    stepper.step(exec, generator, spins, 0, dt);
    exec.fence();
  }
  state.counters["ns/step"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(lattice.sites()) * 1e-9,
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

std::vector<std::pair<std::string, std::string>> yardsticks;

template <class Stepper, class System = Coupled>
void add(std::string const& name, std::string const& yardstick = {}) {
  benchmark::RegisterBenchmark(("f64/" + name).c_str(), run<Stepper, System>)
      ->Arg(100)
      ->Arg(32)
      ->Arg(128)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  if (!yardstick.empty()) yardsticks.emplace_back(name, yardstick);
}

void register_euler() {
  using namespace isotropy;
  std::string const euler = "Euler";
  add<LieEuler<Spins>>(euler);
  add<LieEuler<Spins>, OrthogonalOf<Coupled>>("Euler orthogonal", euler);
  add<LieEuler<Spins, Constant>>("Euler constant sigma", euler);
  add<LieEuler<Spins, Zero, Exponential>>("Euler exponential", euler);
  add<LieEuler<Spins, Analytic>>("Euler analytic sigma", euler);
  add<LieEuler<Spins, FiniteDifference>>("Euler forward difference", euler);
  add<LieEuler<Spins, FiniteDifferenceBackward>>("Euler backward difference", euler);
  add<LieAdamsBashforth2<Spins>>("Adams-Bashforth 2", euler);
  add<ImplicitLieEuler<Spins>>("implicit Euler", euler);
  add<ImplicitMidpoint<Spins>>("implicit midpoint", euler);
}

void register_heun() {
  std::string const heun = "Heun", bodies = "Heun of bodies";
  add<LieHeun<Spins>>(heun, "Euler");
  add<LieHeun<Spins>, OrthogonalOf<Coupled>>("Heun orthogonal", heun);
  add<LieHeun<Spins, isotropy::Zero, Exponential>>("Heun exponential", heun);
  add<StereographicRungeKutta<Spins, tableau::Heun>>("Heun tangent", heun);
  add<LieHeun<Spins>, Bodies>(bodies);
  add<LieHeun<Spins>, OrthogonalOf<Bodies>>("Heun of bodies orthogonal", bodies);
  add<LieHeun<Spins, isotropy::Energy>, Bodies>("Heun of bodies dcor", bodies);
  add<LieHeun<Spins, isotropy::Energy>, OrthogonalOf<Bodies>>("Heun of bodies ocor", bodies);
}

void register_order_4() {
  std::string const rkmk4 = "Rkmk4", bodies = "Rkmk4 of bodies";
  add<Rkmk4<Spins>>(rkmk4, "Euler");
  add<Rkmk4<Spins>, OrthogonalOf<Coupled>>("Rkmk4 orthogonal", rkmk4);
  add<Rkmk4<Spins, isotropy::Zero, Exponential>>("Rkmk4 exponential", rkmk4);
  add<StereographicRungeKutta<Spins, tableau::Classical4>>("Rkmk4 tangent", rkmk4);
  add<EnergyProjection<Rkmk4<Spins>>>("Rkmk4 energy projection", rkmk4);
  add<Series4<Spins>>("Series4", rkmk4);
  add<Rkmk4<Spins>, Bodies>(bodies);
  add<Rkmk4<Spins, isotropy::Energy>, Bodies>("Rkmk4 of bodies dcor", bodies);
  add<Series4<Spins>, Bodies>("Series4 of bodies", bodies);
  add<Series4<Spins, isotropy::Energy>, Bodies>("Series4 of bodies dcor", bodies);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  register_euler();
  register_heun();
  register_order_4();
  MedianTable table("ns/step", yardsticks, MedianTable::Ratio::cost);
  return table.run(argc, argv);
}
