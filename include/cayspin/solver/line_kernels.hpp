// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/row_layout.hpp>
#include <cayspin/solver/coefficient_scalar.hpp>

#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// Coefficients for solving lines from both ends; both halves of a line have equal factors. In each
/// half, i counts the sites from the end of the line. The first pass goes towards the middle:
/// y_i = inverse_i * r_i + ratio_i * y_(i-1). The second pass goes back:
/// z_i = y_i + ratio_i * z_(i+1).
/// For the innermost i, z_(i+1) is same * y + other * y' + middle * r, where y and y' are the
/// innermost values of this half and of the other half, and r belongs to the middle site of a line
/// with an odd number of sites (otherwise r = 0). On a periodic line,
/// closing_i * (z_0 + sign * z_0') is finally added to z_i, where z_0' is at the other end.
template <class Scalar>
struct LineFactors {
  Scalar const *inverse = nullptr, *ratio = nullptr, *closing = nullptr;
  Scalar same{}, other{}, middle{};
  int sign = 0;  // 0 on an open line
};

/// Offset of a site of a line, and the distance to its mirror image in the line.
struct LinePlace {
  std::ptrdiff_t at, to_mirror;
};

/// Three components at a place and three at its mirror image. They belong to as many lines as Value
/// has lanes, adjacent along x. If InLanes, they belong to one line and fill the lanes.
template <class Value, int Parts, bool InLanes>
struct LineEnds {
  using Real = scalar_t<Value>;
  static constexpr int lanes = lanes_of<Value>, count = InLanes ? (6 + lanes - 1) / lanes : 6;

  Value values[std::size_t{count}][std::size_t{Parts}];

  LineEnds() = default;
  KOKKOS_FORCEINLINE_FUNCTION static LineEnds zero() {
    LineEnds ends;
    for (auto& value : ends.values)
      for (Value& part : value) part = Value(Real(0));
    return ends;
  }

  template <class Array>
  KOKKOS_FORCEINLINE_FUNCTION LineEnds(Array const& array, LinePlace const& place) {
    for (int part = 0; part < Parts; ++part) {
      Real const* const from = array.data + 3 * part * array.stride + place.at;
      for (int i = 0; i < count; ++i) {
        if constexpr (InLanes)
          values[i][part] = Value([&](auto lane) {
            int const number = i * lanes + static_cast<int>(lane());
            return number < 6 ? from[offset(number, array.stride, place)] : Real(0);
          });
        else
          values[i][part] = load<Value>(from + offset(i, array.stride, place));
      }
    }
  }

  template <class Array>
  KOKKOS_FORCEINLINE_FUNCTION void store_in(Array const& array, LinePlace const& place) const {
    for (int part = 0; part < Parts; ++part) {
      Real* const to = array.data + 3 * part * array.stride + place.at;
      if constexpr (InLanes) {
        Real numbers[std::size_t{count * lanes}];
        for (int i = 0; i < count; ++i) store(values[i][part], numbers + i * lanes);
        for (int i = 0; i < 6; ++i) to[offset(i, array.stride, place)] = numbers[i];
      } else {
        for (int i = 0; i < 6; ++i) store(values[i][part], to + offset(i, array.stride, place));
      }
    }
  }

  /// Returns these ends with the imaginary part multiplied by sign.
  KOKKOS_FORCEINLINE_FUNCTION LineEnds with_imaginary(Real sign) const {
    LineEnds ends = *this;
    if constexpr (Parts == 2)
      for (auto& value : ends.values) value[1] = Value(sign) * value[1];
    return ends;
  }
  /// Adds a * x.
  template <class Scalar, int XParts>
  KOKKOS_FORCEINLINE_FUNCTION void add(Scalar const& a, LineEnds<Value, XParts, InLanes> const& x) {
    for (int i = 0; i < count; ++i) multiply_add_to(a, x.values[i], values[i]);
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION static std::ptrdiff_t offset(int i, std::ptrdiff_t stride,
                                                           LinePlace const& place) {
    return i % 3 * stride + (i < 3 ? 0 : place.to_mirror);
  }
};

/// Functor that solves the lines along an axis.
template <class Scalar, int RightHandComponents>
struct SolveLines {
  using Real = real_part_t<Scalar>;
  static constexpr int parts = real_parts<Scalar>, right_parts = RightHandComponents / 3;

  LineFactors<Scalar> factors;
  RowLayout layout;
  int axis;
  SiteArray<Real, RightHandComponents> r;
  SiteArray<Real, 3 * parts> z;
  Real imaginary_sign;  // multiplies the imaginary part of r

  /// Returns the number of tasks side by side along x. A task is one line along x; along other axes
  /// it is as many adjacent lines as there are lanes.
  KOKKOS_FUNCTION std::int64_t tasks_across(int lanes) const {
    return axis == 0 ? 1 : (layout.nx + lanes - 1) / lanes;
  }
  std::int64_t tasks(int lanes) const {
    return tasks_across(lanes) * (axis == 0 ? layout.rows() : axis == 1 ? layout.nz : layout.ny);
  }

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void run(std::int64_t task) const {
    constexpr int lanes = lanes_of<Value>;
    if (axis == 0) return solve<Value, (lanes > 1)>(layout.row_offset(task));
    std::int64_t const line = task / tasks_across(lanes), x = task % tasks_across(lanes) * lanes;
    solve<Value, false>(x + line * (axis == 1 ? layout.plane : layout.pitch));
  }

 private:
  template <class Value, bool InLanes>
  KOKKOS_FORCEINLINE_FUNCTION void solve(std::ptrdiff_t begin) const {
    using Ends = LineEnds<Value, parts, InLanes>;
    using RightEnds = LineEnds<Value, right_parts, InLanes>;
    std::int32_t const count = axis == 0 ? layout.nx : axis == 1 ? layout.ny : layout.nz;
    std::int32_t const half = count / 2;
    std::ptrdiff_t const step = axis == 0 ? 1 : axis == 1 ? layout.pitch : layout.plane;
    auto const place = [&](std::int32_t i) {
      return LinePlace{begin + i * step, (count - 1 - 2 * i) * step};
    };
    // Short lines along x keep y in packs, which would otherwise be unpacked into z and packed
    // again.
    constexpr std::int32_t most_kept = InLanes ? 512 : 1;
    Ends kept[std::size_t{most_kept}];
    bool const keeps = InLanes && half <= most_kept;
    Ends before = Ends::zero();
    for (std::int32_t i = 0; i < half; ++i) {
      Ends y = Ends::zero();
      y.add(factors.inverse[i], RightEnds(r, place(i)).with_imaginary(imaginary_sign));
      y.add(factors.ratio[i], before);
      if (keeps)
        kept[i] = y;
      else
        y.store_in(z, place(i));
      before = y;
    }
    Ends after = Ends::zero();
    after.add(factors.same, before);
    if (half > 0) {
      before.store_in(z, place(half - 1));
      after.add(factors.other, Ends(z, place(count - half)));
    }
    if (count % 2 == 1) {
      after.add(factors.middle, RightEnds(r, place(half)).with_imaginary(imaginary_sign));
      after.store_in(z, place(half));
    }
    for (std::int32_t i = half - 1; i >= 0; --i) {
      Ends here = keeps ? kept[i] : Ends(z, place(i));
      here.add(factors.ratio[i], after);
      here.store_in(z, place(i));
      after = here;
    }
    if (factors.sign == 0) return;
    after.add(Scalar(static_cast<Real>(factors.sign)), Ends(z, place(count - 1)));
    for (std::int32_t i = 0; i < half; ++i) {
      Ends here(z, place(i));
      here.add(factors.closing[i], after);
      here.store_in(z, place(i));
    }
  }
};

/// Functor that runs a task of SolveLines on a host, with packs.
template <class Lines>
struct SolveLinesOnHost {
  Lines lines;

  CAYSPIN_DETAIL_NOINLINE void operator()(std::int64_t task) const {
    Lines const local = lines;
    local.template run<Pack<typename Lines::Real>>(task);
  }
};
template <class Lines>
struct SolveLinesOnDevice {
  Lines lines;

  KOKKOS_FUNCTION void operator()(std::int64_t task) const {
    lines.template run<typename Lines::Real>(task);
  }
};

}  // namespace cayspin::inline v0_2::detail
