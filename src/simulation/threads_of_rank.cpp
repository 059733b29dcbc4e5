// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "threads_of_rank.hpp"

#include "kokkos_settings.hpp"

#if defined(__linux__)
#include <sched.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <type_traits>

namespace cayspin::simulation {

Cores cores_of_process() {
  Cores cores;
#if defined(__linux__)
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return cores;
  for (std::size_t core = 0; core < std::min<std::size_t>(cores.size(), CPU_SETSIZE); ++core)
    cores[core] = CPU_ISSET(core, &set);
#endif
  return cores;
}

int sharing_cores(std::vector<Cores> const& cores, std::size_t one) {
  return static_cast<int>(std::ranges::count_if(cores, [&](Cores const& other) {
    return cores[one].none() || other.none() || (cores[one] & other).any();
  }));
}

int cores_for_threads() {
  int const cores = expected_threads();
#if defined(KOKKOS_ENABLE_THREADS)
  // OpenMP counts only the cores to which a launcher has bound this process. Threads count all.
  if (std::is_same_v<Kokkos::DefaultHostExecutionSpace, Kokkos::Threads>)
    if (auto const own = cores_of_process(); own.any())
      return std::min(cores, static_cast<int>(own.count()));
#endif
  return cores;
}

std::optional<int> threads_of_rank(std::string const& space, int cores, int sharing) {
  bool const is_set = std::getenv("OMP_NUM_THREADS") || std::getenv("KOKKOS_NUM_THREADS");
  if (space == "serial" || is_set) return std::nullopt;
  return std::max(1, cores / sharing);
}

}  // namespace cayspin::simulation
