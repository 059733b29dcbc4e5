// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/lie_heun.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class Rotation>
using Heun = LieHeun<Spins, SceneIsotropy, Rotation>;
template <class Spins, class Rotation>
using BodyHeun = LieHeun<Spins, isotropy::Energy, Rotation>;

struct Bodies : PlainFamily<BodyHeun>, OfRigidBodies {
  using OfRigidBodies::generator;
};

}  // namespace

MethodEntries heun_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<LieFamily<Heun>>::make({heun}), Entry<Bodies>::make({heun, energy, false, true}),
          Entry<ProjectedToEnergy<Heun>>::make({heun, energy})};
}

}  // namespace cayspin::program
