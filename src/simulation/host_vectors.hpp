// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/own_field.hpp"

#include <vector>

namespace cayspin::simulation {

/// Multiplies all vectors by `factor`.
void scale(io::HostVectors const& vectors, double factor);
/// Multiplies each vector by the factor of its site in the cell. `factors`: one for each site of
/// the cell; the planes of the lattice belong to these sites in turn.
void scale_by_site(io::HostVectors const& vectors, std::vector<double> const& factors);

}  // namespace cayspin::simulation
