// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Cost of each option of the integrators: nanoseconds per spin and step on a chain of 100 spins, on
// cubes, and on a lattice that fits the second-level cache. Cases are named options/METHOD,
// OPTION/SIZE.
#include "main.hpp"
#include "scene.hpp"
#include "stream.hpp"

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace cayspin;
using Spins = SpinField<double>;
using scene::Default, scene::Orthogonal;

// Rigid bodies instead of the default scene. Each later struct with a generator() is the default
// scene with one change.
struct Bodies {
  static auto generator(Lattice const&) { return RigidBody::principal(1, 2, 3); }
};

/// Returns a field with the same number at every site.
ScalarField<double> on_sites(Lattice const& lattice, double number) {
  return {"coefficient", lattice, number};
}

template <class Exchange, class Anisotropy, class Applied, class... Others>
auto landau_lifshitz(Exchange exchange, Anisotropy anisotropy, Applied applied, Others... others) {
  return LandauLifshitz(EffectiveField(exchange, anisotropy, applied, others...), scene::damping);
}

Exchange exchange(Lattice const& lattice) { return {lattice, scene::exchange}; }
UniaxialAnisotropy anisotropy() { return {scene::anisotropy, {0, 0, 1}}; }
Zeeman applied() { return {{0, 0, scene::applied}}; }

struct Turning {
  Vec3<double> operator()(double t) const {
    return {scene::applied * std::sin(t), 0, scene::applied * std::cos(t)};
  }
};

struct FieldOfTime {
  static auto generator(Lattice const& lattice) {
    return landau_lifshitz(exchange(lattice), anisotropy(), TimeDependentZeeman(Turning()));
  }
};

struct HostDemag {
  static auto generator(Lattice const& lattice) {
    return landau_lifshitz(exchange(lattice), anisotropy(), applied(),
                           HostField<Spins, SlabDemagOnHost>(lattice, SlabDemagOnHost({0, 0, 1})));
  }
};

struct AnisotropyOfSites {
  static auto generator(Lattice const& lattice) {
    Spins const axes("axes", lattice);
    return landau_lifshitz(
        exchange(lattice),
        SiteDependentUniaxialAnisotropy(on_sites(lattice, scene::anisotropy), axes), applied());
  }
};

struct ExchangeOfSites {
  static auto generator(Lattice const& lattice) {
    return landau_lifshitz(SiteDependentExchange(on_sites(lattice, scene::exchange)), anisotropy(),
                           applied());
  }
};

struct DampingOfSites {
  static auto generator(Lattice const& lattice) {
    return LandauLifshitz(scene::Default::field(lattice), on_sites(lattice, scene::damping));
  }
};

/// Times steps of integrate(), with energy, norm defect and magnetization computed after each step.
template <class Stepper>
void time_observed_steps(benchmark::State& state, Lattice const& lattice) {
  auto spins = scene::random<typename Stepper::spins_type>(lattice);
  auto const generator = scene::Default::generator(lattice);
  Stepper stepper(spins);
  std::vector<Sample> samples;
  Record record(scene::Default::field(lattice), samples);
  Kokkos::DefaultExecutionSpace const exec;
  constexpr std::int64_t steps = 8;
  std::int64_t done = 0;
  for (auto _ : state) {
    samples.clear();
    integrate(exec, stepper, generator, spins,
              {.begin = 0, .dt = scene::dt, .steps = done + steps, .first = done}, record);
    done += steps;
  }
  double const words_of_step = 6, words_of_sample = 3;
  scene::report(state, lattice.sites() * steps,
                words_of_step + words_of_sample * (steps + 1) / steps, 0);
}

template <class Run>
void on_sizes(std::string const& name, Run run) {
  scene::add(
      "options/" + name,
      {{Lattice::chain(100), "100"}, {scene::in_l2(), "L2"}, scene::cube(32), scene::cube(128)},
      run);
}

/// `words`: the `of_passes` of scene::words_moved; 0 if there is no prediction.
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
  add<Series4<Spins>>("RKMK4, series", 0);
  add<Order4, Bodies>("RKMK4 of bodies", 57);
  add<Rkmk4<Spins, isotropy::Energy>, Bodies>("RKMK4 of bodies, dcor", 57);
  add<Series4<Spins>, Bodies>("RKMK4 of bodies, series", 0);
  add<Series4<Spins, isotropy::Energy>, Bodies>("RKMK4 of bodies, series and dcor", 0);
}

}  // namespace

void register_benchmarks() {
  stream::register_copies();
  register_euler();
  register_heun();
  register_order_4();
}
