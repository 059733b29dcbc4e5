// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "handle.hpp"

#include <filesystem>

namespace cayspin::io {

/// Opens an existing file for reading.
FileHandle open_file(std::filesystem::path const& path);

}  // namespace cayspin::io
