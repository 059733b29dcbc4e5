// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "method_entry.hpp"

#include <cayspin/stepper/adaptive_runge_kutta.hpp>
#include <cayspin/stepper/tableau.hpp>

namespace cayspin::program {

/// Families of the methods that choose their steps, by embedded tableau.
template <class Embedded>
struct Adaptive {
  template <class Spins, class Rotation>
  using OnGroup = AdaptiveRkmk<Spins, Embedded, SceneIsotropy, Rotation>;
  template <class Spins, class>
  using OnChart = AdaptiveStereographic<Spins, Embedded>;
  template <class Spins, class>
  using InSpace = AdaptiveProjected<Spins, Embedded>;

  struct Group : LieFamily<OnGroup> {
    template <class, class>
    using Linear = void;
    template <class Stepper, class Spins>
    static Stepper make(Spins const& like, MethodOptions const& options) {
      return Stepper(like, options.steps, SceneIsotropy{options.sigma});
    }
  };
  template <template <class, class> class Stepper>
  struct Plain : PlainFamily<Stepper> {
    template <class, class>
    using Linear = void;
    template <class Made, class Spins>
    static Made make(Spins const& like, MethodOptions const& options) {
      return Made(like, options.steps);
    }
  };
};

template <class Embedded>
MethodEntries adaptive_entries(io::Method method) {
  using Of = Adaptive<Embedded>;
  return {Entry<typename Of::Group>::make({method}),
          Entry<typename Of::template Plain<Of::template OnChart>>::make(
              {method, io::Isotropy::zero, true})};
}

}  // namespace cayspin::program
