// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>
#include <cayspin/detail/device_site.hpp>
#include <cayspin/detail/rows.hpp>
#include <cayspin/detail/sites_of_row.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/stage/data_flow.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>

// The arrays of a Runge-Kutta stage, as whole fields, planes or rows. A pass starts from whole
// fields, and a sweep starts from planes of fields and buffers. Both convert them to rows for the
// kernel; on devices the kernel uses whole fields. A new array must be added to the functions here,
// to FieldsOfStep (memory.hpp and stepper/adaptive_memory.hpp) and PlaneOfStep (sweep.hpp), and to
// the kernel.
namespace cayspin::inline v0_2::detail {

/// Kind selects the type of the arrays: WholeFields, Planes or Rows.
template <class Kind, int Stages>
struct StageArrays {
  static constexpr std::size_t most_increments = Stages > 1 ? Stages - 1 : 1;
  static constexpr std::size_t most_carried = 1;

  typename Kind::Input start;                        // spins at the start of the step
  typename Kind::Spins level;                        // spins of this stage
  typename Kind::Input increments[most_increments];  // of earlier stages, or spins in their place
  typename Kind::Input sum_before;                   // sum of weighted increments so far
  typename Kind::Output sum;
  typename Kind::Output increment;                    // of this stage
  typename Kind::Output next;                         // spins of the next stage, or at the end
  typename Kind::Input carried_before[most_carried];  // left by the previous step
  typename Kind::Output carried[most_carried];        // left by this step
};

/// Sets the arrays of the stage that Flow describes, on the host. `step` locates each of them.
template <class Flow, class Kind, class Step>
void find_arrays(Step const& step, StageArrays<Kind, Flow::stages>& arrays) {
  constexpr int stage = Flow::stage;
  if constexpr (Flow::reads_start) arrays.start = step.start();
  arrays.level = step.template level<stage>();
  if constexpr (Flow::recovers) {
    unrolled<Flow::stages - 1>([&](auto j) {
      if constexpr (Flow::reads_increment(j()))
        arrays.increments[j()] = step.template spins<j() + 1>();
    });
  } else {
    unrolled<Flow::stages - 1>([&](auto j) {
      if constexpr (Flow::reads_increment(j()))
        arrays.increments[j()] = step.template increment<j()>();
    });
  }
  if constexpr (Flow::reads_sum) arrays.sum_before = step.template sum_before<stage>();
  if constexpr (Flow::writes_sum) arrays.sum = step.template sum<stage>();
  if constexpr (Flow::stores_increment) arrays.increment = step.template new_increment<stage>();
  arrays.next = step.template next<stage>();
  if constexpr (Flow::carried > 0) {
    constexpr std::size_t carried = Flow::carried;
    static_assert(carried <= StageArrays<Kind, Flow::stages>::most_carried);
    for (std::size_t i = 0; i < carried; ++i) {
      arrays.carried_before[i] = step.carried_before(i);
      arrays.carried[i] = step.carried(i);
    }
  }
}

/// Converts the arrays to another kind. `to` converts one array: to.input() if the stage reads it,
/// to.spins() for the stage's spins, and to.output() if the stage writes it.
template <class Flow, class From, class Convert, class Arrays>
KOKKOS_FORCEINLINE_FUNCTION void convert(StageArrays<From, Flow::stages> const& from,
                                         Convert const& to, Arrays& arrays) {
  if constexpr (Flow::reads_start) arrays.start = to.input(from.start);
  arrays.level = to.spins(from.level);
  unrolled<Flow::stages - 1>([&](auto j) {
    if constexpr (Flow::reads_increment(j())) arrays.increments[j] = to.input(from.increments[j()]);
  });
  if constexpr (Flow::reads_sum) arrays.sum_before = to.input(from.sum_before);
  if constexpr (Flow::writes_sum) arrays.sum = to.output(from.sum);
  if constexpr (Flow::stores_increment) arrays.increment = to.output(from.increment);
  arrays.next = to.output(from.next);
  if constexpr (Flow::carried > 0) {
    for (int i = 0; i < Flow::carried; ++i) {
      arrays.carried_before[i] = to.input(from.carried_before[i]);
      arrays.carried[i] = to.output(from.carried[i]);
    }
  }
}

/// Calls visit(array) for the arrays that a stage reads.
template <class Flow, class Kind, class Visit>
KOKKOS_FORCEINLINE_FUNCTION void for_each_input(StageArrays<Kind, Flow::stages> const& arrays,
                                                Visit const& visit) {
  if constexpr (Flow::reads_start) visit(arrays.start);
  visit(arrays.level);
  unrolled<Flow::stages - 1>([&](auto j) {
    if constexpr (Flow::reads_increment(j())) visit(arrays.increments[j()]);
  });
  if constexpr (Flow::reads_sum) visit(arrays.sum_before);
  for (int i = 0; i < Flow::carried; ++i) visit(arrays.carried_before[i]);
}

template <class Real>
struct WholeFields {
  using Input = SiteArray<Real, 3>;
  using Spins = SiteArray<Real, 3>;
  using Output = OutputArray<Real, 3>;
};

/// One plane of each field, in the field itself or in a buffer.
template <class Real>
struct Planes {
  using Input = PlaneRows<Real>;
  struct Spins {
    PlaneRows<Real> previous, here, next;
  };
  struct Output {
    PlaneRows<Real> rows;
    bool streaming = false;
  };
};

/// One row of each field.
template <class Real>
struct Rows {
  using Input = RowInput<Real>;
  using Spins = RowStencil<Real>;
  using Output = RowOutput<Real>;
};

/// Converts each field to its plane z.
template <class Real>
struct ToPlane {
  RowLayout const& layout;
  std::int32_t z;

  KOKKOS_FUNCTION PlaneRows<Real> input(SiteArray<Real, 3> const& array) const {
    return plane_rows(array, layout, z);
  }
  KOKKOS_FUNCTION typename Planes<Real>::Spins spins(SiteArray<Real, 3> const& array) const {
    PlaneAxis const along_z(layout);
    return {plane_rows(array, layout, along_z.wrapped(along_z.previous(z))),
            plane_rows(array, layout, z),
            plane_rows(array, layout, along_z.wrapped(along_z.next(z)))};
  }
  KOKKOS_FUNCTION typename Planes<Real>::Output output(OutputArray<Real, 3> const& array) const {
    return {plane_rows<Real>(array, layout, z), array.streaming};
  }
};

/// Converts each plane to its row `row`.
template <class Real>
struct ToRow {
  Axis y;
  std::int32_t row;

  KOKKOS_FORCEINLINE_FUNCTION RowInput<Real> input(PlaneRows<Real> const& plane) const {
    return plane.input(row);
  }
  KOKKOS_FORCEINLINE_FUNCTION RowStencil<Real> spins(
      typename Planes<Real>::Spins const& planes) const {
    RowStencil<Real> rows;
    rows.data = planes.here.row(row);
    rows.stride = planes.here.stride;
    rows.neighbor[0][0] = planes.here.row(y.previous(row));
    rows.neighbor[0][1] = planes.here.row(y.next(row));
    rows.neighbor[1][0] = planes.previous.row(row);
    rows.neighbor[1][1] = planes.next.row(row);
    return rows;
  }
  KOKKOS_FORCEINLINE_FUNCTION RowOutput<Real> output(
      typename Planes<Real>::Output const& plane) const {
    return plane.rows.output(row, plane.streaming);
  }
};

/// Functor that prefetches the numbers of a row at offset `ahead`. For a stencil it prefetches from
/// the row in the next plane, because the other rows have been read before.
template <class Real>
struct Prefetch {
  std::ptrdiff_t ahead;

  KOKKOS_FORCEINLINE_FUNCTION void operator()(RowInput<Real> const& row) const {
    for (int component = 0; component < 3; ++component)
      prefetch(row.data + component * row.stride + ahead);
  }
  KOKKOS_FORCEINLINE_FUNCTION void operator()(RowStencil<Real> const& rows) const {
    (*this)(RowInput<Real>{rows.neighbor[1][1], rows.stride});
  }
};

/// Returns how many of the increments 0 .. j - 1 a stage reads.
template <class Flow>
constexpr int increments_read(int j) {
  int count = 0;
  for (int i = 0; i < j; ++i) count += Flow::reads_increment(i);
  return count;
}

/// The StageArrays of device threads. Members that Flow does not use are empty, because kernels of
/// at most 512 bytes are launched faster.
template <class Flow, class Real>
struct DeviceArrays {
  struct None {};
  template <bool IsUsed>
  using If = std::conditional_t<IsUsed, ComponentPointers<Real>, None>;

  class Increments {
   public:
    template <int J>
    KOKKOS_FORCEINLINE_FUNCTION auto const& operator[](std::integral_constant<int, J>) const {
      return used_[increments_read<Flow>(J)];
    }
    template <int J>
    KOKKOS_FORCEINLINE_FUNCTION auto& operator[](std::integral_constant<int, J>) {
      return used_[increments_read<Flow>(J)];
    }

   private:
    static constexpr int count = increments_read<Flow>(Flow::stages - 1);
    If<(count > 0)> used_[std::size_t{count > 0 ? count : 1}];
  };

  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS If<Flow::reads_start> start;
  ComponentPointers<Real> level;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS Increments increments;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS If<Flow::reads_sum> sum_before;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS If<Flow::writes_sum> sum;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS If<Flow::stores_increment> increment;
  ComponentPointers<Real> next;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS If<(Flow::carried > 0)> carried_before[1], carried[1];
};

template <class Real>
struct ToComponents {
  KOKKOS_FUNCTION ComponentPointers<Real> input(SiteArray<Real, 3> const& array) const {
    return ComponentPointers<Real>(array);
  }
  KOKKOS_FUNCTION ComponentPointers<Real> spins(SiteArray<Real, 3> const& array) const {
    return input(array);
  }
  KOKKOS_FUNCTION ComponentPointers<Real> output(SiteArray<Real, 3> const& array) const {
    return input(array);
  }
};

}  // namespace cayspin::inline v0_2::detail
