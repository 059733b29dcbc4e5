// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_high_order.hpp"

#include <cayspin/stepper/tableau_dormand_prince8.hpp>

namespace cayspin::program {

MethodEntries rkmk8_entries() {
  return HighOrder<tableau::DormandPrince8, tableau::DormandPrince8>::entries(
      io::Method::rkmk8, io::Method::projected_rk8);
}

}  // namespace cayspin::program
