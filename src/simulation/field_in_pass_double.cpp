// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "compile_field_in_pass.hpp"

namespace cayspin::simulation {

CAYSPIN_FOR_EACH_SPACE(CAYSPIN_COMPILE_FIELD_IN_PASS, double)

}  // namespace cayspin::simulation
