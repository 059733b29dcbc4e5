// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstdint>

namespace cayspin::inline v0_2 {

/// A bond of a crystal between spin m at site between[0] of a cell and spin m' at site between[1]
/// of the cell `offset` cells away. E = -m.(T m') - biquadratic * (m.m')^2. List each bond once.
struct Coupling {
  std::array<int, 2> between{};
  std::array<int, 3> offset{};
  std::array<double, 9> tensor{};  ///< T, row by row
  double biquadratic = 0;

  /// Returns a bond with exchange and Dzyaloshinskii-Moriya interaction:
  /// E = -J * m.m' - D.(m x m').
  static Coupling of(std::array<int, 2> between, std::array<int, 3> offset, double J,
                     std::array<double, 3> const& D = {}) {
    return {between, offset, {J, D[2], -D[1], -D[2], J, D[0], D[1], -D[0], J}};
  }

  friend bool operator==(Coupling const&, Coupling const&) = default;
};

}  // namespace cayspin::inline v0_2
