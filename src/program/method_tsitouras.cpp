// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_adaptive.hpp"

namespace cayspin::program {

MethodEntries tsitouras_entries() {
  return adaptive_entries<tableau::Tsitouras5>(io::Method::tsit5);
}

}  // namespace cayspin::program
