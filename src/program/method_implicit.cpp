// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/implicit.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class Rotation>
using ImplicitEuler = ImplicitLieEuler<Spins, SceneIsotropy, Rotation>;
template <class Spins, class Rotation>
using CorrectedEuler = ImplicitLieEuler<Spins, isotropy::Analytic, Rotation>;
template <class Spins, class Rotation>
using Midpoint = ImplicitMidpoint<Spins>;

struct Family : LieFamily<ImplicitEuler>, Unbounded {
  using Unbounded::Linear;
};
struct CorrectedFamily : LieFamily<CorrectedEuler>, Unbounded {
  using Unbounded::Linear;
  template <class Stepper, class Spins>
  static Stepper make(Spins const& like, MethodOptions const&) {
    return Stepper(like);
  }
};
struct MidpointFamily : PlainFamily<Midpoint>, Unbounded {
  using Unbounded::Linear;
};

}  // namespace

MethodEntries implicit_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<Family>::make({implicit_euler}),
          Entry<CorrectedFamily>::make({implicit_euler, analytic}),
          Entry<MidpointFamily>::make({implicit_midpoint})};
}

}  // namespace cayspin::program
