// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "table.hpp"

#include <string>
#include <vector>

namespace cayspin::extremes {

/// All tables of docs/reports/extremes.md but the last. They are computed once.
std::vector<Table> const& tables();

/// The last one, in minutes.
Table table_of_longest_runs();

/// The page up to the last table.
std::string page_of_tables();

}  // namespace cayspin::extremes
