// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ensemble_plan.hpp"

#include "files/available_memory.hpp"
#include "io/relax.hpp"
#include "run_files.hpp"
#include "text.hpp"

#include <fmt/format.h>

namespace cayspin::simulation {

double memory_of_replicas(io::Scene const& replica, Plan const& plan, Precision precision,
                          std::int64_t replicas) {
  std::int64_t const number = precision == Precision::double_precision ? 8 : 4;
  std::int64_t const frame = 3 * number * plan.lattice.sites();
  auto const text = static_cast<std::int64_t>(replica.text.size());
  // Replicas read their starts one after another, and only whole ensembles write frames.
  auto const of_replica = plan.memory.simulation() + bytes_of_open_run + text + 2 * frame;
  return static_cast<double>(replicas) * static_cast<double>(of_replica) +
         static_cast<double>(plan.memory.files);
}

double file_bytes_of_ensemble(io::Scene const& scene, io::Scene const& replica, Plan const& plan) {
  bool const relaxes = io::is_to_relax(replica);
  auto const samples =
      relaxes ? plan.frames : frames_of(replica.integrator.steps, replica.output.scalars_every);
  auto const replicas = static_cast<double>(scene.ensemble.replicas);
  // Positions, and the time and step of each frame and sample, are those of all replicas.
  auto const once = static_cast<double>(position_bytes(replica.lattice)) +
                    16 * (static_cast<double>(plan.frames) + static_cast<double>(samples));
  auto const of_varied_keys = 8 * static_cast<double>(scene.ensemble.vary.size());
  double const of_searches = relaxes ? 24 : 0;
  return once + replicas * (plan.file_bytes - once + of_varied_keys + of_searches);
}

void require_memory_of_replicas(io::Scene const& scene, double needed,
                                std::optional<std::int64_t> available) {
  auto const found = available ? *available : io::available_memory();
  if (needed <= static_cast<double>(found)) return;
  throw io::scene_error(
      scene, "ensemble.replicas",
      fmt::format("the run needs {} of memory, and {} is available; accepted: fewer replicas, a "
                  "smaller lattice, single precision, or a run on more ranks",
                  bytes_text(needed), bytes_text(found)));
}

}  // namespace cayspin::simulation
