// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "kokkos_settings.hpp"

#include "denormals.hpp"
#include "failure.hpp"
#include "simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <type_traits>

namespace cayspin::simulation {

bool is_on_host(std::string const& space) {
  return space == "serial" || space == "openmp" || space == "threads";
}

void require_threads(std::string const& space, std::optional<int> threads) {
  if (space == "serial" && threads && *threads != 1)
    throw UsageError(
        fmt::format("--threads {}: --space serial has one thread; accepted: 1", *threads));
}

namespace {

Kokkos::InitializationSettings settings(std::string const& space, std::optional<int> threads,
                                        std::optional<int> device) {
  Kokkos::InitializationSettings settings;
  settings.set_disable_warnings(true);
  require_threads(space, threads);
  if (space == "serial") threads = 1;
  if (threads) settings.set_num_threads(*threads);
  if (!device) return settings;
  int const devices = Kokkos::num_devices();
  if (devices < 1)
    throw UsageError(
        fmt::format("--device {}: there is no device, or no backend for one is compiled in; "
                    "accepted: no --device",
                    *device));
  if (is_on_host(space))
    throw UsageError(fmt::format("--device {}: --space {} is on the host; accepted: no --device",
                                 *device, space));
  if (*device >= devices)
    throw UsageError(fmt::format("--device {}: accepted: {}", *device,
                                 devices == 1 ? "0" : fmt::format("0 to {}", devices - 1)));
  settings.set_device_id(*device);
  return settings;
}

}  // namespace

int expected_threads() {
  if (Kokkos::is_initialized()) return Kokkos::DefaultHostExecutionSpace().concurrency();
#if defined(KOKKOS_ENABLE_OPENMP)
  if (std::is_same_v<Kokkos::DefaultHostExecutionSpace, Kokkos::OpenMP>)
    return omp_get_max_threads();
#endif
  int const all = static_cast<int>(std::thread::hardware_concurrency());
  bool serial = false;
#if defined(KOKKOS_ENABLE_SERIAL)
  serial = std::is_same_v<Kokkos::DefaultHostExecutionSpace, Kokkos::Serial>;
#endif
  return serial ? 1 : std::max(1, all);
}

std::string chosen_space(std::optional<std::string> const& asked) {
  if (!asked) return space_name<Kokkos::DefaultExecutionSpace>();
  std::string names;
  bool known = false;
  EnabledSpaces::for_each([&]<class Space>() {
    auto const name = space_name<Space>();
    known = known || has_name<Space>(*asked);
    names += (names.empty() ? "" : ", ") + name;
    if (name != "serial" && has_name<Space>("serial")) names += ", serial";
  });
  if (!known)
    throw UsageError(fmt::format("--space {}: not compiled in; accepted: {}", *asked, names));
  if (int const threads = expected_threads();
      *asked == "serial" && Kokkos::is_initialized() && threads > 1)
    throw UsageError(
        fmt::format("--space serial: Kokkos runs with {} threads; accepted: one thread", threads));
  return *asked;
}

KokkosSession::KokkosSession(std::string const& space, std::optional<int> threads,
                             std::optional<int> device) {
  FlushDenormals const inherited_by_threads;
  Kokkos::initialize(settings(space, threads, device));
}

}  // namespace cayspin::simulation
