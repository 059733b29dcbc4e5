// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/policies.hpp>
#include <cayspin/stepper/methods.hpp>
#include <cayspin/stepper/two_point.hpp>

// Geometric Euler with a sigma that raises the order of the energy error from 1 to 2.
namespace cayspin::inline v0_2 {

/// Geometric Euler with sigma from a forward difference: the energy error is of order 2, and a step
/// takes two evaluations.
template <class Spins, class Rotation>
class LieEuler<Spins, isotropy::FiniteDifference, Rotation>
    : public TwoPoint<Spins, detail::ForwardDifferenceMethod, isotropy::Zero, Rotation> {
 public:
  explicit LieEuler(Spins const& like, isotropy::FiniteDifference isotropy = {}, Rotation = {})
      : LieEuler::TwoPoint("LieEuler", like, {isotropy.cap}) {}
};

/// Geometric Euler with sigma from a backward difference: the energy error is of order 2, and a
/// step takes one evaluation, the first step two.
template <class Spins, class Rotation>
class LieEuler<Spins, isotropy::FiniteDifferenceBackward, Rotation>
    : public TwoPoint<Spins, detail::BackwardDifferenceMethod, isotropy::Zero, Rotation> {
 public:
  explicit LieEuler(Spins const& like, isotropy::FiniteDifferenceBackward isotropy = {},
                    Rotation = {})
      : LieEuler::TwoPoint("LieEuler", like, {{isotropy.cap}}) {}
};

}  // namespace cayspin::inline v0_2
