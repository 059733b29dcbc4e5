// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "compile_terms_along_row.hpp"

namespace cayspin::simulation {

CAYSPIN_COMPILE_TERMS_ALONG_ROW(AddedTerms, float)
CAYSPIN_COMPILE_TERMS_ALONG_ROW(WholeTerms, float)

}  // namespace cayspin::simulation
