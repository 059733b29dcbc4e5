// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>

#include <array>
#include <cstddef>
#include <string>

// Sums and maxima over sites in double, in an order that depends on the lattice alone: lanes of a
// pack in a fixed tree, packs of a task in order, tasks in order. The result has the same bits on
// every host space and for any number of threads.
namespace cayspin::detail {

struct Sum {
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value combine(Value const& a, Value const& b) {
    return a + b;
  }
};

/// The larger one; NaN once there is a NaN. Of numbers that are not negative.
struct Maximum {
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value combine(Value const& a, Value const& b) {
    return select<Value>(b == b, select<Value>(a < b, b, a), b);
  }
};

template <class Combine, class Value>
KOKKOS_FORCEINLINE_FUNCTION double combine_lanes(Value const& value) {
  constexpr int lanes = lanes_of<Value>;
  if constexpr (lanes == 1) {
    return value;
  } else {
    double lane[lanes];
    store(value, lane);
    for (int half = lanes / 2; half > 0; half /= 2)
      for (int i = 0; i < half; ++i) lane[i] = Combine::combine(lane[i], lane[i + half]);
    return lane[0];
  }
}

/// Collects functor(site), Count values, over the sites of a task.
template <class Combine, int Count, class Functor, class Value>
struct Collect {
  Functor const& functor;
  Value total[Count];

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) {
    Value value[Count];
    functor(site, value);
    auto const is_site = Value(0.5) < site.inside();
    for (int i = 0; i < Count; ++i)
      total[i] = Combine::combine(total[i], select<Value>(is_site, value[i], Value(0.0)));
  }
};

template <class Value, class Combine, int Count, class Functor>
struct ReduceTask {
  Functor functor;
  RowLayout layout;
  std::int32_t per_row;
  double* partial;  // [task][Count]

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    Collect<Combine, Count, Functor, Value> collect{functor, {}};
    for (int i = 0; i < Count; ++i) collect.total[i] = Value(0.0);
    for_each_pack<Value>(layout, task, per_row, collect);
    for (int i = 0; i < Count; ++i)
      partial[task * Count + i] = combine_lanes<Combine>(collect.total[i]);
  }
};

/// Combines what functor(site, values) puts into values[0 .. Count) over all sites; waits.
template <class Combine, int Count, class Exec, class Functor>
std::array<double, Count> reduce_sites(Exec const& exec, std::string const& label,
                                       RowLayout const& layout, Functor const& functor) {
  using Value = std::conditional_t<is_host_execution<Exec>, Pack<double>, double>;
  std::int32_t const per_row = tasks_per_row(layout);
  std::int64_t const tasks = layout.rows() * per_row;
  Kokkos::View<double*, typename Exec::memory_space> const partial(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, label + "::partial"), tasks * Count);
  ReduceTask<Value, Combine, Count, Functor> const body{functor, layout, per_row, partial.data()};
  if constexpr (is_host_execution<Exec>) {
    for_each_task(exec, label, tasks, layout.sites(), body);
  } else {
    using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::int64_t>>;
    Kokkos::parallel_for(label, Policy(exec, 0, tasks), body);
  }
  auto const host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), partial);
  exec.fence(label);
  std::array<double, Count> total{};
  for (std::int64_t task = 0; task < tasks; ++task)
    for (int i = 0; i < Count; ++i) total[i] = Combine::combine(total[i], host(task * Count + i));
  return total;
}

}  // namespace cayspin::detail
