// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "plan.hpp"

#include <cstdint>
#include <optional>

namespace cayspin::simulation {

/// Bytes of an open SceneRun that do not depend on the number of sites: its scene, method, guard
/// and terms. Measured as the growth of the resident memory per replica of one site, without the
/// memory of its plan: 42 to 68 kB, depending on the method and the terms.
inline constexpr std::int64_t bytes_of_open_run = 56'000;

/// Bytes of a replica in columns in addition to the memory of its lattice: its guard, its last
/// sample and the values in which replicas differ. Measured as the growth of the resident memory
/// per replica of one site.
inline constexpr std::int64_t bytes_of_column = 400;

/// Returns the bytes that replicas need if each is a separate run, with two copies of a frame.
/// `replica`, `plan`: those of one replica. A double, because the sum may exceed the range of an
/// integer.
double memory_of_replicas(io::Scene const& replica, Plan const& plan, Precision precision,
                          std::int64_t replicas);

/// Returns the bytes of the numbers in the file of an ensemble. `plan`: that of one replica.
double file_bytes_of_ensemble(io::Scene const& scene, io::Scene const& replica, Plan const& plan);

/// Throws io::SceneError if the replicas need more memory than is available. `needed`, `available`:
/// bytes of all replicas. If `available` is empty, the memory that is available now is taken.
void require_memory_of_replicas(io::Scene const& scene, double needed,
                                std::optional<std::int64_t> available = {});

}  // namespace cayspin::simulation
