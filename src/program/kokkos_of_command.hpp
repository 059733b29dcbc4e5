// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/kokkos_settings.hpp"

#include <optional>
#include <string>

namespace cayspin::program {

/// Scope in which a command uses Kokkos. Initialises Kokkos unless this process is the worker of a
/// sweep, which has done so for all its commands: a process can initialise Kokkos only once.
class KokkosOfCommand {
 public:
  /// Throws like KokkosSession.
  KokkosOfCommand(std::string const& space, std::optional<int> threads, std::optional<int> device) {
    if (!Kokkos::is_initialized()) session_.emplace(space, threads, device);
  }

 private:
  std::optional<simulation::KokkosSession> session_;
};

}  // namespace cayspin::program
