// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/classical.hpp>

namespace cayspin::program {

MethodEntries projected_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<Baseline<ProjectedEuler>::Family>::make({projected_euler}),
          Entry<Baseline<ProjectedHeun>::Family>::make({projected_heun}),
          Entry<Baseline<ProjectedRk4>::Family>::make({projected_rk4})};
}

}  // namespace cayspin::program
