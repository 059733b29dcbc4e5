// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/words.hpp"

#include <span>

namespace cayspin::inline v0_2::io {

/// The quantity that a lattice follows: the mean of a component, or the position of the topological
/// charge.
enum class Followed { mx, my, mz, charge };

template <>
inline std::span<Word<Followed> const> words() {
  static constexpr Word<Followed> all[] = {
      {"mx", Followed::mx},
      {"my", Followed::my},
      {"mz", Followed::mz},
      {"charge", Followed::charge},
  };
  return all;
}

/// Options for a lattice that follows a wall, a vortex or a skyrmion along an axis, by whole cells.
struct Follow {
  int axis = 0;
  Followed quantity = Followed::mx;
  double value = 0;  ///< mean of the component when the wall is in place
};

}  // namespace cayspin::inline v0_2::io
