// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/rkmk4.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class Rotation>
using Standard = Rkmk4<Spins, SceneIsotropy, Rotation>;
template <class Spins, class Rotation>
using Body = Rkmk4<Spins, isotropy::Energy, Rotation>;
template <class Spins, class Rotation>
using Printed = Rkmk4AsPrinted<Spins, SceneIsotropy>;

struct Bodies : PlainFamily<Body>, OfRigidBodies {
  using OfRigidBodies::generator;
};
struct AsPrinted : LieFamily<Printed> {
  static constexpr bool exponential = false;
};

}  // namespace

MethodEntries rkmk4_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return together({plain_and_compensated<LieFamily<Standard>>({rkmk4}),
                   {Entry<Bodies>::make({rkmk4, energy, false, true}),
                    Entry<ProjectedToEnergy<Standard>>::make({rkmk4, energy}),
                    Entry<AsPrinted>::make({rkmk4_as_printed})}});
}

}  // namespace cayspin::program
