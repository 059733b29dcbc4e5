// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/real_dataset.hpp"

#include <cstdint>

namespace cayspin::io::detail {

/// Opens /inertia, which has to be (count, 3, 3). Throws std::runtime_error with one line.
RealDataset open_inertia(std::filesystem::path const& path, std::int64_t count);

}  // namespace cayspin::io::detail
