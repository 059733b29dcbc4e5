// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "restart.hpp"

#include "simulation/failure.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cayspin::program {

Restart::Restart(std::filesystem::path path, io::Scene const& scene, Precision precision)
    : path_(std::move(path)), info_(io::read_info(path_)) {
  auto const refuse = [&](std::string const& wrong, std::string const& accepted) {
    throw UsageError(
        fmt::format("--restart {}: {}; accepted: {}", path_.string(), wrong, accepted));
  };
  auto const& [nx, ny, nz] = info_.header.shape;
  if (info_.header.shape != scene.lattice.shape)
    refuse(fmt::format("its lattice is {} x {} x {}", nx, ny, nz), "the scene's lattice");
  if (info_.header.precision != to_string(precision))
    refuse(fmt::format("its spins are in {} precision", info_.header.precision),
           fmt::format("--precision {}", info_.header.precision));
  if (info_.frames == 0) refuse("it holds no frame", "a file with one");
  auto const& units = scene.units;
  if (info_.header.units.si != units.si)
    refuse(units.si ? "it is in reduced units" : "it is in SI units", "the units of the scene");
  // As the file's times were made, so that those of the same scene are equal to the bit.
  double const dt = scene.integrator.dt * units.time, time = info_.frame_times.back();
  if (std::abs(time - static_cast<double>(step()) * scene.integrator.dt * units.time) > 1e-9 * dt)
    refuse(fmt::format("its step {} is at t = {:.12g}{}, not at that many steps of dt = {:.12g}{}",
                       step(), time, units.si ? " s" : "", dt, units.si ? " s" : ""),
           "the dt it was run with");
  if (step() >= scene.integrator.steps)
    refuse(fmt::format("it ends at step {}, the scene at step {}", step(), scene.integrator.steps),
           "a scene that goes on");
}

std::vector<double> Restart::spins() const { return io::read_spins(path_, info_.header.shape); }

}  // namespace cayspin::program
