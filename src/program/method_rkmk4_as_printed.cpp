// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/rkmk4.hpp>

namespace cayspin::program {
namespace {

struct Family : LieFamily {
  static constexpr bool exponential = false;
  template <class Spins, class>
  using Stepper = Rkmk4AsPrinted<Spins, SceneIsotropy>;
};

}  // namespace

MethodEntry rkmk4_as_printed_entry() {
  return RungeKuttaEntry<Family>::make(io::Method::rkmk4_as_printed);
}

}  // namespace cayspin::program
