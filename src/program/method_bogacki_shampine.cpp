// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_adaptive.hpp"

namespace cayspin::program {

MethodEntries bogacki_shampine_entries() {
  return adaptive_entries<tableau::BogackiShampine3>(io::Method::bs3);
}

}  // namespace cayspin::program
