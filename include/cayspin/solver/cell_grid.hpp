// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>
#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/row_layout.hpp>
#include <cayspin/solver/cell_axis.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace cayspin::inline v0_2::detail {

/// The cell on which a functor works, or the first cell of a pack or row.
struct CellPlace {
  std::int32_t x, y, z;
};

/// A field for the kernels of a solver, in any precision.
template <class Real, int Components>
struct CellArray {
  Real* data = nullptr;
  std::ptrdiff_t stride = 0, pitch = 0, plane = 0;  // of components, rows and planes

  KOKKOS_FORCEINLINE_FUNCTION Real* at(CellPlace const& place) const {
    return data + (place.z * plane + place.y * pitch + place.x);
  }
  /// Loads three components, starting at `component`.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load(CellPlace const& place, int component = 0) const {
    Real const* const from = at(place) + component * stride;
    return {detail::load<Value>(from), detail::load<Value>(from + stride),
            detail::load<Value>(from + 2 * stride)};
  }
  /// Stores three components, starting at `component`, but only to cells before x = end.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void store(Vec3<Value> const& value, CellPlace const& place,
                                         std::int32_t end, int component = 0) const {
    Real* const to = at(place) + component * stride;
    if (place.x + lanes_of<Value> <= end) {
      store_narrowed(value.x, to);
      store_narrowed(value.y, to + stride);
      store_narrowed(value.z, to + 2 * stride);
    } else {
      store_first(value.x, to, end - place.x);
      store_first(value.y, to + stride, end - place.x);
      store_first(value.z, to + 2 * stride, end - place.x);
    }
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static void store_first(Value const& value, Real* to,
                                                      std::int32_t count) {
    if constexpr (lanes_of<Value> > 1) {
      scalar_t<Value> lanes[std::size_t{lanes_of<Value>}];
      detail::store(value, lanes);
      for (std::int32_t i = 0; i < count; ++i) to[i] = static_cast<Real>(lanes[i]);
    }
  }
};

/// Returns a field for the kernels of a solver, from component `first` on.
template <int Components, class Real, int All, class MemorySpace>
CellArray<Real, Components> cells_of(SiteField<Real, All, MemorySpace> const& field,
                                     int first = 0) {
  auto const array = field.array();
  auto const& layout = field.layout();
  return {array.data + first * array.stride, array.stride, layout.pitch, layout.plane};
}

/// Extents of a grid of cells, and the couplings of the cells.
template <class Real>
struct CellGrid {
  std::int32_t extent[3];
  bool periodic[3];
  CellAxisArrays<Real> axis[3];
};

/// Kernel loop of a solver on hosts: a task is a row. The functor is called for packs of cells, as
/// functor.template operator()<Value>(place). If it has a member `row`, it is called for rows
/// instead, as functor.row(place, nx).
template <class Real, class Functor>
struct RowOfCells {
  Functor functor;
  std::int32_t nx, ny;

  void operator()(std::int64_t row) const {
    Functor const local = functor;
    CellPlace place{0, static_cast<std::int32_t>(row % ny), static_cast<std::int32_t>(row / ny)};
    if constexpr (requires { local.row(place, nx); }) {
      local.row(place, nx);
    } else {
      for (; place.x < nx; place.x += host_lanes<Real>)
        local.template operator()<Pack<Real>>(place);
      // Packs do not reach around to the other end of a periodic row, so the cells at both ends are
      // computed again, one by one.
      if constexpr (requires { local.goes_around; })
        if (local.goes_around)
          for (std::int32_t const x : {0, nx - 1}) {
            place.x = x;
            local.template operator()<Real>(place);
          }
    }
  }
};

/// Kernel loop on devices: a task is a cell.
template <class Real, class Functor>
struct OneCell {
  Functor functor;
  std::int32_t nx, ny;

  KOKKOS_FUNCTION void operator()(std::int64_t cell) const {
    std::int64_t const row = cell / nx;
    functor.template operator()<Real>(CellPlace{static_cast<std::int32_t>(cell % nx),
                                                static_cast<std::int32_t>(row % ny),
                                                static_cast<std::int32_t>(row / ny)});
  }
};

/// Returns the number of sites at which an evaluation of a field costs as much as a pass over these
/// cells.
inline std::int64_t sites_worth(RowLayout const& layout) { return layout.sites() / 4; }

/// Launcher that calls a functor for all cells of a grid, in a separate kernel.
template <class Exec>
struct LaunchEach {
  Exec const& exec;

  template <class Real, class Functor>
  void run(std::string const& label, RowLayout const& layout, Functor const& functor) const {
    if constexpr (is_host_execution<Exec>)
      for_each_task(exec, label, layout.rows(), sites_worth(layout),
                    RowOfCells<Real, Functor>{functor, layout.nx, layout.ny});
    else
      for_each_task(exec, label, layout.sites(), sites_worth(layout),
                    OneCell<Real, Functor>{functor, layout.nx, layout.ny});
  }
};

/// Launcher that calls a functor for all cells inside a running host kernel, so that many small
/// passes take one launch.
struct RunInside {
  template <class Real, class Functor>
  void run(std::string const&, RowLayout const& layout, Functor const& functor) const {
    RowOfCells<Real, Functor> const rows{functor, layout.nx, layout.ny};
    for (std::int64_t row = 0; row < layout.rows(); ++row) rows(row);
  }
};

}  // namespace cayspin::inline v0_2::detail
