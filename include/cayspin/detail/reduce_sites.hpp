// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/exact_sum.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/part.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

// Sums and maxima over sites, in double. On host spaces each row, or piece of a long row, is summed
// in a fixed order: first the packs at the ends of the row, then those between them, and finally
// the lanes of the sum in a fixed tree. The sums of rows are added without round-off. So the result
// is bitwise the same on any host space, for any number of threads and for any division of a
// lattice into parts. Devices sum with twice the digits of a double, in an order of their own.
namespace cayspin::inline v0_2::detail {

// The types below say how the Count values of each site are reduced: the first sums<Count> of them
// are summed over the sites, and for the others the maximum over the sites is found.
struct Sum {
  template <int Count>
  static constexpr int sums = Count;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value combine(Value const& a, Value const& b) {
    return a + b;
  }
};

/// The largest value, at least 0; NaN if any value is NaN.
struct Maximum {
  template <int Count>
  static constexpr int sums = 0;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value combine(Value const& a, Value const& b) {
    return select<Value>(b == b, select<Value>(a < b, b, a), b);
  }
};

template <int Sums>
struct SumsThenMaxima {
  template <int Count>
  static constexpr int sums = Sums;
};

template <class Combine, class Value>
KOKKOS_FORCEINLINE_FUNCTION double combine_lanes(Value const& value) {
  constexpr int lanes = lanes_of<Value>;
  if constexpr (lanes == 1) {
    return value;
  } else {
    double lane[std::size_t{lanes}];
    store(value, lane);
    for (int half = lanes / 2; half > 0; half /= 2)
      for (int i = 0; i < half; ++i) lane[i] = Combine::combine(lane[i], lane[i + half]);
    return lane[0];
  }
}

/// Functor that accumulates, over sites, the Count values that functor(site, values) writes.
template <class Combine, int Count, class Functor, class Value>
struct Collect {
  Functor const& functor;
  Value total[std::size_t{Count}];

  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site<Value> const& site) {
    Value value[std::size_t{Count}];
    functor(site, value);
    if (site.is_partial()) [[unlikely]] {
      auto const is_site = site.inside();
      unrolled<Count>([&](auto i) { value[i()] = select<Value>(is_site, value[i()], Value(0.0)); });
    }
    unrolled<Count>([&](auto i) {
      using One = std::conditional_t<(i() < Combine::template sums<Count>), Sum, Maximum>;
      total[i()] = One::combine(total[i()], value[i()]);
    });
  }
};

/// Each row is cut into per_row pieces. Calls functor(site) for the packs of piece task % per_row
/// of row task / per_row, where rows are counted without ghosts: first for the packs at the ends of
/// the row, then for the others in order.
template <class Value, class Functor>
void for_each_pack_ends_first(RowLayout const& layout, std::int64_t task, std::int32_t per_row,
                              Functor& functor) {
  constexpr std::int32_t lanes = lanes_of<Value>;
  Row const row = row_of(layout, layout.own, task / per_row);
  std::int32_t const packs = (layout.nx + lanes - 1) / lanes;
  auto const cut = [&](std::int64_t part) {
    return static_cast<std::int32_t>(packs * part / per_row);
  };
  std::int32_t const begin = cut(task % per_row), end = cut(task % per_row + 1);
  std::int32_t const last = packs - 1;
  // Both ends share one compiled loop body.
  CAYSPIN_DETAIL_NOT_UNROLLED
  for (std::int32_t pack = 0; pack <= last; pack = Kokkos::max(last, pack + 1))
    if (begin <= pack && pack < end) functor(Site<Value>(row, pack * lanes));
  for (std::int32_t pack = Kokkos::max(begin, 1); pack < Kokkos::min(end, last); ++pack)
    functor(Site<Value>(row, pack * lanes));
}

/// A sum with twice the digits of a double, held as two doubles. Knuth's formula gives the rounding
/// error of each addition.
struct DoubledSum {
  double value = 0, error = 0;

  KOKKOS_FORCEINLINE_FUNCTION void add(double number) {
    double const sum = value + number, part = sum - value;
    error += (value - (sum - part)) + (number - part);
    value = sum;
  }
  KOKKOS_FORCEINLINE_FUNCTION void add(DoubledSum const& other) {
    add(other.value);
    error += other.error;
  }
};

/// Totals to which the threads, and then the parts of a lattice, add their sums and maxima.
template <int Sums, int Maxima>
struct Totals {
  std::array<ExactSum, std::size_t{Sums}> sums;
  std::array<std::int64_t, std::size_t{Maxima}> maxima{};  // bits of numbers >= 0, or of NaN

  void add(double const* values) {
    for (ExactSum& sum : sums) sum.add(*values++);
  }
  void add(DoubledSum const* doubled) {
    for (ExactSum& sum : sums) {
      sum.add(doubled->value);
      if (std::isfinite(doubled->value)) sum.add(doubled->error);
      ++doubled;
    }
  }
  void include(double const* values) {
    for (std::int64_t& maximum : maxima)
      maximum = std::max(maximum, std::bit_cast<std::int64_t>(std::abs(*values++)));
  }
  void include_atomically(Totals& other) {
    auto* sum_there = other.sums.data();
    for (ExactSum& sum : sums) sum.add_atomically(*sum_there++);
    auto const* maximum_there = other.maxima.data();
    for (std::int64_t& maximum : maxima) Kokkos::atomic_max(&maximum, *maximum_there++);
  }
  void include_parts(Part const& part) {
    std::array<std::int64_t, std::size_t{Sums * ExactSum::words}> words;
    auto* at = words.data();
    for (ExactSum& sum : sums) {
      sum.carry();
      at = std::copy_n(sum.data(), ExactSum::words, at);
    }
    if constexpr (Sums > 0) part.sum(words);
    if constexpr (Maxima > 0) part.maximum(maxima);
    auto const* from = words.data();
    for (ExactSum& sum : sums) {
      std::copy_n(from, ExactSum::words, sum.data());
      from += ExactSum::words;
    }
  }
  std::array<double, std::size_t{Sums + Maxima}> values() {
    std::array<double, std::size_t{Sums + Maxima}> values;
    auto* at = values.data();
    for (ExactSum& sum : sums) *at++ = sum.rounded();
    for (std::int64_t const maximum : maxima) *at++ = std::bit_cast<double>(maximum);
    return values;
  }
};

template <class Combine, int Count>
using TotalsOf = Totals<Combine::template sums<Count>, Count - Combine::template sums<Count>>;

template <class Combine, int Count, class Functor>
struct ReduceBlock {
  static constexpr int sums = Combine::template sums<Count>;
  Functor functor;
  RowLayout layout;
  std::int32_t per_row;
  std::int64_t tasks, blocks;
  TotalsOf<Combine, Count>* total;

  CAYSPIN_DETAIL_NOINLINE void operator()(std::int64_t block) const {
    using Value = Pack<double>;
    Functor const local = functor;
    std::optional<TotalsOf<Combine, Count>> of_block;
    auto& totals = blocks == 1 ? *total : of_block.emplace();
    Collect<Combine, Count, Functor, Value> collect{local, {}};
    for (int i = sums; i < Count; ++i) collect.total[i] = Value(0.0);
    double values[std::size_t{Count}];
    std::int64_t const end = tasks * (block + 1) / blocks;
    for (std::int64_t task = tasks * block / blocks; task < end; ++task) {
      for (int i = 0; i < sums; ++i) collect.total[i] = Value(0.0);
      for_each_pack_ends_first<Value>(layout, task, per_row, collect);
      for (int i = 0; i < sums; ++i) values[i] = combine_lanes<Sum>(collect.total[i]);
      totals.add(values);
    }
    for (int i = sums; i < Count; ++i) values[i] = combine_lanes<Maximum>(collect.total[i]);
    totals.include(values + sums);
    if (of_block) total->include_atomically(totals);
  }
};

/// Functor for Kokkos' reduction on devices. The device determines the order of the sum, which is
/// the same in each call.
template <class Combine, int Count, class Functor>
struct ReduceOnDevice {
  static constexpr int sums = Combine::template sums<Count>, maxima = Count - sums;
  struct value_type {
    // An array must not be empty.
    DoubledSum sum[std::size_t{sums > 0 ? sums : 1}];
    double maximum[std::size_t{maxima > 0 ? maxima : 1}];
  };
  Functor functor;
  DeviceLayout<std::int64_t> layout;
  DeviceTiles tiles;

  KOKKOS_FUNCTION void operator()(std::int64_t thread, value_type& total) const {
    tiles.for_each(thread, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
      double value[std::size_t{Count}];
      functor(DeviceSite<double, std::int64_t>(layout, x, y, z), value);
      for (int i = 0; i < sums; ++i) total.sum[i].add(value[i]);
      for (int i = 0; i < maxima; ++i)
        total.maximum[i] = Maximum::combine(total.maximum[i], value[sums + i]);
    });
  }
  KOKKOS_FUNCTION void init(value_type& total) const { total = {}; }
  KOKKOS_FUNCTION void join(value_type& total, value_type const& other) const {
    for (int i = 0; i < sums; ++i) total.sum[i].add(other.sum[i]);
    for (int i = 0; i < maxima; ++i)
      total.maximum[i] = Maximum::combine(total.maximum[i], other.maximum[i]);
  }
};

/// Largest number of blocks in a reduction on hosts; few hosts have more threads.
inline constexpr std::int64_t most_blocks = 1024;

/// Returns the sums and maxima of the numbers that functor(site, values) writes to values[0] ..
/// values[Count - 1], over all sites of all parts of the lattice. The sums come first, as in
/// `values`. Waits. On host spaces it allocates nothing, and may run in several instances of the
/// space at once. Throws std::invalid_argument when there are no sites.
template <class Combine, int Count, class Exec, class Functor>
std::array<double, std::size_t{Count}> reduce_sites(Exec const& exec, std::string const& label,
                                                    RowLayout const& layout,
                                                    Functor const& functor) {
  require_sites(label, layout.nx);
  TotalsOf<Combine, Count> total;
  if constexpr (is_host_execution<Exec>) {
    std::int32_t const per_row = tasks_per_row(layout);
    std::int64_t const tasks = layout.own.count() * per_row;
    std::int64_t const blocks =
        std::min({tasks, most_blocks, layout.sites() / calling_thread_sites + 1});
    using Body = ReduceBlock<Combine, Count, Functor>;
    for_each_task(exec, label, blocks, layout.sites(),
                  Body{functor, layout, per_row, tasks, blocks, &total});
    if constexpr (!is_synchronous<Exec>) exec.fence(label);
  } else {
    using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::int64_t>>;
    using Body = ReduceOnDevice<Combine, Count, Functor>;
    typename Body::value_type result;
    DeviceTiles const tiles(layout.nx, layout.own);
    Kokkos::parallel_reduce(label, Policy(exec, 0, tiles.thread_count()),
                            Body{functor, DeviceLayout<std::int64_t>(layout), tiles}, result);
    total.add(result.sum);
    total.include(result.maximum);
  }
  if (layout.part != nullptr) total.include_parts(*layout.part);
  return total.values();
}

/// Functor with which reduce_sites<Maximum, 1> finds the largest number of any site.
template <class Real>
struct LargestOfSites {
  SiteArray<Real, 1> numbers;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    values[0] = site.load(numbers);
  }
};

}  // namespace cayspin::inline v0_2::detail
