// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/row_layout.hpp>
#include <cayspin/solver/cell_axis.hpp>
#include <cayspin/solver/coefficient_scalar.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

// The passes of a multigrid cycle. A task is a row on hosts, where compilers vectorise along it,
// and a site on devices.
// In front of a loop over the cells of a row, none of which is written and read.
#if defined(__CUDA_ARCH__) || defined(__HIP_DEVICE_COMPILE__)
#define CAYSPIN_DETAIL_INDEPENDENT
#elif defined(__clang__)
#define CAYSPIN_DETAIL_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define CAYSPIN_DETAIL_INDEPENDENT _Pragma("GCC ivdep")
#else
#define CAYSPIN_DETAIL_INDEPENDENT
#endif

namespace cayspin::detail {

/// Cells [begin, end) of a row.
struct CellsOfRow {
  std::int32_t y, z, begin, end;
};

template <class Functor>
struct CellTasks {
  Functor functor;
  std::int32_t ny, cells, per_task;  // cells of a row; of a task

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    std::int64_t const per_row = cells / per_task, row = task / per_row;
    auto const begin = static_cast<std::int32_t>(task % per_row) * per_task;
    functor(CellsOfRow{static_cast<std::int32_t>(row % ny), static_cast<std::int32_t>(row / ny),
                       begin, begin + per_task});
  }
};

/// Calls functor(cells) for all cells of a layout.
template <class Exec, class Functor>
void for_each_cell(Exec const& exec, std::string const& label, RowLayout const& layout,
                   Functor const& functor) {
  std::int32_t const per_task = is_host_execution<Exec> ? layout.nx : 1;
  for_each_task(exec, label, layout.sites() / per_task, layout.sites(),
                CellTasks<Functor>{functor, layout.ny, layout.nx, per_task});
}

/// Where the cells of a level lie, and how they couple.
template <class Real>
struct CellGrid {
  RowLayout layout;
  CellAxisArrays<Real> axis[3];

  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t row(std::int32_t y, std::int32_t z) const {
    return (std::ptrdiff_t(z) * layout.ny + y) * layout.pitch;
  }
};

/// out = u + weight (f - (c + b K) u), or weight (f - (c + b K) u).
template <class Scalar, int RightHandComponents>
struct RelaxCells {
  using Real = real_part_t<Scalar>;
  static constexpr int parts = real_parts<Scalar>;

  CellGrid<Real> grid;
  Real c;
  Scalar b, weight;
  SiteArray<Real, 3 * parts> u;
  SiteArray<Real, RightHandComponents> f;
  SiteArray<Real, 3 * parts> out;
  bool residual;

  KOKKOS_FUNCTION void operator()(CellsOfRow const& cells) const {
    std::int32_t const last = grid.layout.nx - 1;
    bool const wraps = grid.layout.periodic[0];
    std::int32_t begin = cells.begin, end = cells.end;
    for (int component = 0; component < 3; ++component) {
      Row const row(*this, cells, component);
      if (cells.begin == 0) {
        row.relax(0, wraps ? last : 0, last > 0 ? 1 : 0);
        begin = 1;
      }
      if (cells.end > last && last > 0) {
        row.relax(last, last - 1, wraps ? 0 : last);
        end = last;
      }
      row.relax_inside(begin, end);
    }
  }

 private:
  struct Row {
    KOKKOS_FORCEINLINE_FUNCTION Row(RelaxCells const& all, CellsOfRow const& cells, int component)
        : c(all.c),
          b(all.b),
          weight(all.weight),
          to_previous_x(all.grid.axis[0].to_previous),
          to_next_x(all.grid.axis[0].to_next),
          kept(all.residual ? 0 : 1) {
      auto const& layout = all.grid.layout;
      std::ptrdiff_t const offset = all.grid.row(cells.y, cells.z);
      for (int part = 0; part < parts; ++part) {
        u[part] = all.u.data + (component + 3 * part) * all.u.stride + offset;
        out[part] = all.out.data + (component + 3 * part) * all.out.stride + offset;
      }
      for (int part = 0; part < RightHandComponents / 3; ++part)
        f[part] = all.f.data + (component + 3 * part) * all.f.stride + offset;
      set(0, cells.y, layout.ny, layout.pitch, layout.periodic[1], all.grid.axis[1]);
      set(1, cells.z, layout.nz, layout.pitch * layout.ny, layout.periodic[2], all.grid.axis[2]);
    }

    KOKKOS_FORCEINLINE_FUNCTION void relax(std::int32_t x, std::int32_t before,
                                           std::int32_t after) const {
      Real k[std::size_t{parts}], r[std::size_t{parts}], sum[std::size_t{parts}];
      for (int part = 0; part < parts; ++part) {
        Real const* const v = u[part];
        Real const here = v[x];
        k[part] =
            to_previous_x[x] * (here - v[before]) + to_next_x[x] * (here - v[after]) +
            couple[0][0] * (here - v[x + way[0][0]]) + couple[0][1] * (here - v[x + way[0][1]]) +
            couple[1][0] * (here - v[x + way[1][0]]) + couple[1][1] * (here - v[x + way[1][1]]);
        r[part] = (part < RightHandComponents / 3 ? f[part][x] : Real(0)) - c * here;
        sum[part] = kept * here;
      }
      multiply_subtract_from(b, k, r);
      multiply_add_to(weight, r, sum);
      for (int part = 0; part < parts; ++part) out[part][x] = sum[part];
    }
    KOKKOS_FORCEINLINE_FUNCTION void relax_inside(std::int32_t begin, std::int32_t end) const {
      Row const row = *this;  // which no store changes
      CAYSPIN_DETAIL_INDEPENDENT
      for (std::int32_t x = begin; x < end; ++x) row.relax(x, x - 1, x + 1);
    }

   private:
    KOKKOS_FORCEINLINE_FUNCTION void set(int which, std::int32_t index, std::int32_t extent,
                                         std::ptrdiff_t stride, bool periodic,
                                         CellAxisArrays<Real> const& axis) {
      std::ptrdiff_t const around = periodic ? (extent - 1) * stride : 0;
      way[which][0] = index > 0 ? -stride : around;
      way[which][1] = index + 1 < extent ? stride : -around;
      couple[which][0] = axis.to_previous[index];
      couple[which][1] = axis.to_next[index];
    }

    Real c;
    Scalar b, weight;
    Real const *to_previous_x, *to_next_x;
    Real kept;  // of u
    Real const* u[std::size_t{parts}];
    Real const* f[std::size_t{parts}] = {};
    Real* out[std::size_t{parts}];
    std::ptrdiff_t way[2][2];
    Real couple[2][2];
  };
};

/// out = weight f.
template <class Scalar, int RightHandComponents>
struct ScaleCells {
  using Real = real_part_t<Scalar>;
  static constexpr int parts = real_parts<Scalar>;

  RowLayout layout;
  Scalar weight;
  SiteArray<Real, RightHandComponents> f;
  SiteArray<Real, 3 * parts> out;

  KOKKOS_FUNCTION void operator()(CellsOfRow const& cells) const {
    std::ptrdiff_t const offset = (std::ptrdiff_t(cells.z) * layout.ny + cells.y) * layout.pitch;
    for (int component = 0; component < 3; ++component) {
      Real const* source[std::size_t{parts}] = {};
      Real* target[std::size_t{parts}];
      for (int part = 0; part < parts; ++part) {
        if (part < RightHandComponents / 3)
          source[part] = f.data + (component + 3 * part) * f.stride + offset;
        target[part] = out.data + (component + 3 * part) * out.stride + offset;
      }
      Scalar const factor = weight;
      CAYSPIN_DETAIL_INDEPENDENT
      for (std::int32_t x = cells.begin; x < cells.end; ++x) {
        Real from[std::size_t{parts}] = {}, to[std::size_t{parts}] = {};
        for (int part = 0; part < RightHandComponents / 3; ++part) from[part] = source[part][x];
        multiply_add_to(factor, from, to);
        for (int part = 0; part < parts; ++part) target[part][x] = to[part];
      }
    }
  }
};

KOKKOS_FORCEINLINE_FUNCTION std::int32_t extent_along(RowLayout const& layout, int axis) {
  return axis == 0 ? layout.nx : axis == 1 ? layout.ny : layout.nz;
}
KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t stride_along(RowLayout const& layout, int axis) {
  return axis == 0 ? 1 : axis == 1 ? layout.pitch : layout.pitch * layout.ny;
}

/// Restriction along one axis: `to` has about half the cells along it.
template <class Real, int Components>
struct RestrictCells {
  RowLayout from_layout, to_layout;
  int axis;
  Real const* weights;
  SiteArray<Real, Components> from, to;

  KOKKOS_FUNCTION void operator()(CellsOfRow const& cells) const {
    std::ptrdiff_t const to_row =
        (std::ptrdiff_t(cells.z) * to_layout.ny + cells.y) * to_layout.pitch;
    std::int32_t const extent = extent_along(from_layout, axis);
    std::ptrdiff_t const stride = stride_along(from_layout, axis);
    constexpr auto reach = static_cast<std::int32_t>(CellAxis::reach);
    // The first cell of a row that does not look past either end, and the first that does again.
    std::int32_t const inside = axis == 0 && cells.end - cells.begin > 1 ? 1 : cells.end;
    std::int32_t const outside = axis == 0 ? to_layout.nx - 1 : 0;
    std::ptrdiff_t const rest = (axis == 1 ? 0 : cells.y * stride_along(from_layout, 1)) +
                                (axis == 2 ? 0 : cells.z * stride_along(from_layout, 2));
    std::int32_t const row = axis == 1 ? cells.y : cells.z;
    auto const from_row = [=](std::int32_t k) {
      return (2 * row + k + extent - 1) % extent * stride;
    };
    for (int component = 0; component < Components; ++component) {
      Real const* const source = from.data + component * from.stride + rest;
      Real* const target = to.data + component * to.stride + to_row;
      if (axis != 0) {
        Real const* const here = weights + row * reach;
        Real const w0 = here[0], w1 = here[1], w2 = here[2], w3 = here[3], w4 = here[4];
        Real const *const s0 = source + from_row(0), *const s1 = source + from_row(1),
                          *const s2 = source + from_row(2), *const s3 = source + from_row(3),
                          *const s4 = source + from_row(4);
        CAYSPIN_DETAIL_INDEPENDENT
        for (std::int32_t x = cells.begin; x < cells.end; ++x)
          target[x] = w0 * s0[x] + w1 * s1[x] + w2 * s2[x] + w3 * s3[x] + w4 * s4[x];
        continue;
      }
      auto const around = [&](std::int32_t x) {
        Real sum = 0;
        for (std::int32_t k = 0; k < reach; ++k)
          sum += weights[x * reach + k] * source[(2 * x + k + extent - 1) % extent];
        target[x] = sum;
      };
      std::int32_t x = cells.begin;
      for (; x < cells.end && x < inside; ++x) around(x);
      Real const* const w = weights;
      std::int32_t const end = outside < cells.end ? outside : cells.end;
      CAYSPIN_DETAIL_INDEPENDENT
      for (std::int32_t i = x; i < end; ++i)
        target[i] = w[i * reach] * source[2 * i - 1] + w[i * reach + 1] * source[2 * i] +
                    w[i * reach + 2] * source[2 * i + 1] + w[i * reach + 3] * source[2 * i + 2] +
                    w[i * reach + 4] * source[2 * i + 3];
      for (x = end > x ? end : x; x < cells.end; ++x) around(x);
    }
  }
};

/// Interpolation along one axis: `to` has about twice the cells along it. Adds to what is there
/// where `adds`.
template <class Real, int Components>
struct InterpolateCells {
  RowLayout from_layout, to_layout;
  int axis;
  CellAxisArrays<Real> numbers;
  SiteArray<Real, Components> from, to;
  bool adds;

  KOKKOS_FUNCTION void operator()(CellsOfRow const& cells) const {
    std::ptrdiff_t const to_row =
        (std::ptrdiff_t(cells.z) * to_layout.ny + cells.y) * to_layout.pitch;
    std::int32_t const last = extent_along(from_layout, axis) - 1;
    std::ptrdiff_t const stride = stride_along(from_layout, axis);
    std::ptrdiff_t const rest = (axis == 1 ? 0 : cells.y * stride_along(from_layout, 1)) +
                                (axis == 2 ? 0 : cells.z * stride_along(from_layout, 2));
    for (int component = 0; component < Components; ++component) {
      Real const* const source = from.data + component * from.stride + rest;
      Real* const target = to.data + component * to.stride + to_row;
      if (axis != 0) {
        std::int32_t const fine = axis == 1 ? cells.y : cells.z;
        Real const share = numbers.share[fine], other = Real(1) - share;
        Real const* const own = source + (fine / 2 < last ? fine / 2 : last) * stride;
        Real const* const beside = source + numbers.beside[fine] * stride;
        if (adds) {
          CAYSPIN_DETAIL_INDEPENDENT
          for (std::int32_t x = cells.begin; x < cells.end; ++x)
            target[x] = target[x] + (other * own[x] + share * beside[x]);
        } else {
          CAYSPIN_DETAIL_INDEPENDENT
          for (std::int32_t x = cells.begin; x < cells.end; ++x)
            target[x] = other * own[x] + share * beside[x];
        }
        continue;
      }
      Real const* const shares = numbers.share;
      std::int32_t const* const besides = numbers.beside;
      CAYSPIN_DETAIL_INDEPENDENT
      for (std::int32_t x = cells.begin; x < cells.end; ++x) {
        Real const share = shares[x];
        Real const value =
            (Real(1) - share) * source[x / 2 < last ? x / 2 : last] + share * source[besides[x]];
        target[x] = (adds ? target[x] : Real(0)) + value;
      }
    }
  }
};

}  // namespace cayspin::detail
