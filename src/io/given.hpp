// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <memory>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Numbers that a program passes with the text of a scene; those of sites have x fastest.
using GivenNumbers = std::shared_ptr<std::vector<double> const>;

}  // namespace cayspin::inline v0_2::io
