// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <mpi.h>

#include <span>
#include <thread>

namespace cayspin::inline v0_2::mpi::detail {

/// Waits for requests. After a thousand tries it yields to other threads: MPI's own waiting
/// occupies a core, which is slow if ranks share cores.
inline void wait_for(std::span<MPI_Request> requests) {
  constexpr int patience = 1000;
  for (int tries = 0;;) {
    int done = 0;
    MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
    if (done) return;
    if (tries < patience)
      ++tries;
    else
      std::this_thread::yield();
  }
}

}  // namespace cayspin::inline v0_2::mpi::detail
