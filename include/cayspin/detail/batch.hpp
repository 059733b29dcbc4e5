// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>

#include <cstdint>
#include <string>
#include <tuple>

namespace cayspin::detail {

/// Several kernels over the sites of a small lattice, one after the other, `count` times.
template <class Real, class... Kernels>
struct RepeatKernels {
  std::tuple<RowLoop<Real, Kernels>...> kernels;
  std::int64_t tasks, count;

  void operator()(std::int64_t) const {
    for (std::int64_t i = 0; i < count; ++i)
      std::apply([&](auto const&... kernel) { (run(kernel), ...); }, kernels);
  }

 private:
  template <class Kernel>
  void run(Kernel const& kernel) const {
    for (std::int64_t task = 0; task < tasks; ++task) kernel(task);
  }
};

/// Launches them once, on the calling thread.
template <class Real, class... Kernels>
void repeat_on_calling_thread(std::string const& label, RowLayout const& layout, std::int64_t count,
                              std::tuple<Kernels...> const& kernels) {
#if defined(KOKKOS_ENABLE_SERIAL)
  std::int32_t const per_row = tasks_per_row(layout);
  RepeatKernels<Real, Kernels...> const body{
      std::apply(
          [&](auto const&... kernel) {
            return std::tuple(RowLoop<Real, Kernels>{kernel, layout, per_row}...);
          },
          kernels),
      layout.rows() * per_row, count};
  Kokkos::parallel_for(label, Kokkos::RangePolicy<Kokkos::Serial>(0, 1), body);
#endif
}

}  // namespace cayspin::detail
