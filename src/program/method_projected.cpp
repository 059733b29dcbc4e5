// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_adaptive.hpp"

#include <cayspin/stepper/classical.hpp>

namespace cayspin::program {

MethodEntries projected_entries() {
  using enum io::Method;
  using DormandPrince = Adaptive<tableau::DormandPrince5>;
  return together({{Entry<Baseline<ProjectedEuler>::Family>::make({projected_euler}),
                    Entry<Baseline<ProjectedHeun>::Family>::make({projected_heun})},
                   plain_and_compensated<Baseline<ProjectedRk4>::Family>({projected_rk4}),
                   {Entry<DormandPrince::Plain<DormandPrince::InSpace>>::make({projected_dp5})}});
}

}  // namespace cayspin::program
