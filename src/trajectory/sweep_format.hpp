// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/dataset.hpp"
#include "hdf5/handle.hpp"

namespace cayspin::inline v0_1::io {

inline constexpr char const* sweep_format = "sweep_format";
inline constexpr int sweep_format_version = 1;

}  // namespace cayspin::inline v0_1::io
