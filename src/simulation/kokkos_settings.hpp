// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

namespace cayspin::simulation {

/// The word for an execution space: openmp, serial, cuda, ...
template <class Space>
std::string space_name() {
  std::string name = Space::name();
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

/// Is this a word for the space? "serial" is the host's space with one thread.
template <class Space>
bool has_name(std::string const& word) {
  return word == space_name<Space>() ||
         (word == "serial" && cayspin::detail::is_host_execution<Space>);
}

/// Is it a host's execution space?
bool is_on_host(std::string const& space);

/// The word asked for, or Kokkos' default. Throws UsageError when it is not compiled in, and for
/// "serial" where Kokkos already runs with more threads.
std::string chosen_space(std::optional<std::string> const& asked);

/// 1 on devices.
template <class Space>
int threads_of(Space const& exec) {
  return cayspin::detail::is_host_execution<Space> ? exec.concurrency() : 1;
}
/// Threads of the default space on hosts: how many there are, or will be by default.
int expected_threads();

/// Kokkos, from here to the end of the scope.
class KokkosSession {
 public:
  /// Throws UsageError for a device that there is not, and for one of a host's space.
  KokkosSession(std::string const& space, std::optional<int> threads, std::optional<int> device);
  ~KokkosSession() { Kokkos::finalize(); }
  KokkosSession(KokkosSession const&) = delete;
  KokkosSession& operator=(KokkosSession const&) = delete;
};

}  // namespace cayspin::simulation
