// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/lie_euler.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class Rotation>
using Euler = LieEuler<Spins, SceneIsotropy, Rotation>;

}  // namespace

MethodEntries euler_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<LieFamily<Euler>>::make({euler}),
          Entry<ProjectedToEnergy<Euler>>::make({euler, energy})};
}

}  // namespace cayspin::program
