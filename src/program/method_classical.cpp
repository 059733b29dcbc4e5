// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/classical.hpp>

namespace cayspin::program {

MethodEntries classical_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<Baseline<ClassicalEuler>::Family>::make({classical_euler}),
          Entry<Baseline<ClassicalHeun>::Family>::make({classical_heun}),
          Entry<Baseline<ClassicalRk4>::Family>::make({classical_rk4})};
}

}  // namespace cayspin::program
