// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/row_layout.hpp>
#include <cayspin/solver/coefficient_scalar.hpp>

#include <cstddef>
#include <cstdint>

namespace cayspin::detail {

/// The factors of c + b K on a line, for kernels: y_i = inverse_i r_i + ratio_i y_(i-1) forwards,
/// z_i = y_i + ratio_i z_(i+1) backwards; on a periodic line z - (z_0 + last z_last) closing.
template <class Scalar>
struct LineFactors {
  Scalar const *inverse = nullptr, *ratio = nullptr, *closing = nullptr;
  Scalar last{};
  bool periodic = false;
};

/// Solves lines along one axis. A task is a bundle of lines that are neighbours along x, or one
/// line along x.
template <class Scalar, int RightHandComponents>
struct SolveLines {
  using Real = real_part_t<Scalar>;
  static constexpr int parts = real_parts<Scalar>;

  LineFactors<Scalar> factors;
  RowLayout layout;
  int axis;
  std::int32_t bundle;  // lines of a task
  SiteArray<Real, RightHandComponents> r;
  SiteArray<Real, 3 * parts> z;

  std::int32_t bundles() const { return axis == 0 ? 1 : (layout.nx + bundle - 1) / bundle; }
  std::int64_t tasks() const {
    return axis == 0   ? layout.rows()
           : axis == 1 ? std::int64_t(layout.nz) * bundles()
                       : std::int64_t(layout.ny) * bundles();
  }

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    std::int64_t const across = axis == 0 ? 1 : (layout.nx + bundle - 1) / bundle;
    std::ptrdiff_t const plane = layout.pitch * layout.ny;
    std::int64_t const line = task / across;
    auto const x = static_cast<std::int32_t>(task % across) * bundle;
    std::ptrdiff_t const begin =
        axis == 0 ? line * layout.pitch : x + line * (axis == 1 ? plane : layout.pitch);
    std::int32_t const width = axis == 0 ? 1 : Kokkos::min(bundle, layout.nx - x);
    if (axis == 0 && !factors.periodic) return solve_row(begin, layout.nx);
    std::int32_t const extent = axis == 0 ? layout.nx : axis == 1 ? layout.ny : layout.nz;
    std::ptrdiff_t const stride = axis == 0 ? 1 : axis == 1 ? layout.pitch : plane;
    for (int component = 0; component < 3; ++component)
      solve(component, begin, stride, extent, width);
  }

 private:
  // The three components at once, since each is a chain of dependent operations.
  KOKKOS_FORCEINLINE_FUNCTION void solve_row(std::ptrdiff_t begin, std::int32_t count) const {
    constexpr std::size_t numbers = 3;
    Real carried[numbers][std::size_t{parts}] = {};
    Real const* const from = r.data + begin;
    Real* const to = z.data + begin;
    for (std::int32_t i = 0; i < count; ++i) {
      Scalar const inverse = factors.inverse[i], ratio = i > 0 ? factors.ratio[i] : Scalar(0);
      for (std::size_t component = 0; component < numbers; ++component) {
        auto const row = static_cast<std::ptrdiff_t>(component);
        Real right[std::size_t{parts}] = {}, sum[std::size_t{parts}] = {};
        for (int part = 0; part < RightHandComponents / 3; ++part)
          right[part] = from[(row + 3 * part) * r.stride + i];
        multiply_add_to(inverse, right, sum);
        multiply_add_to(ratio, carried[component], sum);
        for (int part = 0; part < parts; ++part) {
          carried[component][part] = sum[part];
          to[(row + 3 * part) * z.stride + i] = sum[part];
        }
      }
    }
    for (std::int32_t i = count - 2; i >= 0; --i) {
      Scalar const ratio = factors.ratio[i];
      for (std::size_t component = 0; component < numbers; ++component) {
        auto const row = static_cast<std::ptrdiff_t>(component);
        Real sum[std::size_t{parts}];
        for (int part = 0; part < parts; ++part) sum[part] = to[(row + 3 * part) * z.stride + i];
        multiply_add_to(ratio, carried[component], sum);
        for (int part = 0; part < parts; ++part) {
          carried[component][part] = sum[part];
          to[(row + 3 * part) * z.stride + i] = sum[part];
        }
      }
    }
  }

  KOKKOS_FORCEINLINE_FUNCTION void solve(int component, std::ptrdiff_t begin, std::ptrdiff_t stride,
                                         std::int32_t count, std::int32_t width) const {
    Real* to[std::size_t{parts}];
    for (int part = 0; part < parts; ++part)
      to[part] = z.data + (component + 3 * part) * z.stride + begin;
    Real const* from[std::size_t{parts}] = {};
    for (int part = 0; part < RightHandComponents / 3; ++part)
      from[part] = r.data + (component + 3 * part) * r.stride + begin;
    for (std::int32_t i = 0; i < count; ++i)
      for (std::int32_t k = 0; k < width; ++k) {
        std::ptrdiff_t const at = i * stride + k;
        Real right[std::size_t{parts}] = {}, before[std::size_t{parts}] = {},
             sum[std::size_t{parts}] = {};
        for (int part = 0; part < RightHandComponents / 3; ++part) right[part] = from[part][at];
        multiply_add_to(factors.inverse[i], right, sum);
        if (i > 0) {
          for (int part = 0; part < parts; ++part) before[part] = to[part][at - stride];
          multiply_add_to(factors.ratio[i], before, sum);
        }
        for (int part = 0; part < parts; ++part) to[part][at] = sum[part];
      }
    for (std::int32_t i = count - 2; i >= 0; --i)
      for (std::int32_t k = 0; k < width; ++k) {
        std::ptrdiff_t const at = i * stride + k;
        Real after[std::size_t{parts}], sum[std::size_t{parts}];
        for (int part = 0; part < parts; ++part) {
          after[part] = to[part][at + stride];
          sum[part] = to[part][at];
        }
        multiply_add_to(factors.ratio[i], after, sum);
        for (int part = 0; part < parts; ++part) to[part][at] = sum[part];
      }
    if (factors.periodic) close(to, stride, count, width);
  }

  KOKKOS_FORCEINLINE_FUNCTION void close(Real* const (&to)[std::size_t{parts}],
                                         std::ptrdiff_t stride, std::int32_t count,
                                         std::int32_t width) const {
    for (std::int32_t k = 0; k < width; ++k) {
      Real ends[std::size_t{parts}], end[std::size_t{parts}];
      for (int part = 0; part < parts; ++part) {
        ends[part] = to[part][k];
        end[part] = to[part][(count - 1) * stride + k];
      }
      multiply_add_to(factors.last, end, ends);
      for (std::int32_t i = 0; i < count; ++i) {
        Real sum[std::size_t{parts}];
        for (int part = 0; part < parts; ++part) sum[part] = to[part][i * stride + k];
        multiply_subtract_from(factors.closing[i], ends, sum);
        for (int part = 0; part < parts; ++part) to[part][i * stride + k] = sum[part];
      }
    }
  }
};

}  // namespace cayspin::detail
