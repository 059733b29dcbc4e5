// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_adaptive.hpp"

namespace cayspin::program {

MethodEntries dormand_prince_entries() {
  return adaptive_entries<tableau::DormandPrince5>(io::Method::dp5);
}

}  // namespace cayspin::program
