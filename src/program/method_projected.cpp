// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/classical.hpp>

namespace cayspin::program {

MethodEntry projected_euler_entry() {
  return RungeKuttaEntry<BaselineFamily<ProjectedEuler>>::make(io::Method::projected_euler);
}

MethodEntry projected_heun_entry() {
  return RungeKuttaEntry<BaselineFamily<ProjectedHeun>>::make(io::Method::projected_heun);
}

MethodEntry projected_rk4_entry() {
  return RungeKuttaEntry<BaselineFamily<ProjectedRk4>>::make(io::Method::projected_rk4);
}

}  // namespace cayspin::program
