// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/stage/arrays.hpp>
#include <cayspin/stage/kernel.hpp>

#include <cstdint>
#include <string>

// A stage of a Runge-Kutta step over the whole lattice.
namespace cayspin::detail {

/// The fields that a stage reads and writes.
template <class Real, int Stages>
struct StageFields {
  SiteArray<Real, 3> start, level, increments[Stages > 1 ? Stages - 1 : 1];
  OutputArray<Real, 3> sum, increment, next;
  SiteArray<Real, 3> residual;

  /// Their plane z.
  template <class Kernel>
  StagePlanes<Kernel> planes(RowLayout const& layout, std::int32_t z) const {
    auto const at = [&](SiteArray<Real, 3> const& array, std::int32_t plane) {
      return plane_rows(array, layout, plane);
    };
    Axis const along_z(layout, 2);
    StagePlanes<Kernel> planes;
    planes.y = Axis(layout, 1);
    planes.start = at(start, z);
    planes.level[0] = at(level, along_z.wrapped(along_z.previous(z)));
    planes.level[1] = at(level, z);
    planes.level[2] = at(level, along_z.wrapped(along_z.next(z)));
    for (int i = 0; i + 1 < Stages; ++i)
      if (Kernel::reads_increment(i)) planes.increments[i] = at(increments[i], z);
    planes.sum_before = at(sum, z);
    planes.sum = at(sum, z);
    planes.increment = at(increment, z);
    planes.next = at(next, z);
    if constexpr (Kernel::compensates) planes.residual = at(residual, z);
    planes.from_memory = planes.level_from_memory = true;
    planes.sum_streams = sum.streaming;
    planes.increment_streams = increment.streaming;
    planes.next_streams = next.streaming;
    return planes;
  }

  /// One of their rows.
  KOKKOS_FORCEINLINE_FUNCTION StageRows<Real, Stages> rows(Row const& row) const {
    StageRows<Real, Stages> at;
    at.start = input(start, row);
    for (int i = 0; i + 1 < Stages; ++i) at.increments[i] = input(increments[i], row);
    at.sum_before = input(sum, row);
    at.sum = output(sum, row);
    at.increment = output(increment, row);
    at.next = output(next, row);
    at.residual_before = input(residual, row);
    at.residual = output({residual, false}, row);
    at.level.data = level.data + row.offset;
    at.level.stride = level.stride;
    for (int axis = 0; axis < 2; ++axis)
      for (int direction = 0; direction < 2; ++direction)
        at.level.neighbor[axis][direction] = at.level.data + row.to_neighbor[axis][direction];
    return at;
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION static RowInput<Real> input(SiteArray<Real, 3> const& array,
                                                          Row const& row) {
    return {array.data + row.offset, array.stride, 0};
  }
  KOKKOS_FORCEINLINE_FUNCTION static RowOutput<Real> output(OutputArray<Real, 3> const& array,
                                                            Row const& row) {
    return {array.data + row.offset, array.stride, array.streaming};
  }
};

/// The host loop.
template <class Kernel>
struct StageRowLoop {
  using Real = typename Kernel::value_type;
  Kernel kernel;
  StageFields<Real, Kernel::stages> fields;
  RowLayout layout;
  RowBlocks blocks;

  StageRowLoop(Kernel const& stage, StageFields<Real, Kernel::stages> const& of,
               RowLayout const& rows)
      : kernel(stage), fields(of), layout(rows), blocks(rows, pack_count<Real>(rows)) {}
  std::int64_t tasks() const { return blocks.count(); }

  /// A task with all its pointers found, to be run again and again.
  struct Task {
    StageRowLoop const& of;
    RowBlock block;
    StagePlanes<Kernel> planes;
    void operator()() const { run_stage(of.kernel, planes, of.layout, block); }
  };
  Task task_at(std::int64_t task) const {
    auto const block = blocks(task);
    return {*this, block, fields.template planes<Kernel>(layout, block.z)};
  }

  void operator()(std::int64_t task) const {
    task_at(task)();
    if (fields.next.streaming) streaming_fence();
  }
};

/// The device's share: one site.
template <class Kernel>
struct StageOnSite {
  Kernel kernel;
  StageFields<typename Kernel::value_type, Kernel::stages> fields;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    kernel(site, fields.rows(site.row()));
  }
};

template <class Exec, class Kernel>
void run_pass(Exec const& exec, std::string const& label, RowLayout const& layout,
              Kernel const& kernel,
              StageFields<typename Kernel::value_type, Kernel::stages> const& fields) {
  if constexpr (is_host_execution<Exec>) {
    StageRowLoop<Kernel> const loop(kernel, fields, layout);
    for_each_task(exec, label, loop.tasks(), layout.sites(), loop);
  } else {
    for_each_site<typename Kernel::value_type>(exec, label, layout,
                                               StageOnSite<Kernel>{kernel, fields});
  }
}

}  // namespace cayspin::detail
