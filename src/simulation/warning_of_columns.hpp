// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "precision.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace cayspin::simulation {

struct ColumnWarning {
  std::size_t column;
  std::string text;
};

/// Returns the warning about dt of one of the replicas with these values, if one has any. Only
/// those are asked whose steps may be the least accurate: the one with the most noise, and those
/// with the largest fields and dampings. `one`: the scene of any replica. Does not throw for a dt
/// that the scene refuses.
std::optional<ColumnWarning> warning_of_columns(io::Scene const& one, io::Columns const& values,
                                                Precision precision);

}  // namespace cayspin::simulation
