// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene.hpp"

#include <cmath>
#include <vector>

// The scene with one thing changed, for the options' costs.
namespace systems {

using Scalars = cayspin::ScalarField<double>;

struct Bodies {
  static auto generator(cayspin::Lattice const&) { return cayspin::RigidBody::principal(1, 2, 3); }
};

/// One number on all sites, kept for each of them.
inline Scalars on_sites(cayspin::Lattice const& lattice, double number) {
  return Scalars("coefficient", lattice, number);
}

template <class Exchange, class Anisotropy, class Applied, class... Others>
auto landau_lifshitz(Exchange exchange, Anisotropy anisotropy, Applied applied, Others... others) {
  return cayspin::LandauLifshitz(cayspin::EffectiveField(exchange, anisotropy, applied, others...),
                                 scene::damping);
}

inline cayspin::Exchange exchange(cayspin::Lattice const& lattice) {
  return {lattice, scene::exchange};
}
inline cayspin::UniaxialAnisotropy anisotropy() { return {scene::anisotropy, {0, 0, 1}}; }
inline cayspin::Zeeman applied() { return {{0, 0, scene::applied}}; }

struct Turning {
  cayspin::Vec3<double> operator()(double t) const {
    return {scene::applied * std::sin(t), 0, scene::applied * std::cos(t)};
  }
};

struct FieldOfTime {
  static auto generator(cayspin::Lattice const& lattice) {
    return landau_lifshitz(exchange(lattice), anisotropy(),
                           cayspin::TimeDependentZeeman(Turning()));
  }
};

struct HostDemag {
  static auto generator(cayspin::Lattice const& lattice) {
    using Spins = cayspin::SpinField<double>;
    return landau_lifshitz(exchange(lattice), anisotropy(), applied(),
                           cayspin::HostField<Spins, cayspin::SlabDemagOnHost>(
                               lattice, cayspin::SlabDemagOnHost({0, 0, 1})));
  }
};

struct AnisotropyOfSites {
  static auto generator(cayspin::Lattice const& lattice) {
    cayspin::SpinField<double> const axes("axes", lattice);
    return landau_lifshitz(
        exchange(lattice),
        cayspin::SiteDependentUniaxialAnisotropy(on_sites(lattice, scene::anisotropy), axes),
        applied());
  }
};

struct ExchangeOfSites {
  static auto generator(cayspin::Lattice const& lattice) {
    return landau_lifshitz(cayspin::SiteDependentExchange(on_sites(lattice, scene::exchange)),
                           anisotropy(), applied());
  }
};

struct DampingOfSites {
  static auto generator(cayspin::Lattice const& lattice) {
    return cayspin::LandauLifshitz(scene::Default::field(lattice),
                                   on_sites(lattice, scene::damping));
  }
};

/// Steps through integrate with energy, norm defect and magnetization taken after each.
template <class Stepper>
void time_observed_steps(benchmark::State& state, cayspin::Lattice const& lattice) {
  auto spins = scene::random<typename Stepper::spins_type>(lattice);
  auto const generator = scene::Default::generator(lattice);
  Stepper stepper(spins);
  std::vector<cayspin::Sample> samples;
  cayspin::Record record(scene::Default::field(lattice), samples);
  Kokkos::DefaultExecutionSpace const exec;
  constexpr std::int64_t steps = 8;
  std::int64_t done = 0;
  for (auto _ : state) {
    samples.clear();
    cayspin::integrate(exec, stepper, generator, spins,
                       {.begin = 0, .dt = scene::dt, .steps = done + steps, .first = done}, record);
    done += steps;
  }
  double const words_of_step = 6, words_of_sample = 3;
  scene::report(state, lattice.sites() * steps,
                words_of_step + words_of_sample * (steps + 1) / steps, 0);
}

}  // namespace systems
