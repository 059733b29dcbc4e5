// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "guard.hpp"
#include "io/scene.hpp"

#include <cayspin/spin_field.hpp>
#include <cayspin/step.hpp>

#include <cstdint>

namespace cayspin::simulation {

/// Keeps the object that lattice.follow names, such as a domain wall, in the middle of the lattice,
/// by moving all spins along an axis by whole cells. Cells that enter at an end are copies of the
/// last cell at that end. Compiled in follow.cpp, for the spaces of space.hpp.
template <class Spins>
class Follower {
  using Real = typename Spins::value_type;

 public:
  Follower(io::Scene const& scene, Lattice const& lattice);

  bool due(Step const& step) const { return step.number % period_ == 0; }

  /// Returns the position of the object along the axis, in cells from the middle, rounded towards 0
  /// and limited to half the lattice; 0 if there is no object.
  template <class Exec>
  std::int64_t cells_off(Exec const& exec, Spins const& spins) const;

  /// Moves the lattice by `cells` along the axis, that is, the spins in the opposite direction, and
  /// waits for the kernels.
  template <class Exec>
  void move(Exec const& exec, Spins const& spins, std::int64_t cells);

  /// Returns by how many cells the lattice has moved since the start of the run.
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
