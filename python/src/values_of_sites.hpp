// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "arrays.hpp"

#include <string>

namespace cayspin::python {

/// Returns the values of an expression at all sites, (nz, ny, nx). Throws UsageError for an invalid
/// expression.
SiteNumbersOut at_sites(io::Scene const& scene, std::string const& expression);

/// Returns simulation::moments_over_g as an array (nz, ny, nx).
SiteNumbersOut moments_over_g(io::Scene const& scene);

}  // namespace cayspin::python
