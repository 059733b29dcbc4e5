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

/// A saddle on a path, in the units of the scene; curvatures are energies per radian squared.
struct SaddleOfPath {
  double energy = 0, curvature = 0, next_curvature = 0;
  std::int64_t image = 0;
};

/// Prefactors of rates in harmonic transition state theory, and in Langer's theory, which includes
/// damping. A rate is prefactor * T^((z0 - zs) / 2) * exp(-barrier / kT), where z0 and zs are the
/// numbers of zero modes of the initial state and of the saddle.
struct RatesOfPath {
  double prefactor_forward = 0, prefactor_backward = 0;  ///< reduced, or in 1/s with T in K
  double langer_forward = 0, langer_backward = 0;        ///< prefactors of Langer's theory
  std::array<std::int64_t, 3> zero_modes{};              ///< of the start, the saddle and the end
  std::array<double, 3> volumes{};                       ///< of their zero modes, in the same order
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
  double torque = 0;  ///< largest |m x H| at a saddle; an upper bound if moments differ
  double across = 0;  ///< largest component of H across the path, over all spins
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

/// Returns true for a file of a path. Throws if it is not an HDF5 file.
bool is_path(std::filesystem::path const& path);

/// Reads the file of a path except its spins. Errors are those of trajectory.hpp.
Path read_path(std::filesystem::path const& path);

/// Reads the spins of the highest saddle, in the order of the header's shape, from the file of a
/// path with this header. Throws if the path has no saddle. Errors are those of trajectory.hpp.
std::vector<double> read_saddle(std::filesystem::path const& path, TrajectoryHeader const& header);

/// Throws the error that write_path, write_modes or write_bands would throw if the file cannot be
/// written.
void require_writable(std::filesystem::path const& path, bool overwrite);

}  // namespace cayspin::inline v0_2::io
