// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "table.hpp"

#include <string>
#include <vector>

namespace cayspin::extremes {

/// Returns all tables of docs/reports/extremes_tables.md but the last. They are computed once.
std::vector<Table> const& tables();

/// Returns the last table; takes minutes.
Table table_of_longest_runs();

/// Returns the page up to the last table.
std::string page_of_tables();

}  // namespace cayspin::extremes
