// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_adaptive.hpp"

#include <cayspin/stepper/classical.hpp>

namespace cayspin::program {

MethodEntries projected_entries() {
  using enum io::Method;
  using DormandPrince = Adaptive<tableau::DormandPrince5>;
  return {Entry<Baseline<ProjectedEuler>::Family>::make({projected_euler}),
          Entry<Baseline<ProjectedHeun>::Family>::make({projected_heun}),
          Entry<Baseline<ProjectedRk4>::Family>::make({projected_rk4}),
          Entry<DormandPrince::Plain<DormandPrince::InSpace>>::make({projected_dp5})};
}

}  // namespace cayspin::program
