// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/solver/line_kernels.hpp>
#include <cayspin/spin_field.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// Returns the only axis along which a lattice couples, or any axis if none does; nothing if
/// several do. Sets couplings of axes without neighbours to 0.
inline std::optional<int> only_coupled_axis(Lattice const& lattice,
                                            std::array<double, 3>& couplings) {
  int only = 0, count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double& coupling = couplings[static_cast<std::size_t>(axis)];
    if (!lattice.has_neighbors(axis)) coupling = 0;
    if (coupling == 0) continue;
    only = axis;
    ++count;
  }
  return count <= 1 ? std::optional(only) : std::nullopt;
}

/// Solver for z = (c + b * K)^-1 r, with K as in Helmholtz, for lattices that couple along at most
/// one axis. There is a tridiagonal system for each line along this axis. The formula of Sherman
/// and Morrison adds the bond that closes a periodic line. Keeps the factors of the last four pairs
/// (c, b).
template <class Scalar, class MemorySpace>
class LineSolver {
  using Real = real_part_t<Scalar>;
  static constexpr int parts = real_parts<Scalar>;

 public:
  LineSolver() = default;
  LineSolver(std::string const& name, RowLayout const& layout, int axis, double coupling)
      : label_("cayspin::" + name + "::lines"), layout_(layout), axis_(axis) {
    std::int32_t const extents[3] = {layout.nx, layout.ny, layout.nz};
    count_ = static_cast<std::size_t>(extents[axis]);
    periodic_ = layout.periodic[axis] && count_ > 2;
    // A periodic axis of two sites has its bond twice.
    coupling_ = layout.periodic[axis] && count_ == 2 ? 2 * coupling : coupling;
    auto const half = count_ / 2;
    for (Kept& kept : kept_) {
      kept.memory = Kokkos::View<Scalar*, MemorySpace>(
          Kokkos::view_alloc(Kokkos::WithoutInitializing, "cayspin::" + name + "::factors"),
          3 * half);
      Scalar const* const data = kept.memory.data();
      kept.factors = {
          data, data + half, data + 2 * half, {}, {}, {}, !periodic_ ? 0 : coupling < 0 ? 1 : -1};
    }
  }

  template <class Exec, int RightHandComponents>
  void solve(Exec const& exec, double c, Scalar b,
             SiteField<Real, RightHandComponents, MemorySpace> const& r,
             SiteField<Real, 3 * parts, MemorySpace> const& z, bool conjugated = false) {
    Kept const& kept = factors_of(c, b);
    using Lines = SolveLines<Scalar, RightHandComponents>;
    Lines const lines{kept.factors, layout_,   axis_,
                      r.array(),    z.array(), conjugated ? Real(-1) : Real(1)};
    if constexpr (is_host_execution<Exec>)
      for_each_task(exec, label_, lines.tasks(host_lanes<Real>), layout_.sites(),
                    SolveLinesOnHost<Lines>{lines});
    else
      for_each_task(exec, label_, lines.tasks(1), layout_.sites(),
                    SolveLinesOnDevice<Lines>{lines});
  }

 private:
  using Number = std::complex<double>;
  struct Kept {
    double c = 0;
    Scalar b{};
    LineFactors<Scalar> factors;
    Kokkos::View<Scalar*, MemorySpace> memory;
  };

  static Number number(Scalar const& value) {
    if constexpr (parts == 1)
      return {value, 0};
    else
      return {value.real(), value.imag()};
  }
  static Scalar scalar(Number const& value) {
    if constexpr (parts == 1)
      return static_cast<Scalar>(value.real());
    else
      return {static_cast<Real>(value.real()), static_cast<Real>(value.imag())};
  }

  // Division of std::complex is slow, because it supports numbers beyond 1e154.
  static Number inverse_of(Number const& value) {
    if constexpr (parts == 1)
      return 1 / value.real();
    else
      return std::conj(value) / std::norm(value);
  }

  Kept const& factors_of(double c, Scalar b) {
    for (Kept const& kept : kept_)
      if (kept.c == c && kept.b == b) return kept;
    Kept& kept = kept_[oldest_];
    oldest_ = (oldest_ + 1) % kept_.size();
    factorize(kept, c, b);
    return kept;
  }

  void factorize(Kept& kept, double c, Scalar b) const {
    double const sign = coupling_ < 0 ? -1 : 1;
    Number const e = number(b) * std::abs(coupling_),
                 beside = sign * e;  // off-diagonal elements are -beside
    auto const half = count_ / 2;
    std::vector<Number> inverse(half), ratio(half), closing(half);
    Number reduced = count_ > 1 ? c + e : c;  // diagonal after elimination
    for (std::size_t i = 0; i < half; ++i) {
      inverse[i] = inverse_of(reduced);
      ratio[i] = beside * inverse[i];
      reduced = c + 2.0 * e - beside * ratio[i];
    }
    LineFactors<Scalar>& factors = kept.factors;
    Number const last = half > 0 ? ratio.back() : 0;
    if (count_ % 2 == 1) {
      Number const middle = inverse_of(reduced - beside * last);
      factors.middle = scalar(middle);
      factors.same = factors.other = scalar(beside * middle);
    } else {
      Number const other = inverse_of(1.0 - last * last);
      factors.other = scalar(other);
      factors.same = scalar(last * other);
    }
    if (periodic_) {
      // c + b * K = T + e * w w^T, with the matrix T of an open line and w = (1, 0, .., 0, -sign).
      // T^-1 w is even or odd like w.
      closing[0] = inverse[0];
      for (std::size_t i = 1; i < half; ++i) closing[i] = ratio[i] * closing[i - 1];
      Number after = count_ % 2 == 1 ? 0 : -sign * closing.back() / (1.0 + sign * last);
      for (std::size_t i = half; i-- > 0;) after = closing[i] += ratio[i] * after;
      Number const scale = -e / (1.0 + 2.0 * e * after);
      for (Number& value : closing) value *= scale;
    }
    auto const numbers = Kokkos::create_mirror_view(kept.memory);
    for (std::size_t i = 0; i < half; ++i) {
      numbers(i) = scalar(inverse[i]);
      numbers(half + i) = scalar(ratio[i]);
      numbers(2 * half + i) = scalar(closing[i]);
    }
    if (numbers.data() != kept.memory.data()) Kokkos::deep_copy(kept.memory, numbers);
    kept.c = c;
    kept.b = b;
  }

  std::string label_;
  RowLayout layout_;
  int axis_ = 0;
  std::size_t count_ = 0;
  bool periodic_ = false;
  double coupling_ = 0;
  std::array<Kept, 4> kept_{};
  std::size_t oldest_ = 0;
};

}  // namespace cayspin::inline v0_2::detail
