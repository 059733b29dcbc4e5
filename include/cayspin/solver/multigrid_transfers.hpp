// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/solver/cell_grid.hpp>

#include <cstddef>
#include <cstdint>

// Transfers between a grid and the next coarser one, one axis at a time.
namespace cayspin::inline v0_2::detail {

/// Zeroes the padding after a row, up to the end of a pack, because packs read it and multiply it
/// by zero.
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION void clear_beside_row(Real* row, std::int32_t nx) {
  for (std::int32_t x = nx; x % host_lanes<Real> != 0; ++x) row[x] = 0;
}

/// Restriction along y or z: `to` has about half the cells along the axis. Components from the
/// fourth on are directions, and become means instead.
template <class Real, int Components>
struct RestrictRows {
  int axis;
  std::int32_t extent;  // of the fine grid
  CellAxisArrays<Real> numbers;
  CellArray<Real, Components> from, to;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    std::int32_t const coarse = axis == 1 ? place.y : place.z;
    CellPlace first = place;
    (axis == 1 ? first.y : first.z) = 0;
    std::ptrdiff_t const stride = axis == 1 ? from.pitch : from.plane;
    Real const* const source = from.at(first);
    Real* const target = to.at(place);
    for (int component = 0; component < Components; ++component) {
      Value sum(0);
      for (std::int32_t k = 0; k < static_cast<std::int32_t>(CellAxis::reach); ++k) {
        Real const weight = numbers.weights[k * numbers.coarse_cells + coarse];
        if (weight == 0) continue;
        std::ptrdiff_t const row = (2 * coarse + k + extent - 1) % extent;
        sum = multiply_add(Value(weight),
                           load<Value>(source + component * from.stride + row * stride), sum);
      }
      if (component >= 3) sum = Value(numbers.mean[coarse]) * sum;
      store(sum, target + component * to.stride);
    }
  }
};

/// Restriction along x.
template <class Real, int Components>
struct RestrictAlongRows {
  std::int32_t extent, coarse_extent;
  CellAxisArrays<Real> numbers;
  CellArray<Real, Components> from, to;

  KOKKOS_FORCEINLINE_FUNCTION void row(CellPlace const& place, std::int32_t) const {
    std::int32_t const cells = coarse_extent;
    Real const *const w0 = numbers.weights, *const w1 = w0 + cells, *const w2 = w1 + cells,
                      *const w3 = w2 + cells;
    for (int component = 0; component < Components; ++component) {
      Real const* const source = from.at(place) + component * from.stride;
      Real* const target = to.at(place) + component * to.stride;
      target[0] = sum(source, 0);
      CAYSPIN_DETAIL_INDEPENDENT
      for (std::int32_t i = 1; i < cells - 2; ++i)
        target[i] = w0[i] * source[2 * i - 1] + w1[i] * source[2 * i] + w2[i] * source[2 * i + 1] +
                    w3[i] * source[2 * i + 2];
      // The last coarse cell may hold three cells, and the one before it reads some of these, too.
      for (std::int32_t i = cells > 3 ? cells - 2 : 1; i < cells; ++i) target[i] = sum(source, i);
      Real const* const mean = numbers.mean;
      if (component >= 3) {
        CAYSPIN_DETAIL_INDEPENDENT
        for (std::int32_t i = 0; i < cells; ++i) target[i] *= mean[i];
      }
      clear_beside_row<Real>(target, cells);
    }
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    CellPlace first = place;
    first.x = 0;
    for (int component = 0; component < Components; ++component)
      to.at(place)[component * to.stride] = sum(from.at(first) + component * from.stride, place.x) *
                                            (component >= 3 ? numbers.mean[place.x] : Real(1));
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION Real sum(Real const* source, std::int32_t coarse) const {
    Real sum = 0;
    for (std::int32_t k = 0; k < static_cast<std::int32_t>(CellAxis::reach); ++k)
      sum += numbers.weights[k * coarse_extent + coarse] *
             source[(2 * coarse + k + extent - 1) % extent];
    return sum;
  }
};

/// Interpolation along y or z: `to` has about twice the cells along the axis. If Adds, it adds to
/// the values of `to`; otherwise it replaces them.
template <class Real, bool Adds>
struct InterpolateRows {
  int axis;
  std::int32_t coarse_extent;
  CellAxisArrays<Real> numbers;
  std::int32_t nx;
  CellArray<Real, 3> from, to;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    std::int32_t const fine = axis == 1 ? place.y : place.z;
    CellPlace own = place, beside = place;
    std::int32_t const parent = fine / 2 < coarse_extent ? fine / 2 : coarse_extent - 1;
    (axis == 1 ? own.y : own.z) = parent;
    (axis == 1 ? beside.y : beside.z) = numbers.beside[fine];
    Real const share = numbers.share[fine];
    Vec3<Value> const before = Adds ? to.template load<Value>(place) : zero<Value>();
    to.store(
        multiply_add(Value(share), from.template load<Value>(beside),
                     multiply_add(Value(Real(1) - share), from.template load<Value>(own), before)),
        place, nx);
  }
};

/// Interpolation along x.
template <class Real, bool Adds>
struct InterpolateAlongRows {
  std::int32_t extent, coarse_extent;
  CellAxisArrays<Real> numbers;
  CellArray<Real, 3> from, to;

  KOKKOS_FORCEINLINE_FUNCTION void row(CellPlace const& place, std::int32_t) const {
    Real const* const share = numbers.share;
    std::int32_t const end = coarse_extent - 1;
    for (int component = 0; component < 3; ++component) {
      Real const* const source = from.at(place) + component * from.stride;
      Real* const target = to.at(place) + component * to.stride;
      for (std::int32_t x = 0; x < 2; ++x) put(target[x], value(source, x));
      // The first cell of a pair is next to the previous pair, the second next to the following
      // pair.
      CAYSPIN_DETAIL_INDEPENDENT
      for (std::int32_t i = 1; i < end; ++i) {
        Real const first = share[2 * i], second = share[2 * i + 1], own = source[i];
        put(target[2 * i], own + first * (source[i - 1] - own));
        put(target[2 * i + 1], own + second * (source[i + 1] - own));
      }
      for (std::int32_t x = end > 0 ? 2 * end : 2; x < extent; ++x)
        put(target[x], value(source, x));
      clear_beside_row<Real>(target, extent);
    }
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    CellPlace first = place;
    first.x = 0;
    for (int component = 0; component < 3; ++component)
      put(to.at(place)[component * to.stride],
          value(from.at(first) + component * from.stride, place.x));
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION static void put(Real& target, Real value) {
    target = Adds ? target + value : value;
  }
  KOKKOS_FORCEINLINE_FUNCTION Real value(Real const* source, std::int32_t x) const {
    Real const own = source[x / 2 < coarse_extent ? x / 2 : coarse_extent - 1];
    return own + numbers.share[x] * (source[numbers.beside[x]] - own);
  }
};

}  // namespace cayspin::inline v0_2::detail
