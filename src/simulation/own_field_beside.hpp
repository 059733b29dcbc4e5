// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cayspin/lattice.hpp>

namespace cayspin::simulation {

/// Joins a program's own nonlocal field with demag, dipoles or a slab computed on the host. In the
/// returned field, own.nonlocal is their sum, and the other term is removed. If one of the two is
/// missing, returns the field unchanged.
template <class Real>
io::Field with_joined_own_field(io::Scene const& scene, io::Field field, Lattice const& lattice);

}  // namespace cayspin::simulation
