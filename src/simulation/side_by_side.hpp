// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "kokkos_settings.hpp"

#include <cayspin/detail/execution.hpp>

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace cayspin::simulation {

template <class Work>
struct WorkByNumber {
  Work const& work;
  void operator()(std::int64_t number) const {
    cayspin::detail::KernelsStayOnThread const stay;
    work(static_cast<std::size_t>(number));
  }
};

/// Calls work(0) .. work(count - 1), each of which uses a run of at most `sites` sites in `space`.
/// On a host the calls are spread over its threads, and the kernels of a run stay on its thread, if
/// `always`, or if kernels over so few sites do so anyway. Otherwise the calls follow one another.
/// A run notices an interrupt only after a batch of up to 1000 steps on its thread, so `always`
/// suits only fields that fit into a cache.
template <class Work>
void for_each_run(std::string const& space, std::int64_t sites, bool always, std::size_t count,
                  Work const& work) {
  using Host = Kokkos::DefaultHostExecutionSpace;
  Host const host;
  bool const has_one_thread = host.concurrency() == 1;
  if (count > 1 && is_on_host(space) && !has_one_thread &&
      (always || cayspin::detail::runs_on_calling_thread<Host>(sites))) {
    // Uses another instance of the execution space. The runs fence the default instance, and a
    // kernel on that instance would keep it locked.
    auto const other = Kokkos::Experimental::partition_space(host, 1).front();
    Kokkos::parallel_for("cayspin::advance_all",
                         Kokkos::RangePolicy<Host, Kokkos::Schedule<Kokkos::Dynamic>,
                                             Kokkos::IndexType<std::int64_t>>(
                             other, 0, static_cast<std::int64_t>(count), Kokkos::ChunkSize(1)),
                         WorkByNumber<Work>{work});
    return;
  }
  std::optional<cayspin::detail::KernelsStayOnThread> stay;
  if (always && has_one_thread) stay.emplace();
  for (std::size_t number = 0; number < count; ++number) work(number);
}

}  // namespace cayspin::simulation
