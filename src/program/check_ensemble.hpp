// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "check_text.hpp"

#include <cstdint>
#include <optional>

// Output of `cayspin check` about the replicas of an ensemble.
namespace cayspin::program {

/// The needs of all replicas of an ensemble together.
struct ReplicaTotals {
  std::int64_t replicas = 0;
  double memory_bytes = 0;  // if each replica is a separate run
  double file_bytes = 0;
  std::optional<double> evaluations;  // empty for searches and adaptive methods
};

/// Returns nothing for a scene without [ensemble]. `replica`, `plan`: those of one replica.
std::optional<ReplicaTotals> replica_totals(io::Scene const& scene, io::Scene const& replica,
                                            Plan const& plan, Precision precision);

void add_totals(Json& object, ReplicaTotals const& totals);
void print_totals(ReplicaTotals const& totals);

}  // namespace cayspin::program
