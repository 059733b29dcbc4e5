// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/cayspin.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#if defined(__linux__)
#include <unistd.h>
#endif

// STREAM's copy, the reference for memory speed: b = a on arrays much larger than the caches, once
// with ordinary stores and once with stores that bypass the caches. On a device both use ordinary
// stores.
namespace stream {

using Exec = Kokkos::DefaultExecutionSpace;
using Array = Kokkos::View<double*, Exec::memory_space>;

inline constexpr std::int64_t block = 4096;

/// Functor that copies `block` numbers per task on a host, one number on a device.
template <bool NonTemporal>
struct Copy {
  double const* from;
  double* to;

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    if constexpr (cayspin::detail::is_host_execution<Exec>) {
      using Pack = cayspin::detail::Pack<double>;
      constexpr int lanes = cayspin::detail::lanes_of<Pack>;
      for (std::int64_t i = task * block; i < (task + 1) * block; i += lanes) {
        Pack const value = cayspin::detail::load<Pack>(from + i);
        if constexpr (NonTemporal)
          cayspin::detail::store_streaming(value, to + i);
        else
          cayspin::detail::store(value, to + i);
      }
      if constexpr (NonTemporal) cayspin::detail::streaming_fence();
    } else {
      to[task] = from[task];
    }
  }
};

/// Returns four times the size of the third-level cache, but at least 256 MiB and at most 1 GiB.
inline std::int64_t array_bytes() {
  std::int64_t cache = 0;
#if defined(__linux__) && defined(_SC_LEVEL3_CACHE_SIZE)
  cache = sysconf(_SC_LEVEL3_CACHE_SIZE);
#endif
  return std::clamp(4 * cache, std::int64_t(256) << 20, std::int64_t(1) << 30);
}

/// The arrays, allocated by the first benchmark that runs.
struct Arrays {
  std::int64_t size = array_bytes() / 8 / block * block;
  Array from, to;

  void allocate() {
    if (from.is_allocated()) return;
    from = allocated("stream::from");
    to = allocated("stream::to");
  }

 private:
  Array allocated(std::string const& label) const {
    Array const array(Kokkos::view_alloc(Kokkos::WithoutInitializing, label), size);
    if constexpr (cayspin::detail::is_host_execution<Exec>)
      cayspin::detail::advise_huge_pages(array.data(), static_cast<std::size_t>(size) * 8);
    Kokkos::deep_copy(array, 1.0);
    return array;
  }
};

template <bool NonTemporal>
void run(benchmark::State& state, Arrays& arrays) {
  arrays.allocate();
  Exec const exec;
  std::int64_t const tasks =
      cayspin::detail::is_host_execution<Exec> ? arrays.size / block : arrays.size;
  Copy<NonTemporal> const copy{arrays.from.data(), arrays.to.data()};
  using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::int64_t>>;
  exec.fence();
  for (auto _ : state) {
    Kokkos::parallel_for("stream::copy", Policy(exec, 0, tasks), copy);
    exec.fence();
  }
  state.counters["GB/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(arrays.size) * 16e-9,
      benchmark::Counter::kIsRate);
}

inline void register_copies() {
  auto const arrays = std::make_shared<Arrays>();
  auto const add = [](char const* name, auto run) {
    benchmark::RegisterBenchmark(name, run)->UseRealTime()->Unit(benchmark::kMillisecond);
  };
  add("stream copy", [arrays](benchmark::State& state) { run<false>(state, *arrays); });
  add("stream copy, non-temporal",
      [arrays](benchmark::State& state) { run<true>(state, *arrays); });
}

}  // namespace stream
