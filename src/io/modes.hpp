// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/units.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// The file of `cayspin modes` (HDF5; docs/reference/file_format.md has the layout).
namespace cayspin::inline v0_2::io {

/// Contents of a file of modes. Vectors with numbers per site are in the order of initial_spins.
struct ModesContents {
  std::string scene_text, cayspin_version, git_commit, space;
  std::string precision = "double";
  std::array<std::int64_t, 3> shape{1, 1, 1};
  std::int64_t cell_sites = 1;
  Units units;
  double torque = 0;  ///< max |m x H| of the equilibrium, in the units of the scene
  bool converged = false;
  std::int64_t evaluations = 0;

  std::vector<double> spins;                           ///< sites x 3
  std::vector<double> frequencies, decays, residuals;  ///< one for each mode
  std::vector<std::vector<double>> shapes;             ///< per mode: sites x 3 x (real, imaginary)
  std::vector<double> curvatures;                      ///< empty if not computed
  /// The error of each curvature, in its unit, and the relative error of its vector. Empty if not
  /// computed, and for files of earlier versions.
  std::vector<double> curvature_errors, curvature_residuals;
  std::vector<std::vector<double>> curvature_vectors;  ///< per curvature: sites x 3
};

/// Returns how many of the curvatures are negative beyond their errors.
std::size_t negative_curvatures(ModesContents const& contents);

/// Contents with spin waves instead of modes: `frequencies` and `decays` list all branches of the
/// first wave vector, then those of the next.
struct BandsContents : ModesContents {
  std::vector<std::array<double, 3>> wave_vectors;  ///< in cycles per cell
};
void write_bands(std::filesystem::path const& path, BandsContents const& contents, bool overwrite);

/// Returns true for a file of modes or of spin waves. Throws if it is not an HDF5 file.
bool is_modes(std::filesystem::path const& path);

/// Reads a file of modes or of spin waves, except the vectors with numbers per site.
BandsContents read_modes(std::filesystem::path const& path);

/// Writes PATH.partial and renames it. Throws std::runtime_error with one line.
void write_modes(std::filesystem::path const& path, ModesContents const& contents, bool overwrite);

}  // namespace cayspin::inline v0_2::io
