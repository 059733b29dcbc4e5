// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// One axis of a cell-centred grid, and the coarser axes of its multigrid hierarchy.
class CellAxis {
 public:
  CellAxis(std::int64_t cells, bool periodic)
      : widths_(static_cast<std::size_t>(cells), 1.0), periodic_(periodic) {}

  std::size_t cells() const { return widths_.size(); }
  std::size_t coarse_cells() const { return std::max<std::size_t>(cells() / 2, 1); }
  /// Returns the coarse cell that holds a cell. Coarse cells hold two cells; the last one holds
  /// three if the number of cells is odd.
  std::size_t parent(std::size_t cell) const { return std::min(cell / 2, coarse_cells() - 1); }

  CellAxis coarser() const {
    CellAxis coarse(static_cast<std::int64_t>(coarse_cells()), periodic_);
    for (std::size_t i = 0; i < coarse_cells(); ++i) coarse.widths_[i] = coarse_width(i);
    return coarse;
  }

  /// The second difference at a cell is to_previous * (u_previous - u) + to_next * (u_next - u).
  double to_next(std::size_t i) const {
    if (cells() == 1 || (!periodic_ && i + 1 == cells())) return 0;
    return 2 / (widths_[i] * (widths_[i] + widths_[(i + 1) % cells()]));
  }
  double to_previous(std::size_t i) const {
    if (cells() == 1 || (!periodic_ && i == 0)) return 0;
    return 2 / (widths_[i] * (widths_[i] + widths_[(i + cells() - 1) % cells()]));
  }
  /// Returns the largest to_previous + to_next. Twice this is an upper bound on the eigenvalues of
  /// minus the second difference.
  double largest_sum() const {
    double largest = 0;
    for (std::size_t i = 0; i < cells(); ++i)
      largest = std::max(largest, to_next(i) + to_previous(i));
    return largest;
  }

  /// Linear interpolation of a cell's value between the centres of coarse cells: (1 - share) times
  /// the value of its parent, plus `share` times the value of the coarse cell `beside` the parent.
  struct Interpolation {
    std::size_t beside;
    double share;
  };
  Interpolation interpolation(std::size_t cell) const {
    std::size_t const own = parent(cell), last = coarse_cells() - 1;
    if (last == 0) return {own, 0};
    double before = 0;  // from the parent's first edge to the cell's
    for (std::size_t i = 2 * own; i < cell; ++i) before += widths_[i];
    double const way = before + 0.5 * widths_[cell] - 0.5 * coarse_width(own);
    if (way == 0 || (!periodic_ && own == (way < 0 ? 0 : last))) return {own, 0};
    std::size_t const beside = way < 0 ? (own + last) % (last + 1) : (own + 1) % (last + 1);
    return {beside, 2 * std::abs(way) / (coarse_width(own) + coarse_width(beside))};
  }

  /// Restriction is the transpose of the interpolation, with each weight multiplied by the cell's
  /// width and divided by the coarse cell's. The value of coarse cell c is the weighted sum over
  /// `reach` cells, from cell 2 * c - 1 on, wrapping around.
  static constexpr std::size_t reach = 5;
  std::vector<std::array<double, reach>> restriction() const {
    std::vector<std::array<double, reach>> weights(coarse_cells(), std::array<double, reach>{});
    auto const add = [&](std::size_t to, std::size_t cell, double weight) {
      for (std::size_t k = 0; k < reach; ++k)
        if ((2 * to + k + cells() - 1) % cells() == cell) {
          weights[to][k] += weight * widths_[cell] / coarse_width(to);
          return;
        }
    };
    for (std::size_t i = 0; i < cells(); ++i) {
      auto const [beside, share] = interpolation(i);
      add(parent(i), i, 1 - share);
      if (share != 0) add(beside, i, share);
    }
    return weights;
  }

 private:
  double coarse_width(std::size_t coarse) const {
    std::size_t const end = coarse + 1 == coarse_cells() ? cells() : 2 * coarse + 2;
    double width = 0;
    for (std::size_t i = 2 * coarse; i < end; ++i) width += widths_[i];
    return width;
  }

  std::vector<double> widths_;
  bool periodic_;
};

/// Arrays of an axis for kernels.
template <class Real>
struct CellAxisArrays {
  Real const *to_previous = nullptr, *to_next = nullptr;  // multiplied by the coupling
  Real const *share = nullptr, *weights = nullptr;        // weights[k * coarse_cells + coarse]
  Real const* mean = nullptr;                             // 1 / (sum of a coarse cell's weights)
  std::int32_t const* beside = nullptr;
  std::int32_t coarse_cells = 0;
};

/// The memory of CellAxisArrays.
template <class Real, class MemorySpace>
class CellAxisTables {
 public:
  CellAxisTables() = default;
  CellAxisTables(std::string const& name, CellAxis const& axis, double coupling)
      : cells_(axis.cells()),
        coarse_cells_(axis.coarse_cells()),
        padded_((cells_ + pad - 1) / pad * pad),
        numbers_("cayspin::" + name + "::axis",
                 3 * padded_ + (CellAxis::reach + 1) * coarse_cells_),
        beside_(Kokkos::view_alloc(Kokkos::WithoutInitializing, "cayspin::" + name + "::beside"),
                cells_) {
    auto const numbers = Kokkos::create_mirror_view(numbers_);
    auto const beside = Kokkos::create_mirror_view(beside_);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers(i) = 0;
    for (std::size_t i = 0; i < cells_; ++i) {
      auto const interpolation = axis.interpolation(i);
      numbers(i) = static_cast<Real>(coupling * axis.to_previous(i));
      numbers(padded_ + i) = static_cast<Real>(coupling * axis.to_next(i));
      numbers(2 * padded_ + i) = static_cast<Real>(interpolation.share);
      beside(i) = static_cast<std::int32_t>(interpolation.beside);
    }
    auto const weights = axis.restriction();
    for (std::size_t i = 0; i < coarse_cells_; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < CellAxis::reach; ++k) {
        numbers(3 * padded_ + k * coarse_cells_ + i) = static_cast<Real>(weights[i][k]);
        sum += weights[i][k];
      }
      numbers(3 * padded_ + CellAxis::reach * coarse_cells_ + i) = static_cast<Real>(1 / sum);
    }
    if (numbers.data() != numbers_.data()) Kokkos::deep_copy(numbers_, numbers);
    if (beside.data() != beside_.data()) Kokkos::deep_copy(beside_, beside);
  }

  CellAxisArrays<Real> arrays() const {
    Real const* const data = numbers_.data();
    return {data,
            data + padded_,
            data + 2 * padded_,
            data + 3 * padded_,
            data + 3 * padded_ + CellAxis::reach * coarse_cells_,
            beside_.data(),
            static_cast<std::int32_t>(coarse_cells_)};
  }

 private:
  static constexpr std::size_t pad = 16;  // lanes of the widest pack

  std::size_t cells_ = 0, coarse_cells_ = 0, padded_ = 0;
  Kokkos::View<Real*, MemorySpace> numbers_;
  Kokkos::View<std::int32_t*, MemorySpace> beside_;
};

}  // namespace cayspin::inline v0_2::detail
