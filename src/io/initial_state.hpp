// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>

/// The states that initial.state can name, with their keys; docs/reference/scene.md has the
/// formulas. Lengths are in the unit of lattice.spacing, positions in fractions of the lattice.
namespace cayspin::inline v0_2::io {

struct VortexState {
  double radius = 0;  ///< of the core
  std::int64_t circulation = 1, polarity = 1;
  std::array<double, 2> center = {0.5, 0.5};
};

struct SkyrmionState {
  bool bloch = false;  ///< true: Bloch; false: Neel
  double radius = 0;   ///< of the circle m_z = 0
  double width = 0;    ///< of the wall
  std::int64_t polarity = -1, chirality = 1;
  std::array<double, 2> center = {0.5, 0.5};
};

struct TwoDomainsState {
  std::size_t axis = 0;                   ///< number of the axis across the wall
  std::array<Triple, 2> directions = {};  ///< unit vectors of both domains
  Triple wall = {};                       ///< unit vector: the spins in the middle of the wall
  double position = 0.5;
  double width = 0;
};

struct HelixState {
  double period = 0;
  Triple direction = {1, 0, 0};  ///< unit vector along the wave vector
  Triple normal = {1, 0, 0};     ///< unit vector about which the spins turn
  double phase = 0;
};

using InitialState = std::variant<VortexState, SkyrmionState, TwoDomainsState, HelixState>;

}  // namespace cayspin::inline v0_2::io
