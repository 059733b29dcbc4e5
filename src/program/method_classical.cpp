// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/classical.hpp>

namespace cayspin::program {

MethodEntry classical_euler_entry() {
  return RungeKuttaEntry<BaselineFamily<ClassicalEuler>>::make(io::Method::classical_euler);
}

MethodEntry classical_heun_entry() {
  return RungeKuttaEntry<BaselineFamily<ClassicalHeun>>::make(io::Method::classical_heun);
}

MethodEntry classical_rk4_entry() {
  return RungeKuttaEntry<BaselineFamily<ClassicalRk4>>::make(io::Method::classical_rk4);
}

}  // namespace cayspin::program
