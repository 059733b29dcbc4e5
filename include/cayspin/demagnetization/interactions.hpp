// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/tensor.hpp>
#include <cayspin/detail/execution.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

namespace cayspin::inline v0_1 {

struct DemagnetizationOptions {
  double strength = 1;
  /// More images on each side than the nearest one, along the axes that have any.
  std::array<int, 3> periodic_images{};
  TensorOfCells* tensor = demagnetizing_tensor;
  /// Is given what computes the tensors of a whole lattice, and returns what that returns: for a
  /// cache. None: they are computed.
  std::function<DemagnetizingTensors(std::function<DemagnetizingTensors()> const& compute)> kept{};
};

namespace detail {

/// -strength N between the cells of a lattice, of the whole one where it is given by a part, on the
/// octant of distances that are not negative.
class InteractionsOfCells {
 public:
  InteractionsOfCells(Lattice const& lattice, DemagnetizationOptions const& options)
      : cell_(lattice.spacing), options_(options) {
    lattice.validate();
    auto const& shape = whole(lattice).shape;
    if (!std::isfinite(options.strength))
      throw std::invalid_argument("cayspin::DemagnetizingField: the strength is not finite");
    if (lattice.cell_sites != 1)
      throw std::invalid_argument(
          "cayspin::DemagnetizingField: a lattice must have one site in a cell");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (images(axis) < 0)
        throw std::invalid_argument(
            "cayspin::DemagnetizingField: the number of images is negative");
      cells_[axis] = static_cast<int>(shape[axis]);
      period_[axis] = images(axis) > 0 ? cells_[axis] : good_length(2 * cells_[axis] - 1);
    }
  }

  std::array<int, 3> const& cells() const { return cells_; }
  /// Of the convolution, which is cyclic: room for all distances, or the lattice itself.
  std::array<int, 3> const& period() const { return period_; }
  /// Distances 0 .. octant - 1 along each axis stand for all.
  int octant(std::size_t axis) const { return period_[axis] / 2 + 1; }

  /// Lines along x in the octant.
  std::int64_t lines() const { return std::int64_t{octant(1)} * octant(2); }

  /// Of all distances of some of these lines, x first, then y; those that no two cells have are 0.
  DemagnetizingTensors of_lines(std::int64_t first, std::int64_t count) const {
    if (options_.kept && count == lines())
      return options_.kept([&] { return computed(first, count); });
    return computed(first, count);
  }

 private:
  DemagnetizingTensors computed(std::int64_t first, std::int64_t lines) const {
    DemagnetizingTensors found(static_cast<std::size_t>(octant(0)) *
                               static_cast<std::size_t>(lines));
    // Near ones take longest: dealt out one by one.
    auto const count = static_cast<std::int64_t>(found.size());
    Kokkos::parallel_for(
        "cayspin::DemagnetizingField: tensors",
        Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, TaskIndex,
                            Kokkos::Schedule<Kokkos::Dynamic>>(0, count, Kokkos::ChunkSize(64)),
        Find{*this, first, found.data()});
    Kokkos::DefaultHostExecutionSpace().fence("cayspin::DemagnetizingField: tensors");
    return found;
  }

  /// With a number of factors 2, 3, 5 and 7, for which FFTs are fast.
  static int good_length(int least) {
    for (int length = least;; ++length) {
      int rest = length;
      for (int const factor : {2, 3, 5, 7})
        while (rest % factor == 0) rest /= factor;
      if (rest == 1) return length;
    }
  }

  struct Find {
    InteractionsOfCells const& of;
    std::int64_t first;
    DemagnetizingTensor* found;

    void operator()(std::int64_t i) const {
      std::int64_t const nx = of.octant(0), ny = of.octant(1), line = first + i / nx;
      found[i] = of.between(
          {static_cast<int>(i % nx), static_cast<int>(line % ny), static_cast<int>(line / ny)});
    }
  };

  int images(std::size_t axis) const { return options_.periodic_images[axis]; }

  DemagnetizingTensor between(std::array<int, 3> const& distance) const {
    DemagnetizingTensor sum;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (images(axis) == 0 && distance[axis] >= cells_[axis]) return sum;
    for (int i = -images(0); i <= images(0); ++i)
      for (int j = -images(1); j <= images(1); ++j)
        for (int k = -images(2); k <= images(2); ++k)
          add(sum, -options_.strength,
              options_.tensor(
                  {place(0, distance[0], i), place(1, distance[1], j), place(2, distance[2], k)},
                  cell_));
    return sum;
  }
  double place(std::size_t axis, int distance, int image) const {
    return (distance + static_cast<double>(image) * period_[axis]) * cell_[axis];
  }

  std::array<double, 3> cell_;
  DemagnetizationOptions options_;
  std::array<int, 3> cells_{}, period_{};
};

}  // namespace detail
}  // namespace cayspin::inline v0_1
