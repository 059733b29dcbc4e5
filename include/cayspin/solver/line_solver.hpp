// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/solver/line_kernels.hpp>
#include <cayspin/spin_field.hpp>

#include <array>
#include <complex>
#include <optional>
#include <vector>

namespace cayspin::detail {

/// The axis along which alone a lattice couples, or any one where none does. Couplings that are not
/// positive, and those of axes without neighbours, become 0.
inline std::optional<int> only_coupled_axis(Lattice const& lattice,
                                            std::array<double, 3>& couplings) {
  int only = 0, count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double& coupling = couplings[static_cast<std::size_t>(axis)];
    if (!lattice.has_neighbors(axis) || !(coupling > 0)) coupling = 0;
    if (coupling == 0) continue;
    only = axis;
    ++count;
  }
  return count <= 1 ? std::optional(only) : std::nullopt;
}

/// z = (c + b K)^-1 r where one axis alone couples: tridiagonal lines, on a periodic axis by
/// Sherman and Morrison. Factors are kept for the last few pairs (c, b).
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
    for (Kept& kept : kept_)
      kept.factors = Kokkos::View<Scalar*, MemorySpace>(
          Kokkos::view_alloc(Kokkos::WithoutInitializing, "cayspin::" + name + "::factors"),
          3 * count_);
  }

  template <class Exec, int RightHandComponents>
  void solve(Exec const& exec, double c, Scalar b,
             SiteField<Real, RightHandComponents, MemorySpace> const& r,
             SiteField<Real, 3 * parts, MemorySpace> const& z) {
    Kept const& kept = factors_of(c, b);
    Scalar const* const data = kept.factors.data();
    SolveLines<Scalar, RightHandComponents> const lines{
        {data, data + count_, data + 2 * count_, kept.last, periodic_},
        layout_,
        axis_,
        is_host_execution<Exec> ? 32 : 1,
        r.array(),
        z.array()};
    for_each_task(exec, label_, lines.tasks(), layout_.sites(), lines);
  }

 private:
  using Number = std::complex<double>;
  struct Kept {
    double c = 0;
    Scalar b{}, last{};
    Kokkos::View<Scalar*, MemorySpace> factors;
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

  Kept const& factors_of(double c, Scalar b) {
    for (Kept const& kept : kept_)
      if (kept.c == c && kept.b == b) return kept;
    Kept& kept = kept_[oldest_];
    oldest_ = (oldest_ + 1) % kept_.size();
    factorize(kept, c, b);
    return kept;
  }

  void factorize(Kept& kept, double c, Scalar b) const {
    Number const e = number(b) * coupling_;  // less what is beside the diagonal
    Number const inner = c + 2.0 * e;
    auto const n = count_;
    std::vector<Number> diagonal(n, inner), inverse(n), ratio(n), closing(n);
    if (!periodic_) {
      diagonal.front() -= e;
      diagonal.back() -= e;
    }
    // c + b K = T + (inner, .., -e)^T (-1, .., e / inner), T tridiagonal.
    if (periodic_) {
      diagonal.front() += inner;
      diagonal.back() += e * e / inner;
    }
    for (std::size_t i = 0; i < n; ++i) {
      inverse[i] = 1.0 / (i == 0 ? diagonal[i] : diagonal[i] - e * ratio[i - 1]);
      ratio[i] = e * inverse[i];
    }
    if (periodic_) {
      for (std::size_t i = 0; i < n; ++i) {
        Number const right = i == 0 ? -inner : i + 1 == n ? -e : Number(0);
        closing[i] = inverse[i] * right + (i == 0 ? Number(0) : ratio[i] * closing[i - 1]);
      }
      for (std::size_t i = n - 1; i-- > 0;) closing[i] += ratio[i] * closing[i + 1];
      Number const last = e / inner, scale = 1.0 / (1.0 + closing.front() + last * closing.back());
      for (Number& value : closing) value *= scale;
      kept.last = scalar(last);
    }
    auto const factors = Kokkos::create_mirror_view(kept.factors);
    for (std::size_t i = 0; i < n; ++i) {
      factors(i) = scalar(inverse[i]);
      factors(n + i) = scalar(ratio[i]);
      factors(2 * n + i) = scalar(closing[i]);
    }
    if (factors.data() != kept.factors.data()) Kokkos::deep_copy(kept.factors, factors);
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

}  // namespace cayspin::detail
