// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/lie_euler.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class Rotation>
using AnalyticEuler = LieEuler<Spins, isotropy::Analytic, Rotation>;
template <class Spins, class Rotation>
using ForwardEuler = LieEuler<Spins, isotropy::FiniteDifference, Rotation>;
template <class Spins, class Rotation>
using BackwardEuler = LieEuler<Spins, isotropy::FiniteDifferenceBackward, Rotation>;

template <template <class, class> class StepperOf>
struct Family : LieFamily<StepperOf>, Unbounded {
  using Unbounded::Linear;
  template <class Stepper, class Spins>
  static Stepper make(Spins const& like, MethodOptions const& options) {
    if constexpr (std::is_constructible_v<Stepper, Spins, isotropy::Analytic>)
      return Stepper(like, isotropy::Analytic{});
    else
      return Stepper(like, {options.cap});
  }
};

}  // namespace

MethodEntries corrected_euler_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<Family<AnalyticEuler>>::make({euler, analytic}),
          Entry<Family<ForwardEuler>>::make({euler, finite_difference}),
          Entry<Family<BackwardEuler>>::make({euler, finite_difference_backward})};
}

}  // namespace cayspin::program
