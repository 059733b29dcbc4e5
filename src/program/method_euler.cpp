// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/lie_euler.hpp>

namespace cayspin::program {
namespace {

struct Family : LieFamily {
  template <class Spins, class Rotation>
  using Stepper = LieEuler<Spins, SceneIsotropy, Rotation>;
};

}  // namespace

MethodEntry euler_entry() { return RungeKuttaEntry<Family>::make(io::Method::euler); }

}  // namespace cayspin::program
