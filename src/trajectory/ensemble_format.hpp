// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>
#include <limits>

namespace cayspin::inline v0_2::io {

/// The attribute that identifies the file of an ensemble, and its value.
inline constexpr char const* ensemble_format = "ensemble_format";
inline constexpr std::int64_t ensemble_format_version = 1;

/// Datasets that frames have in addition to the scalars. Files of earlier versions lack both.
inline constexpr char const *sublattices_of_replicas = "sublattice_magnetization",
                            *checksum_of_replicas = "checksum";

/// Numbers that are read where a number or a step never reached the disk.
inline constexpr double missing_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double missing_step = -1;

}  // namespace cayspin::inline v0_2::io
