// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_high_order.hpp"

#include <cayspin/stepper/tableau.hpp>

namespace cayspin::program {

MethodEntries rkmk5_entries() {
  return HighOrder<tableau::Tsitouras5, tableau::DormandPrince5>::entries_with_compensation(
      io::Method::rkmk5, io::Method::projected_rk5);
}

}  // namespace cayspin::program
