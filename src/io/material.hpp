// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"
#include "io/site_numbers.hpp"

#include <optional>
#include <vector>

namespace cayspin::inline v0_2::io {

/// The table [material] of a scene in SI, in SI units. System, Lattice and Field have the same
/// values in reduced units.
struct Material {
  bool atomistic = false;  ///< true: mu_s, J and K; false: Ms, A and Ku
  /// Ms in A/m, or mu_s in J/T, of the first site. If site-dependent, the moment that counts as 1.
  double moment = 0;
  std::vector<double> moments;        ///< in J/T, one for each site of the cell; empty: all equal
  std::optional<double> exchange;     ///< A in J/m, or J of a bond in J
  std::optional<double> anisotropy;   ///< Ku in J/m^3, or K of a site in J
  std::optional<double> anisotropy2;  ///< Ku2 in J/m^3, or K2 of a site in J
  std::optional<double> dmi;          ///< D of an interface in J/m^2, or of its bonds in J
  std::optional<double> bulk_dmi;     ///< D of the bulk, in the units of `dmi`
  std::optional<double> d2d_dmi;      ///< D of a crystal of symmetry D2d, in the units of `dmi`
  SiteNumbers moment_factors, exchange_factors, anisotropy_factors, anisotropy2_factors,
      dmi_factors, alpha_factors, gamma_factors;  ///< values per site, in SI; empty if uniform
  SiteVectors axes, normals;      ///< vectors per site; if set, replace `axis` and `normal`
  Triple axis = {}, normal = {};  ///< unit vectors
  double alpha = 0;
  bool gilbert = true;  ///< true: Gilbert's equation; false: Landau and Lifshitz's
  double gamma = 0;     ///< in rad/(s T); if site-dependent, the ratio that counts as 1
};

}  // namespace cayspin::inline v0_2::io
