// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "guard.hpp"
#include "io/scene.hpp"

#include <cayspin/spin_field.hpp>
#include <cayspin/step.hpp>

#include <cstdint>

namespace cayspin::simulation {

/// Keeper of the object that lattice.follow names: keeps it in the middle by moving the spins along
/// its axis by whole cells. Cells that enter at an end are copies of those there. Compiled in
/// follow.cpp, for the spaces of space.hpp.
template <class Spins>
class Follower {
  using Real = typename Spins::value_type;

 public:
  Follower(io::Scene const& scene, Lattice const& lattice);

  bool due(Step const& step) const { return step.number % period_ == 0; }

  /// Returns by how many cells it has left the middle; 0 below one cell, and if it is not there.
  template <class Exec>
  std::int64_t cells_off(Exec const& exec, Spins const& spins) const;

  /// Moves the lattice by so many cells along its axis, that is, the spins in the opposite
  /// direction; waits.
  template <class Exec>
  void move(Exec const& exec, Spins const& spins, std::int64_t cells);

  /// Returns the cells by which the lattice has moved since the start of the run.
  std::int64_t shift() const { return shift_; }
  void go_on_from(std::int64_t shift) { shift_ = shift; }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("shift", shift_);
  }

 private:
  io::Follow follow_;
  std::int64_t extent_, period_, shift_ = 0;
  Spins moved_;
  ScalarField<Real, typename Spins::memory_space>
      places_;  // along the axis, in cells from the middle
};

}  // namespace cayspin::simulation
