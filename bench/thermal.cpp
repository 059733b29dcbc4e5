// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step without and with thermal noise between steps. Cases are named
// thermal/METHOD, PRECISION[, noise]/SIZE.
#include "main.hpp"
#include "scene.hpp"

#include <cayspin/observer/thermal_noise.hpp>

#include <string>
#include <vector>

namespace {

using namespace cayspin;

/// A stepper that applies both halves of the noise after each step.
template <class Of>
struct Noisy {
  using spins_type = typename Of::spins_type;

  explicit Noisy(spins_type const& like)
      : stepper(like), noise(like, 0.1, {.temperature = 1, .seed = 1}) {}

  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, spins_type& spins, double t, double dt) {
    stepper.step(exec, generator, spins, t, dt);
    noise.turn_between_steps(exec, ++number, dt, spins);
  }

  Of stepper;
  ThermalNoise<spins_type> noise;
  std::int64_t number = 0;
};

template <class Stepper>
void add_pair(std::string const& name) {
  std::vector<scene::Size> const sizes{{scene::in_l2(), "L2"}, scene::cube(32), scene::cube(128)};
  scene::add("thermal/" + name, sizes, [](benchmark::State& state, Lattice const& lattice) {
    scene::time_steps<Stepper, scene::Default>(state, lattice, 0);
  });
  scene::add("thermal/" + name + ", noise", sizes,
             [](benchmark::State& state, Lattice const& lattice) {
               scene::time_steps<Noisy<Stepper>, scene::Default>(state, lattice, 0);
             });
}

template <class Real>
void add_all(std::string const& precision) {
  using Spins = SpinField<Real>;
  add_pair<LieHeun<Spins>>("Heun, " + precision);
  add_pair<Rkmk4<Spins>>("RKMK4, " + precision);
  add_pair<RedBlack2<Spins>>("RedBlack2, " + precision);
}

}  // namespace

void register_benchmarks() {
  add_all<double>("double");
  add_all<float>("single");
}
