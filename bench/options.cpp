// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// What each option of the integrators costs: nanoseconds per spin and step of a chain of 100 spins,
// of cubes, and of a lattice that the second cache holds. Cases are named options/METHOD,
// OPTION/SIZE.
#include "context.hpp"
#include "scene.hpp"
#include "stream.hpp"
#include "systems.hpp"

#include <string>

namespace {

using Spins = cayspin::SpinField<double>;
using namespace cayspin;
using scene::Default, scene::Orthogonal;
using namespace systems;

template <class Run>
void on_sizes(std::string const& name, Run run) {
  auto const on = [&](Lattice const& lattice, char const* size) {
    scene::add("options/" + name + "/" + size,
               [=](benchmark::State& state) { run(state, lattice); });
  };
  on(Lattice::chain(100), "100");
  on(scene::in_l2(), "L2");
  on(scene::cube(32), "32");
  on(scene::cube(128), "128");
}

/// `words`: see scene::words_moved; 0 if there is no prediction.
template <class Stepper, class System = Default>
void add(std::string const& name, double words) {
  on_sizes(name, [=](benchmark::State& state, Lattice const& lattice) {
    scene::time_steps<Stepper, System>(state, lattice, words);
  });
}

void register_euler() {
  using namespace isotropy;
  using Euler = LieEuler<Spins>;
  add<Euler>("Euler", 6);
  add<Euler, Orthogonal<Default>>("Euler, orthogonal", 6);
  add<LieEuler<Spins, Constant>>("Euler, constant sigma", 6);
  add<LieEuler<Spins, Zero, Exponential>>("Euler, exponential", 6);
  add<LieEuler<Spins, Analytic>>("Euler, sigma from the derivative", 17);
  add<LieEuler<Spins, FiniteDifference>>("Euler, sigma by forward differences", 21);
  add<LieEuler<Spins, FiniteDifferenceBackward>>("Euler, sigma by backward differences", 12);
  add<Euler, FieldOfTime>("Euler, field of time", 6);
  add<Euler, HostDemag>("Euler, demag on the host", 15);
  add<Euler, AnisotropyOfSites>("Euler, anisotropy per site", 10);
  add<Euler, ExchangeOfSites>("Euler, exchange per site", 7);
  add<Euler, DampingOfSites>("Euler, damping per site", 7);
  on_sizes("Euler, observers each step", time_observed_steps<Euler>);
  add<LieAdamsBashforth2<Spins>>("Adams-Bashforth 2", 12);
  add<ImplicitLieEuler<Spins>>("implicit Euler", 0);
  add<ImplicitMidpoint<Spins>>("implicit midpoint", 0);
}

void register_heun() {
  using Heun = LieHeun<Spins>;
  add<Heun>("Heun", 21);
  add<Heun, Orthogonal<Default>>("Heun, orthogonal", 21);
  add<LieHeun<Spins, isotropy::Zero, Exponential>>("Heun, exponential", 21);
  add<StereographicRungeKutta<Spins, tableau::Heun>>("Heun, tangent", 15);
  add<Heun, FieldOfTime>("Heun, field of time", 21);
  add<Heun, Bodies>("Heun of bodies", 21);
  add<Heun, Orthogonal<Bodies>>("Heun of bodies, orthogonal", 21);
  add<LieHeun<Spins, isotropy::Energy>, Bodies>("Heun of bodies, dcor", 21);
  add<LieHeun<Spins, isotropy::Energy>, Orthogonal<Bodies>>("Heun of bodies, ocor", 21);
}

void register_order_4() {
  using Order4 = Rkmk4<Spins>;
  add<Order4>("RKMK4", 57);
  add<Order4, Orthogonal<Default>>("RKMK4, orthogonal", 57);
  add<Rkmk4<Spins, isotropy::Zero, Exponential>>("RKMK4, exponential", 57);
  add<StereographicRungeKutta<Spins, tableau::Classical4>>("RKMK4, tangent", 39);
  add<EnergyProjection<Order4>>("RKMK4, projected to its energy", 0);
  add<Series4<Spins>>("RKMK4, series", 0);
  add<Order4, Bodies>("RKMK4 of bodies", 57);
  add<Rkmk4<Spins, isotropy::Energy>, Bodies>("RKMK4 of bodies, dcor", 57);
  add<Series4<Spins>, Bodies>("RKMK4 of bodies, series", 0);
  add<Series4<Spins, isotropy::Energy>, Bodies>("RKMK4 of bodies, series and dcor", 0);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  stream::Arrays arrays;
  stream::register_copies(arrays);
  register_euler();
  register_heun();
  register_order_4();
  return run_benchmarks(argc, argv);
}
