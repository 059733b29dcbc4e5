// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_modes.hpp"

#include "failure.hpp"
#include "io/scene.hpp"
#include "scene_generator.hpp"
#include "scene_minimizer.hpp"
#include "space.hpp"
#include "text.hpp"
#include "torque_modes.hpp"
#include "turning_of_sites.hpp"

#include <cayspin/evaluate.hpp>
#include <cayspin/modes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>

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

void require_motion(io::Scene const& scene) {
  if (!scene.system.precession && scene.system.damping == 0 && !scene.system.dampings.there())
    throw io::scene_error(scene, "system.damping",
                          "spins without precession and damping do not move; accepted: a damping "
                          "above 0, or precession = true");
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

io::Scene without_torque(io::Scene scene) {
  scene.field.torque = {};
  return scene;
}

Plan make_plan_of_modes(io::Scene const& scene, Precision precision, ModesOptions const& options,
                        bool with_hessian) {
  require_motion(scene);
  auto plan = make_plan_to_relax(without_torque(scene), precision);
  auto const modes = static_cast<std::int64_t>(options.count);
  plan.memory.work = std::max(plan.memory.work, plan.memory.spins * (6 * modes + 100));
  if (io::has_torque(scene.field)) {
    auto const sites = io::sites(scene);
    if (sites > most_sites_with_torques)
      throw io::scene_error(
          scene, "lattice.shape",
          fmt::format("has {} sites; accepted for modes with [torque]: at most {}", sites,
                      most_sites_with_torques));
    constexpr std::int64_t matrices = 6;
    plan.memory.work += matrices * 4 * sites * sites * static_cast<std::int64_t>(sizeof(double));
  }
  auto const numbers = io::sites(scene) * (modes * (with_hessian ? 9 : 6) + 3);
  plan.memory.files += numbers * static_cast<std::int64_t>(sizeof(double));
  return plan;
}

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
    curvatures.errors.push_back(one.error);
    auto const numbers = copy_to_host(one.vector);
    curvatures.vectors.emplace_back(numbers.begin(), numbers.end());
  }
  return curvatures;
}

namespace {

// Returns the number of sites in a cell. Along open axes, a cell extends over the whole lattice.
std::int64_t sites_of_a_cell(io::Lattice const& lattice) {
  auto const sites = static_cast<std::int64_t>(lattice.basis.size());
  std::int64_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice.boundary[axis] != io::BoundaryKind::periodic) count *= lattice.shape[axis];
  return lattice.boundary[2] == io::BoundaryKind::periodic ? count * sites : count;
}

// Returns a lower bound on the number of cells over which the terms of a scene, except demag and
// dipoles, reach along an axis.
std::int64_t reach_along(io::Scene const& scene, std::size_t axis) {
  auto const& field = scene.field;
  std::int64_t reach = field.exchange || field.has_dmi() || !field.exchange_between.empty() ||
                               !field.interlayers.empty()
                           ? 1
                           : 0;
  for (auto const& bond : io::couplings(scene))
    reach = std::max(reach, static_cast<std::int64_t>(std::abs(bond.offset[axis])));
  return reach;
}

// Demag and dipoles couple all cells, also around a periodic lattice. The Hessian of the lattice
// determines their sums over cells only for waves that fit the lattice a whole number of times.
void require_whole_waves(io::Scene const& scene, double wave, std::size_t axis,
                         std::int64_t cells) {
  double const around = wave * static_cast<double>(cells);
  if (scene.field.demag && std::abs(around - std::round(around)) > 1e-9)
    throw UsageError(fmt::format(
        "--wave-vector: {:.7g} along {}, and the field of {} reaches around the lattice; accepted: "
        "{} there, also between corners (--points)",
        wave, "xyz"[axis], scene.field.demag->key,
        cells == 1 ? "whole numbers" : fmt::format("multiples of 1/{}", cells)));
}

}  // namespace

void require_bands(io::Scene const& scene, std::vector<std::array<double, 3>> const& wave_vectors) {
  require_motion(scene);
  auto const& lattice = scene.lattice;
  auto const sites = static_cast<std::int64_t>(lattice.basis.size());
  std::array<std::int64_t, 3> const cells{lattice.shape[0], lattice.shape[1],
                                          lattice.shape[2] / sites};
  if (std::ranges::count(lattice.boundary, io::BoundaryKind::periodic) == 0)
    throw io::scene_error(scene, "lattice.boundary",
                          "waves of a wave vector need a periodic axis; accepted: "
                          "\"periodic\", or a list with it");
  if (auto const of_a_cell = sites_of_a_cell(lattice); of_a_cell > most_sites_of_a_cell)
    throw io::scene_error(scene, "lattice.shape",
                          fmt::format("has {} sites in a cell, which extends over the open axes; "
                                      "accepted with --wave-vector: at most {}",
                                      of_a_cell, most_sites_of_a_cell));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const any_wave = [&](auto const& is) {
      return std::ranges::any_of(wave_vectors, [&](auto const& wave) { return is(wave[axis]); });
    };
    if (lattice.boundary[axis] != io::BoundaryKind::periodic) {
      if (any_wave([](double k) { return k != 0; }))
        throw UsageError(
            fmt::format("--wave-vector: it has a component along {}, which is open; accepted: "
                        "0 there, or a periodic axis",
                        "xyz"[axis]));
      continue;
    }
    for (auto const& wave : wave_vectors) require_whole_waves(scene, wave[axis], axis, cells[axis]);
    // A single cell is its own neighbour, so bonds between cells would have no phase.
    auto const reach = reach_along(scene, axis);
    bool const varies = any_wave([](double k) { return std::abs(k - std::round(k)) > 1e-9; });
    if (cells[axis] == 1 ? varies && reach > 0 : cells[axis] < 2 * reach)
      throw io::scene_error(
          scene, "lattice.shape",
          fmt::format("{} along {}, and bonds reach over {}; accepted: at least {}",
                      counted(cells[axis], "cell"), "xyz"[axis], counted(reach, "cell"),
                      2 * reach));
  }
}

std::int64_t memory_of_bands(io::Scene const& scene) {
  auto const of_a_cell = sites_of_a_cell(scene.lattice);
  auto const matrix = 4 * of_a_cell * of_a_cell * static_cast<std::int64_t>(sizeof(double));
  constexpr std::int64_t matrices = 12;  // for the complex eigenvalues
  return matrix * (io::sites(scene) / of_a_cell + matrices);
}

template <class Real, class Space>
FoundBands find_bands(Space const& exec, io::Scene const& scene,
                      SceneField<SpinField<Real, typename Space::memory_space>> const& field,
                      SpinField<Real, typename Space::memory_space> const& spins,
                      std::vector<std::array<double, 3>> const& wave_vectors,
                      std::function<Next()> const& poll) {
  auto const turning = turning_of<Real, typename Space::memory_space>(scene, spins.lattice());
  FoundBands bands;
  double const per_time = 1 / scene.units.time;
  double const cycles = scene.units.si ? 2 * std::numbers::pi : 1;
  try {
    auto const found = bloch_modes(exec, field, turning, spins, wave_vectors, 0, poll);
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

#define CAYSPIN_INSTANTIATE(Space, Real)                                                       \
  template FoundModes find_modes(                                                              \
      Space const&, io::Scene const&, SceneField<SpinField<Real, Space::memory_space>> const&, \
      SpinField<Real, Space::memory_space> const&, ModesOptions const&);                       \
  template Minimum find_rest_with_torques(Space const&, io::Scene const&,                      \
                                          SpinField<Real, Space::memory_space> const&,         \
                                          ModesOptions const&, double, bool);                  \
  template FoundCurvatures find_curvatures(                                                    \
      Space const&, io::Scene const&, SceneField<SpinField<Real, Space::memory_space>> const&, \
      SpinField<Real, Space::memory_space> const&, ModesOptions const&);                       \
  template FoundBands find_bands(                                                              \
      Space const&, io::Scene const&, SceneField<SpinField<Real, Space::memory_space>> const&, \
      SpinField<Real, Space::memory_space> const&, std::vector<std::array<double, 3>> const&,  \
      std::function<Next()> const&);
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
