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

/// Returns a replica's warning about dt, if one of the replicas with these values has any. Only
/// replicas whose steps may be the least accurate are checked: the one with the most noise, and
/// those with the largest fields and dampings. `one`: the scene of any replica. If the scene sets
/// refuse_unstable, the warning is returned, too, and not thrown.
std::optional<ColumnWarning> warning_of_columns(io::Scene const& one, io::Columns const& values,
                                                Precision precision);

}  // namespace cayspin::simulation
