// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_modes.hpp"

#include "failure.hpp"
#include "io/scene.hpp"
#include "scene_minimizer.hpp"
#include "text.hpp"
#include "torque_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

namespace cayspin::simulation {
void require_motion(io::Scene const& scene) {
  if (!scene.system.precession && scene.system.damping == 0 && !scene.system.dampings.there())
    throw io::scene_error(scene, "system.damping",
                          "spins without precession and damping do not move; accepted: a damping "
                          "above 0, or precession = true");
}

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

}  // namespace cayspin::simulation
