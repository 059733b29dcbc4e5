// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <bitset>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation {

/// The cores on which a process may run, one bit for each; no bit if the system does not say.
using Cores = std::bitset<1024>;

Cores cores_of_process();

/// Returns how many of the processes on a machine may run on a core of process number `one`,
/// including that process. `cores`: those of each process.
int sharing_cores(std::vector<Cores> const& cores, std::size_t one);

/// Returns the number of cores on which a rank may start threads, before Kokkos starts.
int cores_for_threads();

/// Returns the number of threads of one of several ranks, of which `sharing` use the same `cores`
/// cores. Returns nothing if Kokkos decides: in the space "serial", and if OMP_NUM_THREADS or
/// KOKKOS_NUM_THREADS is set.
std::optional<int> threads_of_rank(std::string const& space, int cores, int sharing);

}  // namespace cayspin::simulation
