// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"
#include "io/site_numbers.hpp"

#include <optional>
#include <vector>

namespace cayspin::inline v0_2::io {

/// The table [material] of a scene in SI, in SI units. System, Lattice and Field have its values in
/// reduced units.
struct Material {
  bool atomistic = false;  ///< mu_s, J and K instead of Ms, A and Ku
  /// Ms in A/m, or mu_s in J/T, of the first site; if site-dependent, the unit of reduced moments.
  double moment = 0;
  std::vector<double> moments;        ///< in J/T, one for each site of the cell; empty: all equal
  std::optional<double> exchange;     ///< A in J/m, or J of a bond in J
  std::optional<double> anisotropy;   ///< Ku in J/m^3, or K of a site in J
  std::optional<double> anisotropy2;  ///< Ku2 in J/m^3, or K2 of a site in J
  std::optional<double> dmi;          ///< D of an interface in J/m^2, or of its bonds in J
  std::optional<double> bulk_dmi;     ///< D of the bulk
  std::optional<double> d2d_dmi;      ///< D of a crystal of symmetry D2d
  SiteNumbers moment_factors, exchange_factors, anisotropy_factors, anisotropy2_factors,
      dmi_factors, alpha_factors, gamma_factors;  ///< site-dependent, in SI
  SiteVectors axes, normals;                      ///< instead of one axis, one normal
  Triple axis = {}, normal = {};                  ///< unit vectors
  double alpha = 0;
  bool gilbert = true;  ///< true: Gilbert's equation; false: Landau and Lifshitz's
  double gamma = 0;     ///< in rad/(s T); if site-dependent, the unit of reduced ratios
};

}  // namespace cayspin::inline v0_2::io
