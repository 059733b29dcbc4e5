// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/row_fields.hpp>
#include <cayspin/isotropy/energy.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stage/arrays.hpp>

#include <cstdint>
#include <string>
#include <type_traits>

// A Runge-Kutta stage over the whole lattice: on hosts pack by pack along rows, on devices site by
// site.
namespace cayspin::inline v0_2::detail {

template <class Kernel>
using FieldsOf = StageArrays<WholeFields<typename Kernel::value_type>, Kernel::stages>;

/// The planes that a stage reads and writes.
template <class Flow, class Real>
struct StagePlanes {
  using RowArrays = StageArrays<Rows<Real>, Flow::stages>;

  StageArrays<Planes<Real>, Flow::stages> arrays;
  Axis y;
  bool from_memory = false;  // true if these planes are probably not in the core's cache

  KOKKOS_FORCEINLINE_FUNCTION RowArrays rows(std::int32_t at) const {
    RowArrays rows;
    convert<Flow>(arrays, ToRow<Real>{y, at}, rows);
    return rows;
  }
};

template <class Kernel>
using PlanesOf = StagePlanes<typename Kernel::Flow, typename Kernel::value_type>;

/// Returns plane z of the fields.
template <class Flow, class Real>
CAYSPIN_DETAIL_NOINLINE StagePlanes<Flow, Real> planes_of_fields(
    StageArrays<WholeFields<Real>, Flow::stages> const& fields, RowLayout const& layout,
    std::int32_t z) {
  StagePlanes<Flow, Real> planes;
  convert<Flow>(fields, ToPlane<Real>{layout, z}, planes.arrays);
  planes.y = Axis(layout, 1);
  planes.from_memory = layout.allocation(3) * sizeof(Real) > core_cache_bytes();
  return planes;
}

/// Runs the kernel on sites begin .. end - 1 of a row, in whole packs. Packs at the ends of the row
/// have a separate loop, so that the others need no tests. If the generator has already evaluated
/// the ends (find_row_ends), one loop without tests runs on all packs.
template <class Kernel>
KOKKOS_FORCEINLINE_FUNCTION void run_along(Kernel const& kernel, PlanesOf<Kernel> const& planes,
                                           typename Kernel::RowArrays const& rows, Row const& row,
                                           std::ptrdiff_t begin, std::ptrdiff_t end) {
  using Real = typename Kernel::value_type;
  constexpr std::ptrdiff_t lanes = host_lanes<Real>;
  constexpr bool finds_ends = FindsRowEnds<decltype(kernel.generator), Real>;
  std::ptrdiff_t const last = (row.nx - 1) / lanes * lanes;
  std::ptrdiff_t const inner_begin = finds_ends ? begin : Kokkos::max(begin, lanes);
  std::ptrdiff_t const inner_end = finds_ends ? end : Kokkos::min(end, last);
  for (std::ptrdiff_t x = inner_begin; x < inner_end; x += lanes) {
    std::ptrdiff_t const here = opaque(x);
    if (planes.from_memory)
      for_each_input<typename Kernel::Flow>(rows, Prefetch<Real>{here + row.pitch});
    kernel(Site<Pack<Real>, false>(row, here), rows);
  }
  if constexpr (!finds_ends) {
    std::ptrdiff_t const first_at_end = begin > 0 ? last : 0, to_last = last > 0 ? last : lanes;
    for (std::ptrdiff_t x = first_at_end; x < end; x += to_last)
      kernel(Site<Pack<Real>, true>(row, opaque(x)), rows);
  }
}

/// The single compiled body of a stage on host spaces, so that the results of all callers are
/// bitwise identical.
template <class Kernel>
CAYSPIN_DETAIL_NOINLINE void run_stage(Kernel const& kernel, PlanesOf<Kernel> const& planes,
                                       RowLayout const& layout, RowBlock block) {
  using Real = typename Kernel::value_type;
  constexpr std::int32_t lanes = host_lanes<Real>;
  constexpr int fields = row_fields<decltype(kernel.generator)>;
  std::int32_t const begin = block.pack_begin * lanes, end = block.pack_end * lanes;
  [[maybe_unused]] RowFieldMemory<Real, Kokkos::max(fields, 1)> memory;
  Kernel local = kernel;
  for (std::int32_t y = block.y_begin; y < block.y_end; ++y) {
    typename Kernel::RowArrays const rows = planes.rows(y);
    Row const row(layout, planes.y.wrapped(y), block.z);
    if constexpr (fields == 0) {
      run_along(local, planes, rows, row, begin, end);
    } else {
      for (std::int32_t x = begin; x < end; x += sites_per_piece) {
        std::int32_t const after = Kokkos::min(x + sites_per_piece, end);
        local.generator.begin_row({row, rows.level}, x, after, memory.all());
        if constexpr (FindsRowEnds<decltype(kernel.generator), Real>)
          kernel.generator.find_row_ends({row, rows.level}, x, after, memory.all(),
                                         Kernel::turning_alone);
        // Passes copies: anything whose address is known elsewhere would be reloaded for each pack.
        run_along(local, planes, typename Kernel::RowArrays(rows), Row(row), x, after);
      }
    }
  }
}

/// Host loop over the sites, for one stage. Each task works on one RowBlock.
template <class Kernel>
struct StageRowLoop {
  using Real = typename Kernel::value_type;
  Kernel kernel;
  FieldsOf<Kernel> fields;
  RowLayout layout;
  RowBlocks blocks;

  StageRowLoop(Kernel const& stage, FieldsOf<Kernel> const& arrays, RowLayout const& rows)
      : kernel(stage),
        fields(arrays),
        layout(rows),
        blocks(rows, pack_count<Real>(rows), rows.own_and(Kernel::stages_after)) {}
  std::int64_t tasks() const { return blocks.count(); }

  /// A task with all pointers resolved, which can run repeatedly.
  struct Task {
    StageRowLoop const& loop;
    RowBlock block;
    PlanesOf<Kernel> planes;
    void operator()() const { run_stage(loop.kernel, planes, loop.layout, block); }
  };
  Task task_at(std::int64_t task) const {
    auto const block = blocks(task);
    return {*this, block, planes_of_fields<typename Kernel::Flow>(fields, layout, block.z)};
  }

  void operator()(std::int64_t task) const {
    task_at(task)();
    if (fields.next.streaming) streaming_fence();
  }
};

/// A stage at one site, on a device.
template <class Kernel>
struct StageOnSite {
  using Flow = typename Kernel::Flow;
  using Real = typename Kernel::value_type;
  Kernel kernel;
  DeviceArrays<Flow, Real> fields;

  StageOnSite(Kernel const& stage, FieldsOf<Kernel> const& arrays) : kernel(stage) {
    convert<Flow>(arrays, ToComponents<Real>{}, fields);
  }

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    kernel(site, fields);
  }
};

/// Prepares the generator for a stage: on hosts for evaluation along rows, except with
/// isotropy::Energy, which needs the rigid body itself.
template <class Isotropy, class Generator, class Exec, class Spins>
auto prepare_stage(Generator const& generator, Exec const& exec, Spins const& spins, double t) {
  if constexpr (is_host_execution<Exec> && !std::is_same_v<Isotropy, isotropy::Energy>)
    return prepare_for_rows(generator, exec, spins, t);
  else
    return prepare_term(generator, exec, spins, t);
}

/// Returns true if prepare_stage does not need the spins.
template <class Isotropy, class Generator, class Exec, class Spins>
bool stages_need_only_time(Generator const& generator, Exec const& exec, Spins const& spins) {
  if constexpr (is_host_execution<Exec> && !std::is_same_v<Isotropy, isotropy::Energy>)
    return rows_need_only_time(generator, exec, spins);
  else
    return needs_only_time(generator, exec, spins);
}

template <class Exec, class Kernel>
void run_pass(Exec const& exec, std::string const& label, RowLayout const& layout,
              Kernel const& kernel, FieldsOf<Kernel> const& fields) {
  if constexpr (is_host_execution<Exec>) {
    StageRowLoop<Kernel> const loop(kernel, fields, layout);
    for_each_task(exec, label, loop.tasks(), layout.sites(), loop);
  } else {
    for_each_site<typename Kernel::value_type>(exec, label, layout,
                                               StageOnSite<Kernel>(kernel, fields),
                                               layout.own_and(Kernel::stages_after));
  }
}

}  // namespace cayspin::inline v0_2::detail
