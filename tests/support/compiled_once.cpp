// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#define CAYSPIN_TEST_COMPILES
#include "compiled_once.hpp"
