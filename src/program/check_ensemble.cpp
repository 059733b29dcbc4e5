// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "check_ensemble.hpp"

#include "files/available_memory.hpp"
#include "io/relax.hpp"
#include "simulation/ensemble_plan.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

namespace cayspin::program {

std::optional<ReplicaTotals> replica_totals(io::Scene const& scene, io::Scene const& replica,
                                            Plan const& plan, Precision precision) {
  if (!scene.ensemble.there()) return std::nullopt;
  auto const replicas = scene.ensemble.replicas;
  ReplicaTotals totals{replicas, memory_of_replicas(replica, plan, precision, replicas),
                       file_bytes_of_ensemble(scene, replica, plan), std::nullopt};
  if (io::is_to_relax(replica)) return totals;
  if (auto const of_step = evaluations(replica, plan.variant))
    totals.evaluations = static_cast<double>(replicas) *
                         static_cast<double>(replica.integrator.steps) *
                         static_cast<double>(*of_step);
  return totals;
}

void add_totals(Json& object, ReplicaTotals const& totals) {
  object["replicas"] = totals.replicas;
  auto& all = object["all_replicas"];
  all["memory_bytes"] = bytes_json(totals.memory_bytes);
  all["file_bytes"] = bytes_json(totals.file_bytes);
  all["evaluations"] = totals.evaluations ? bytes_json(*totals.evaluations) : Json();
}

void print_totals(ReplicaTotals const& totals) {
  auto text = fmt::format("{} in all: {} of memory as separate runs", totals.replicas,
                          bytes_text(totals.memory_bytes));
  if (totals.evaluations)
    text += fmt::format(", {:.4g} evaluations of the field", *totals.evaluations);
  print("replicas", text);
  if (totals.memory_bytes > static_cast<double>(io::available_memory()))
    print("", "more memory than is available now, unless they are stepped together");
}

}  // namespace cayspin::program
