// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"
#include "io/site_numbers.hpp"
#include "io/words.hpp"

#include <array>
#include <filesystem>
#include <variant>

namespace cayspin::inline v0_2::io {

using PrincipalMoments = Triple;
using InertiaTensor = std::array<double, 9>;  ///< symmetric 3x3, row by row
/// An HDF5 file with an inertia tensor for each body.
struct InertiaFile {
  std::filesystem::path path;  ///< dataset /inertia (count, 3, 3)
};

/// The table [system].
struct System {
  SystemKind kind = SystemKind::llg;
  double damping = 0;             ///< llg: lambda >= 0
  SiteNumbers dampings;           ///< llg: if set, replaces damping, which is then 0
  bool gilbert_of_sites = false;  ///< true: torques are divided by 1 + damping^2 at each site
  bool precession = true;         ///< llg: if false, overdamped: A = lambda * m x H
  std::variant<PrincipalMoments, InertiaTensor, InertiaFile> inertia;  ///< rigid_body
};

}  // namespace cayspin::inline v0_2::io
