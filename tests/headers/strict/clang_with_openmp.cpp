// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Compiles only with a compiler suitable for the test headers_clang.
#include <omp.h>

#if !defined(__clang__) || __clang_major__ < 14
#error not clang 14 or newer
#endif
