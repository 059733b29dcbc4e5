// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"
#include "io/scene.hpp"
#include "scene_generator.hpp"
#include "scene_modes.hpp"
#include "small_matrices_of_modes.hpp"
#include "space.hpp"
#include "torque_modes.hpp"
#include "turning_of_sites.hpp"

#include <cayspin/evaluate.hpp>
#include <cayspin/modes.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

// The definitions of the templates of scene_modes.hpp, for one precision in each source file that
// includes this header.
namespace cayspin::simulation {
namespace {

template <class Real, class Memory>
Turning<Real, Memory> turning_of(io::Scene const& scene, Lattice const& lattice) {
  auto const [precession, damping] = turning_of_sites(scene);
  Turning<Real, Memory> const turning{{"modes::precession", lattice}, {"modes::damping", lattice}};
  copy_from_host(precession, turning.precession);
  copy_from_host(damping, turning.damping);
  return turning;
}

template <class Spins>
std::vector<double> shape_of(Spins const& real, Spins const& imaginary) {
  auto const x = copy_to_host(real), y = copy_to_host(imaginary);
  std::vector<double> shape(2 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    shape[2 * i] = static_cast<double>(x[i]);
    shape[2 * i + 1] = static_cast<double>(y[i]);
  }
  return shape;
}

template <class Exec, class Spins>
void normalize_shape(Exec const& exec, Spins const& like, std::vector<double>& shape) {
  std::vector<double> x(shape.size() / 2), y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = shape[2 * i];
    y[i] = shape[2 * i + 1];
  }
  Spins const real("modes::real", like.lattice()), imaginary("modes::imaginary", like.lattice());
  copy_from_host(x, real);
  copy_from_host(y, imaginary);
  cayspin::detail::normalize_mode(exec, real, imaginary);
  shape = shape_of(real, imaginary);
}

template <class Real, class Space>
TorqueMotion motion_of(Space const& exec, io::Scene scene, Lattice const& lattice,
                       ModesOptions const& options) {
  using Spins = SpinField<Real, typename Space::memory_space>;
  if (auto& demag = scene.field.demag) demag->multirate = false;
  if (auto& slab = scene.field.slab_demag) slab->multirate = false;
  TorqueMotion motion;
  io::SiteBox const all{{0, 0, 0}, lattice.shape};
  motion.frozen = io::frozen(scene, all);
  motion.epsilon = std::numeric_limits<Real>::epsilon();
  auto const [precession, damping] = turning_of_sites(scene);
  auto const moments = io::all_moments(scene, all);
  for (std::size_t site = 0; site < precession.size(); ++site)
    motion.turning.push_back(std::hypot(precession[site], damping[site]) *
                             (moments.empty() ? 1 : moments[site]));
  motion.is_interrupted = [poll = options.poll] { return poll && poll() == Next::stop; };
  motion.rates = [exec, generator = SceneGenerator<Spins>(scene, lattice),
                  spins = Spins("modes::shifted", lattice),
                  turning = Spins("modes::turning", lattice),
                  time = options.time](Vectors const& from) {
    copy_from_host(from, spins);
    evaluate_generator(exec, generator, spins, time, turning);
    auto const a = copy_to_host(turning);
    Vectors rates(from.size());
    for (std::size_t i = 0; i < from.size(); i += 3)
      for (std::size_t c = 0; c < 3; ++c) {
        std::size_t const d = i + (c + 1) % 3, e = i + (c + 2) % 3;
        rates[i + c] = static_cast<double>(a[d]) * from[e] - static_cast<double>(a[e]) * from[d];
      }
    return rates;
  };
  return motion;
}

}  // namespace

template <class Real, class Space>
FoundModes find_modes(Space const& exec, io::Scene const& scene,
                      SceneField<SpinField<Real, typename Space::memory_space>> const& field,
                      SpinField<Real, typename Space::memory_space> const& spins,
                      ModesOptions const& options) {
  require_motion(scene);
  FoundModes modes;
  if (io::has_torque(scene.field)) {
    auto const numbers = copy_to_host(spins);
    modes = find_modes_with_torques(motion_of<Real>(exec, scene, spins.lattice(), options),
                                    {numbers.begin(), numbers.end()}, options.count,
                                    options.evaluations);
    for (auto& shape : modes.shapes) normalize_shape(exec, spins, shape);
  } else {
    auto const turning = turning_of<Real, typename Space::memory_space>(scene, spins.lattice());
    auto const found = normal_modes(exec, field, turning, spins, options);
    modes.end = found.end;
    modes.evaluations = found.evaluations;
    for (auto const& mode : found.modes) {
      modes.frequencies.push_back(mode.frequency);
      modes.decays.push_back(mode.decay);
      modes.errors.push_back(mode.error);
      modes.shapes.push_back(shape_of(mode.real, mode.imaginary));
    }
  }
  double const per_time = 1 / scene.units.time;
  double const cycles = scene.units.si ? 2 * std::numbers::pi : 1;
  for (auto& frequency : modes.frequencies) frequency = frequency * per_time / cycles;
  for (auto& decay : modes.decays) decay *= per_time;
  return modes;
}

template <class Real, class Space>
Minimum find_rest_with_torques(Space const& exec, io::Scene const& scene,
                               SpinField<Real, typename Space::memory_space> const& spins,
                               ModesOptions const& options, double torque, bool at_rest) {
  auto const motion = motion_of<Real>(exec, scene, spins.lattice(), options);
  auto const numbers = copy_to_host(spins);
  auto const found = find_rest_with_torques(motion, {numbers.begin(), numbers.end()}, torque,
                                            at_rest ? 1 : options.evaluations);
  copy_from_host(found.spins, spins);
  Minimum rest;
  rest.torque = found.torque;
  rest.evaluations = found.evaluations;
  rest.end = found.is_interrupted     ? MinimizeEnd::interrupted
             : found.torque <= torque ? MinimizeEnd::converged
                                      : MinimizeEnd::stagnated;
  return rest;
}

template <class Real, class Space>
FoundCurvatures find_curvatures(
    Space const& exec, io::Scene const& scene,
    SceneField<SpinField<Real, typename Space::memory_space>> const& field,
    SpinField<Real, typename Space::memory_space> const& spins, ModesOptions const& options) {
  auto const found = lowest_curvatures(exec, field, spins, options);
  FoundCurvatures curvatures;
  curvatures.end = found.end;
  curvatures.evaluations = found.evaluations;
  for (auto const& one : found.curvatures) {
    curvatures.values.push_back(one.value * scene.units.energy);
    curvatures.value_errors.push_back(one.value_error * scene.units.energy);
    curvatures.errors.push_back(one.error);
    auto const numbers = copy_to_host(one.vector);
    curvatures.vectors.emplace_back(numbers.begin(), numbers.end());
  }
  return curvatures;
}

template <class Real, class Space>
void add_errors_of_torque(Space const& exec, io::Scene const& scene,
                          SceneField<SpinField<Real, typename Space::memory_space>> const& field,
                          SpinField<Real, typename Space::memory_space> const& spins, double time,
                          FoundCurvatures& curvatures) {
  SpinField<Real, typename Space::memory_space> const at_spins("modes::field", spins.lattice());
  evaluate_field(exec, field, spins, time, at_spins);
  ++curvatures.evaluations;
  auto const m = copy_to_host(spins), h = copy_to_host(at_spins);
  io::SiteBox const all{{0, 0, 0}, spins.lattice().shape};
  auto const frozen = io::frozen(scene, all);
  double square = 0;  // of the largest slope of the energy
  for (std::size_t i = 0; i < m.size(); i += 3) {
    if (!frozen.empty() && frozen[i / 3] != 0) continue;
    Vec3<double> const spin{m[i], m[i + 1], m[i + 2]},
        torque = cross(spin, {h[i], h[i + 1], h[i + 2]});
    square = std::max(square, dot(torque, torque));
  }
  // Zero modes of rates have this factor, too.
  for (auto& error : curvatures.value_errors) error += 10 * std::sqrt(square) * scene.units.energy;
}

template <class Real, class Space>
FoundBands find_bands(Space const& exec, io::Scene const& scene,
                      SceneField<SpinField<Real, typename Space::memory_space>> const& field,
                      SpinField<Real, typename Space::memory_space> const& spins,
                      std::vector<std::array<double, 3>> const& wave_vectors, double time,
                      std::function<Next()> const& poll) {
  auto const turning = turning_of<Real, typename Space::memory_space>(scene, spins.lattice());
  FoundBands bands;
  double const per_time = 1 / scene.units.time;
  double const cycles = scene.units.si ? 2 * std::numbers::pi : 1;
  try {
    auto const found = bloch_modes(exec, field, turning, spins, wave_vectors, time, poll);
    bands.is_interrupted = found.bands.size() < wave_vectors.size();
    bands.evaluations = found.evaluations;
    for (auto const& branches : found.bands) {
      auto &frequencies = bands.frequencies.emplace_back(), &decays = bands.decays.emplace_back();
      for (auto const& [frequency, decay] : branches) {
        frequencies.push_back(frequency * per_time / cycles);
        decays.push_back(decay * per_time);
      }
    }
  } catch (std::invalid_argument const& error) {
    std::string_view const message = error.what();
    throw UsageError("--wave-vector" + std::string(message.substr(message.find(": "))));
  }
  return bands;
}

#define CAYSPIN_COMPILE_MODES(Space, Real)                                                     \
  template FoundModes find_modes(                                                              \
      Space const&, io::Scene const&, SceneField<SpinField<Real, Space::memory_space>> const&, \
      SpinField<Real, Space::memory_space> const&, ModesOptions const&);                       \
  template Minimum find_rest_with_torques(Space const&, io::Scene const&,                      \
                                          SpinField<Real, Space::memory_space> const&,         \
                                          ModesOptions const&, double, bool);                  \
  template FoundCurvatures find_curvatures(                                                    \
      Space const&, io::Scene const&, SceneField<SpinField<Real, Space::memory_space>> const&, \
      SpinField<Real, Space::memory_space> const&, ModesOptions const&);                       \
  template void add_errors_of_torque(                                                          \
      Space const&, io::Scene const&, SceneField<SpinField<Real, Space::memory_space>> const&, \
      SpinField<Real, Space::memory_space> const&, double, FoundCurvatures&);                  \
  template FoundBands find_bands(                                                              \
      Space const&, io::Scene const&, SceneField<SpinField<Real, Space::memory_space>> const&, \
      SpinField<Real, Space::memory_space> const&, std::vector<std::array<double, 3>> const&,  \
      double, std::function<Next()> const&);

}  // namespace cayspin::simulation
