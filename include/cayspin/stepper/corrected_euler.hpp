// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/policies.hpp>
#include <cayspin/stepper/methods.hpp>
#include <cayspin/stepper/two_point.hpp>

// Geometric Euler with a sigma that raises the order of its energy error by one.
namespace cayspin::inline v0_2 {

/// With sigma from a forward difference; energy error of order 2, two evaluations.
template <class Spins, class Rotation>
class LieEuler<Spins, isotropy::FiniteDifference, Rotation>
    : public TwoPoint<Spins, detail::ForwardDifferenceMethod, isotropy::Zero, Rotation> {
 public:
  explicit LieEuler(Spins const& like, isotropy::FiniteDifference isotropy = {}, Rotation = {})
      : LieEuler::TwoPoint("LieEuler", like, {isotropy.cap}) {}
};

/// With sigma from a backward difference; energy error of order 2, one evaluation.
template <class Spins, class Rotation>
class LieEuler<Spins, isotropy::FiniteDifferenceBackward, Rotation>
    : public TwoPoint<Spins, detail::BackwardDifferenceMethod, isotropy::Zero, Rotation> {
 public:
  explicit LieEuler(Spins const& like, isotropy::FiniteDifferenceBackward isotropy = {},
                    Rotation = {})
      : LieEuler::TwoPoint("LieEuler", like, {{isotropy.cap}}) {}
};

}  // namespace cayspin::inline v0_2
