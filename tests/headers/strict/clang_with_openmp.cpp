// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Accepted by a compiler that can take the test headers_clang.
#include <omp.h>

#if !defined(__clang__) || __clang_major__ < 14
#error not clang 14 or newer
#endif
