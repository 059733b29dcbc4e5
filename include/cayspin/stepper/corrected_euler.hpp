// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/policies.hpp>
#include <cayspin/stepper/methods.hpp>
#include <cayspin/stepper/two_point.hpp>

#include <stdexcept>

// Geometric Euler with a sigma that raises the order of the energy error from 1 to 2.
namespace cayspin::inline v0_2 {

namespace detail {

/// Returns the cap of an isotropy; throws std::invalid_argument when it is negative or NaN.
inline double checked_cap(double cap) {
  if (!(cap >= 0))
    throw std::invalid_argument(
        "cayspin::LieEuler: the cap on |dt * sigma| is negative or not a number; accepted: 0 or "
        "more");
  return cap;
}

}  // namespace detail

/// Geometric Euler with sigma from a forward difference: the energy error is of order 2, and a step
/// takes two evaluations. Throws std::invalid_argument for a cap that is negative or NaN.
template <class Spins, class Rotation>
class LieEuler<Spins, isotropy::FiniteDifference, Rotation>
    : public TwoPoint<Spins, detail::ForwardDifferenceMethod, isotropy::Zero, Rotation> {
 public:
  explicit LieEuler(Spins const& like, isotropy::FiniteDifference isotropy = {}, Rotation = {})
      : LieEuler::TwoPoint("LieEuler", like, {detail::checked_cap(isotropy.cap)}) {}
};

/// Geometric Euler with sigma from a backward difference: the energy error is of order 2, and a
/// step takes one evaluation, the first step two. Throws std::invalid_argument for a cap that is
/// negative or NaN.
template <class Spins, class Rotation>
class LieEuler<Spins, isotropy::FiniteDifferenceBackward, Rotation>
    : public TwoPoint<Spins, detail::BackwardDifferenceMethod, isotropy::Zero, Rotation> {
 public:
  explicit LieEuler(Spins const& like, isotropy::FiniteDifferenceBackward isotropy = {},
                    Rotation = {})
      : LieEuler::TwoPoint("LieEuler", like, {{detail::checked_cap(isotropy.cap)}}) {}
};

}  // namespace cayspin::inline v0_2
