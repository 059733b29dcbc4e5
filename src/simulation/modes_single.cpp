// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "compile_modes.hpp"

namespace cayspin::simulation {

CAYSPIN_FOR_EACH_SPACE(CAYSPIN_COMPILE_MODES, float)

}  // namespace cayspin::simulation
