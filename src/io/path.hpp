// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// A saddle on a path, in the units of the scene; curvatures are energies per square of radians.
struct SaddleOfPath {
  double energy = 0, curvature = 0, next_curvature = 0;
  std::int64_t image = 0;
};

/// The rates of harmonic transition state theory, and of Langer's with damping: prefactor T^(half
/// the zero modes that the start has more than the saddle) exp(-barrier / kT).
struct RatesOfPath {
  double prefactor_forward = 0, prefactor_backward = 0;  ///< reduced, or 1/s and T in K
  double langer_forward = 0, langer_backward = 0;        ///< the same of Langer's theory
  std::array<std::int64_t, 3> zero_modes{};              ///< of the start, the saddle and the end
  std::array<double, 3> volumes{};                       ///< of the zero modes
};

/// A minimum energy path, in the units of the scene.
struct Path {
  TrajectoryHeader header;
  std::string from, to;                  ///< files of both ends
  std::vector<double> spins;             ///< image after image, in the shape of the header
  std::vector<double> energy, distance;  ///< of each image
  std::vector<double> saddle;            ///< spins of the highest saddle
  std::vector<SaddleOfPath> saddles;     ///< highest first
  std::optional<RatesOfPath> rates;
  double torque = 0;  ///< largest max |m x H| of the saddles
  double across = 0;  ///< largest |H| of a spin across the path
  std::int64_t evaluations = 0;
  bool converged = false;
  double wall_seconds = 0;
  std::string end;  ///< why the search ended

  double barrier_forward() const { return saddles.front().energy - energy.front(); }
  double barrier_backward() const { return saddles.front().energy - energy.back(); }
};

/// Writes a path (HDF5; docs/reference/file_format.md has the layout) to PATH.partial and renames
/// it. Errors are those of trajectory.hpp.
void write_path(std::filesystem::path const& path, Path const& found, bool overwrite);

/// Is it a file of a path? Throws where it is no HDF5 file.
bool is_path(std::filesystem::path const& path);

/// Reads the file of a path except its spins. Errors are those of trajectory.hpp.
Path read_path(std::filesystem::path const& path);

/// Throws as write_path does for a file that it would not write.
void require_writable(std::filesystem::path const& path, bool overwrite);

}  // namespace cayspin::inline v0_2::io
