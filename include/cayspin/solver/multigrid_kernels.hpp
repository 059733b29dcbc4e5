// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/solver/alternating_signs.hpp>
#include <cayspin/solver/cell_grid.hpp>

#include <complex>
#include <cstddef>
#include <cstdint>

// Relaxation on one grid. K >= 0 is -J times the discrete Laplacian.
namespace cayspin::inline v0_2::detail {

/// The operator 1 + b * K, and the weight of a relaxation.
template <class Real>
struct ShiftedExchange {
  using Coefficient = double;
  static constexpr int right_components = 3;

  Real b, weight;

  /// Returns the operation whose relaxation is exact for waves with the frequency (eigenvalue) s of
  /// K.
  static ShiftedExchange relaxing(double b, double s) {
    return {static_cast<Real>(b), static_cast<Real>(1 / (1 + b * s))};
  }

  template <class Value, class Right>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> relaxed(Vec3<Value> const& u, Vec3<Value> const& ku,
                                                  Right const& right,
                                                  CellPlace const& place) const {
    return multiply_add(Value(weight), residual(u, ku, right, place), u);
  }
  template <class Value, class Right>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> residual(Vec3<Value> const& u, Vec3<Value> const& ku,
                                                   Right const& right,
                                                   CellPlace const& place) const {
    return multiply_add(Value(Real(-b)), ku, right.template load<Value>(place) - u);
  }
  /// Returns u after a relaxation that starts from u = 0.
  template <class Value, class Right>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> first(Right const& right, CellPlace const& place) const {
    return Value(weight) * right.template load<Value>(place);
  }
};

/// The operator 1 + b * K on vectors normal to m, with a complex b, in which i stands for the
/// operator m x: spin waves about directions m. The directions are stored in components 3 to 5 of
/// the right-hand side. On coarse grids m is a mean, and shorter than 1 where directions differ.
/// The shorter m is, the closer the operator is to 1 + |b| * K.
template <class Real>
struct ShiftedSpinWaves {
  using Coefficient = std::complex<double>;
  static constexpr int right_components = 6;

  Real magnitude, along, turned;  // |b|, and the real and imaginary parts of b
  Real weight, weight_turned;     // real and imaginary parts of the weight

  static ShiftedSpinWaves relaxing(Coefficient b, double s) {
    Coefficient const weight = 1.0 / (1.0 + b * s);
    return {static_cast<Real>(std::abs(b)), static_cast<Real>(b.real()),
            static_cast<Real>(b.imag()), static_cast<Real>(weight.real()),
            static_cast<Real>(weight.imag())};
  }

  template <class Value, class Right>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> relaxed(Vec3<Value> const& u, Vec3<Value> const& ku,
                                                  Right const& right,
                                                  CellPlace const& place) const {
    Vec3<Value> const f = right.template load<Value>(place),
                      m = right.template load<Value>(place, 3), turned_ku = cross(m, ku);
    Value const shortness = multiply_add(Value(magnitude), dot(m, m), Value(Real(-magnitude)));
    // m x (m x v) is -|m|^2 v for vectors v normal to m.
    Vec3<Value> const rest =
        multiply_add(shortness, ku,
                     multiply_add(Value(along), cross(m, turned_ku),
                                  multiply_add(Value(Real(-turned)), turned_ku, f - u)));
    return weighted(m, rest, u);
  }
  template <class Value, class Right>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> first(Right const& right, CellPlace const& place) const {
    return weighted(right.template load<Value>(place, 3), right.template load<Value>(place),
                    zero<Value>());
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> weighted(Vec3<Value> const& m, Vec3<Value> const& rest,
                                                   Vec3<Value> const& u) const {
    return multiply_add(Value(weight_turned), cross(m, rest), multiply_add(Value(weight), rest, u));
  }
};

/// Functor that writes u after a relaxation, or the residual, to out.
template <class Operation, bool Residual, class Real, class OutReal>
struct RelaxCells {
  CellGrid<Real> grid;
  Operation operation;
  CellArray<Real, 3> u;
  CellArray<Real, Operation::right_components> right;
  CellArray<OutReal, 3> out;
  bool goes_around;  // x is periodic

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    Real const* const at = u.at(place);
    Vec3<Value> const here = u.template load<Value>(place);
    Vec3<Value> beside = zero<Value>();
    Value sum(0);
    add(beside, sum, at + to_previous<0, Value>(place.x),
        load<Value>(grid.axis[0].to_previous + place.x));
    add(beside, sum, at + to_next<0, Value>(place.x), load<Value>(grid.axis[0].to_next + place.x));
    add_axis<1>(beside, sum, at, place.y, u.pitch);
    if (grid.extent[2] > 1) add_axis<2>(beside, sum, at, place.z, u.plane);
    Vec3<Value> const ku = sum * here - beside;
    if constexpr (Residual)
      out.store(operation.residual(here, ku, right, place), place, grid.extent[0]);
    else
      out.store(operation.relaxed(here, ku, right, place), place, grid.extent[0]);
  }

 private:
  // At the ends of a row, packs read padding. At an open end, the coupling to it is zero; at a
  // periodic end, RowOfCells computes the cell again by itself.
  template <int Axis, class Value>
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t to_previous(std::int32_t index) const {
    if (lanes_of<Value> > 1 && Axis == 0) return -1;
    return index > 0 ? -1 : grid.periodic[Axis] ? grid.extent[Axis] - 1 : 0;
  }
  template <int Axis, class Value>
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t to_next(std::int32_t index) const {
    if (lanes_of<Value> > 1 && Axis == 0) return 1;
    return index + 1 < grid.extent[Axis] ? 1 : grid.periodic[Axis] ? 1 - grid.extent[Axis] : 0;
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add(Vec3<Value>& beside, Value& sum, Real const* there,
                                       Value const& coupling) const {
    Vec3<Value> const v{load<Value>(there), load<Value>(there + u.stride),
                        load<Value>(there + 2 * u.stride)};
    beside = multiply_add(coupling, v, beside);
    sum = sum + coupling;
  }
  template <int Axis, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void add_axis(Vec3<Value>& beside, Value& sum, Real const* at,
                                            std::int32_t index, std::ptrdiff_t stride) const {
    auto const& axis = grid.axis[Axis];
    add(beside, sum, at + to_previous<Axis, Value>(index) * stride, Value(axis.to_previous[index]));
    add(beside, sum, at + to_next<Axis, Value>(index) * stride, Value(axis.to_next[index]));
  }
};

/// Functor that keeps only the part of u normal to m, since ShiftedSpinWaves is for such vectors.
/// Where m is shorter than 1, a part along m is left.
template <class Real>
struct KeepAcross {
  std::int32_t nx;
  CellArray<Real, 6> right;
  CellArray<Real, 3> u;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    Vec3<Value> const here = u.template load<Value>(place),
                      m = right.template load<Value>(place, 3);
    u.store(multiply_add(Value(-dot(m, here)), m, here), place, nx);
  }
};

/// Functor that writes to `out` the u after a relaxation that starts from u = 0.
template <class Operation, class Real, class OutReal>
struct RelaxZero {
  std::int32_t nx;
  Operation operation;
  CellArray<Real, Operation::right_components> right;
  CellArray<OutReal, 3> out;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    out.store(operation.template first<Value>(right, place), place, nx);
  }
};

/// Functor that writes scale * sign * r, with the alternating signs, to `to`, which may be r. It
/// does not write to the padding, which stays zero.
template <class FromReal, class Real>
struct ScaleCells {
  CellArray<FromReal, 3> r;
  CellArray<Real, 3> to;
  FromReal scale;
  AlternatingSigns signs;

  KOKKOS_FORCEINLINE_FUNCTION void row(CellPlace const& place, std::int32_t nx) const {
    FromReal const first = scale * signs.first_of_row<FromReal>(place.y, place.z);
    FromReal const other = signs.along[0] ? -first : first;
    FromReal const even = place.x % 2 == 0 ? first : other, odd = place.x % 2 == 0 ? other : first;
    for (int component = 0; component < 3; ++component) {
      FromReal const* const from = r.at(place) + component * r.stride;
      Real* const out = to.at(place) + component * to.stride;
      CAYSPIN_DETAIL_INDEPENDENT
      for (std::int32_t x = 0; x < nx; ++x)
        out[x] = static_cast<Real>((x % 2 == 0 ? even : odd) * from[x]);
    }
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    row(place, 1);
  }
};

/// Functor that writes (r x m, m), with m of length 1, or 0 where there is no spin: a right-hand
/// side of ShiftedSpinWaves. If d is the solution for this right-hand side, m x d is the solution
/// for r. If r has six components (r', r''), it stands for r' + sign * m x r''. `same_directions`:
/// `to` holds m already, and m is not written.
template <int Components, class FromReal, class Real>
struct TurnRightSide {
  std::int32_t nx;
  FromReal sign;
  CellArray<FromReal, Components> r;
  CellArray<FromReal, 3> m;
  CellArray<Real, 6> to;
  bool same_directions;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(CellPlace const& place) const {
    Vec3<Value> const a = r.template load<Value>(place), spin = m.template load<Value>(place);
    Value const square = dot(spin, spin) + as_value<Value>(1e-30);
    Vec3<Value> const n = Value(as_value<Value>(1) / square_root(square)) * spin;
    Vec3<Value> right = cross(a, n);
    if constexpr (Components == 6)
      right = multiply_add(as_value<Value>(sign), r.template load<Value>(place, 3), right);
    to.store(right, place, nx);
    if (!same_directions) to.store(n, place, nx, 3);
  }
};

}  // namespace cayspin::inline v0_2::detail
