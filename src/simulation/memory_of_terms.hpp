// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cayspin/lattice.hpp>
#include <cayspin/row_layout.hpp>

#include <cstdint>

namespace cayspin::simulation {

/// Returns the bytes of a field of `components` numbers for each site of a lattice, with its
/// ghosts.
template <class Real>
std::int64_t field_bytes(Lattice const& lattice, int components) {
  return static_cast<std::int64_t>(cayspin::RowLayout::of<Real>(lattice).allocation(components) *
                                   sizeof(Real));
}

/// Returns the bytes that the terms of a scene's field store. Interlayers are counted along all
/// axes. Most scenes have them along only one, and need less.
template <class Real>
std::int64_t memory_of_terms(io::Scene const& scene, Lattice const& lattice);

}  // namespace cayspin::simulation
