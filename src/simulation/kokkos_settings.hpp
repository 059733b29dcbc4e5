// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

namespace cayspin::simulation {

/// Returns the name of an execution space: openmp, serial, cuda, ...
template <class Space>
std::string space_name() {
  std::string name = Space::name();
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

/// Returns true if `word` names this space. "serial" names any host space, which then runs with one
/// thread.
template <class Space>
bool has_name(std::string const& word) {
  return word == space_name<Space>() ||
         (word == "serial" && cayspin::detail::is_host_execution<Space>);
}

/// Returns true if `space` is the name of a host execution space.
bool is_on_host(std::string const& space);

/// Returns the requested name, or that of Kokkos' default space. Throws UsageError for a space
/// that is not compiled in, and for "serial" if Kokkos already runs with more than one thread.
std::string chosen_space(std::optional<std::string> const& asked);
/// Throws UsageError for "serial" with another number of threads than one.
void require_threads(std::string const& space, std::optional<int> threads);

/// Returns the number of threads of `exec`; 1 on devices.
template <class Space>
int threads_of(Space const& exec) {
  return cayspin::detail::is_host_execution<Space> ? exec.concurrency() : 1;
}
/// Returns the number of threads of the default host space; before Kokkos starts, the number that
/// it is likely to use by default.
int expected_threads();

/// Scope in which Kokkos is initialised.
class KokkosSession {
 public:
  /// Throws UsageError if the device does not exist, if a device is given with a host space, and
  /// for "serial" with more than one thread.
  KokkosSession(std::string const& space, std::optional<int> threads, std::optional<int> device);
  ~KokkosSession() { Kokkos::finalize(); }
  KokkosSession(KokkosSession const&) = delete;
  KokkosSession& operator=(KokkosSession const&) = delete;
};

}  // namespace cayspin::simulation
