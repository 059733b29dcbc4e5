// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cayspin/lattice.hpp>

namespace cayspin::simulation {

/// A program's own field and demag, dipoles or a slab on the host are computed together: the own
/// field of what is returned is their sum, and the others are not in it.
template <class Real>
io::Field with_joined_own_field(io::Scene const& scene, io::Field field, Lattice const& lattice);

}  // namespace cayspin::simulation
