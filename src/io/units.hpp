// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

namespace cayspin::inline v0_2::io {

/// The units of reduced numbers, measured in the units of the scene and its files.
struct Units {
  bool si = false;    ///< units = "SI"; otherwise all are 1
  double time = 1;    ///< s
  double length = 1;  ///< m
  double field = 1;   ///< T, of mu0 H
  double energy = 1;  ///< J

  bool operator==(Units const&) const = default;
};

}  // namespace cayspin::inline v0_2::io
