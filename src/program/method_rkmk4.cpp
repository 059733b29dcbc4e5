// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/rkmk4.hpp>

namespace cayspin::program {
namespace {

struct Family : LieFamily {
  template <class Spins, class Rotation>
  using Stepper = Rkmk4<Spins, SceneIsotropy, Rotation>;
};

}  // namespace

MethodEntry rkmk4_entry() { return RungeKuttaEntry<Family>::make(io::Method::rkmk4); }

}  // namespace cayspin::program
