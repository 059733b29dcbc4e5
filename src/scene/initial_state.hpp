// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <array>
#include <cstdint>

namespace cayspin::inline v0_2::io::detail {

/// Reads the state that initial.state names, with its keys. Call it after reading the lattice.
InitialState read_initial_state(Table const& table, Item const& state);

/// Returns the unnormalised spin of a site of the lattice.
Triple spin_of_state(InitialState const& state, Lattice const& lattice,
                     std::array<std::int64_t, 3> const& site);

}  // namespace cayspin::inline v0_2::io::detail
