// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/far_images_table.hpp>
#include <cayspin/demagnetization/good_length.hpp>
#include <cayspin/demagnetization/images.hpp>
#include <cayspin/demagnetization/tensor.hpp>
#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2 {

struct DemagnetizationOptions {
  double strength = 1;
  /// For each axis: the number of images on each side beyond the nearest one; 0 for an axis that is
  /// not periodic. infinitely_many_images is allowed along one or two axes. Along three, the sum
  /// would depend on the shape of the body.
  std::array<int, 3> periodic_images{};
  TensorOfCells* tensor = demagnetizing_tensor;
  /// Cache for the tensors of a whole lattice, times -strength. It receives the function that
  /// computes them, and returns that function's result or a stored one; another number of tensors
  /// throws std::invalid_argument. Empty: no cache.
  std::function<DemagnetizingTensors(std::function<DemagnetizingTensors()> const& compute)> kept{};
};

namespace detail {

/// Interactions -strength * N between the cells of a lattice, for the octant of non-negative
/// distances. For a part of a lattice, they are the interactions of the whole lattice.
class InteractionsOfCells {
 public:
  InteractionsOfCells(Lattice const& lattice, DemagnetizationOptions const& options)
      : cell_(lattice.spacing), options_(options) {
    lattice.validate();
    require_one_replica("cayspin::DemagnetizingField", lattice);
    auto const& shape = whole(lattice).shape;
    if (!std::isfinite(options.strength))
      throw std::invalid_argument("cayspin::DemagnetizingField: the strength is not finite");
    if (lattice.cell_sites != 1)
      throw std::invalid_argument(
          "cayspin::DemagnetizingField: a lattice must have one site in a cell");
    auto const [shortest, longest] = std::ranges::minmax(cell_);
    if (longest > largest_edge_ratio * shortest)
      throw std::invalid_argument(
          "cayspin::DemagnetizingField: the edges of a cell differ by more than 1e9 : 1");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (images(axis) < 0)
        throw std::invalid_argument(
            "cayspin::DemagnetizingField: the number of images is negative");
      cells_[axis] = static_cast<int>(shape[axis]);
      period_[axis] = images(axis) > 0 ? cells_[axis] : good_length(2 * cells_[axis] - 1);
    }
    choose_nearest();
  }

  std::array<int, 3> const& cells() const { return cells_; }
  /// Returns the extents of the cyclic convolution in cells: those of the lattice along axes with
  /// images, and enough for all distances along the others.
  std::array<int, 3> const& period() const { return period_; }
  /// Returns the number of distances that are stored along an axis, 0 .. octant - 1. Symmetry gives
  /// the others.
  int octant(std::size_t axis) const { return period_[axis] / 2 + 1; }

  /// Returns the number of lines along x in the octant.
  std::int64_t lines() const { return std::int64_t{octant(1)} * octant(2); }

  /// Returns the tensors, times -strength, of `count` lines from number `first` on, for all
  /// distances of the octant along x. The distance along x varies fastest, then that along y.
  /// Tensors are 0 for distances that no two cells have.
  DemagnetizingTensors of_lines(std::int64_t first, std::int64_t count) const {
    if (!options_.kept || count != lines()) return computed(first, count);
    auto tensors = options_.kept([&] { return computed(first, count); });
    std::int64_t const expected = octant(0) * count;
    if (static_cast<std::int64_t>(tensors.size()) != expected)
      throw std::invalid_argument("cayspin::DemagnetizingField: the cache returned " +
                                  std::to_string(tensors.size()) + " tensors; accepted: the " +
                                  std::to_string(expected) + " of this lattice");
    return tensors;
  }

 private:
  DemagnetizingTensors computed(std::int64_t first, std::int64_t lines) const {
    DemagnetizingTensors found(static_cast<std::size_t>(octant(0)) *
                               static_cast<std::size_t>(lines));
    auto const far = far_images();
    // Near cells take longest, so threads fetch small chunks of work as they finish.
    auto const count = static_cast<std::int64_t>(found.size());
    Kokkos::parallel_for(
        "cayspin::DemagnetizingField: tensors",
        Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, TaskIndex,
                            Kokkos::Schedule<Kokkos::Dynamic>>(0, count, Kokkos::ChunkSize(64)),
        Find{*this, first, far ? &*far : nullptr, found.data()});
    Kokkos::DefaultHostExecutionSpace().fence("cayspin::DemagnetizingField: tensors");
    return found;
  }

  struct Find {
    InteractionsOfCells const& of;
    std::int64_t first;
    FarImagesTable const* far;
    DemagnetizingTensor* found;

    void operator()(std::int64_t i) const {
      std::int64_t const nx = of.octant(0), ny = of.octant(1), line = first + i / nx;
      found[i] = of.between(
          {static_cast<int>(i % nx), static_cast<int>(line % ny), static_cast<int>(line / ny)},
          far);
    }
  };

  int images(std::size_t axis) const { return options_.periodic_images[axis]; }
  bool is_infinite(std::size_t axis) const { return images(axis) == infinitely_many_images; }
  double period_length(std::size_t axis) const { return cells_[axis] * cell_[axis]; }

  /// Chooses how many images to sum one by one. Along an axis with infinitely many, these are the
  /// ones within twice the longest period of such axes; FarImages adds the others.
  void choose_nearest() {
    nearest_ = options_.periodic_images;
    std::vector<double> periods;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (is_infinite(axis)) periods.push_back(period_length(axis));
    if (periods.empty()) return;
    auto const [shortest, longest] = std::ranges::minmax(periods);
    if (periods.size() == 3)
      throw std::invalid_argument(
          "cayspin::DemagnetizingField: infinitely many images along three axes");
    if (longest > largest_period_ratio * shortest)
      throw std::invalid_argument(
          "cayspin::DemagnetizingField: infinitely many images along axes whose lengths differ by "
          "more than 1e4 : 1");
    if (options_.tensor != demagnetizing_tensor)
      throw std::invalid_argument(
          "cayspin::DemagnetizingField: infinitely many images with a tensor of one's own");
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (is_infinite(axis))
        nearest_[axis] = static_cast<int>(std::ceil(2 * longest / period_length(axis)));
  }

  /// Returns the table of far images, or nothing if no axis has infinitely many.
  std::optional<FarImagesTable> far_images() const {
    std::array<double, 3> period{};
    std::array<FarImagesTable::Axis, 3> axes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      axes[axis].step = cell_[axis];
      axes[axis].distances = images(axis) > 0 ? octant(axis) : cells_[axis];
      axes[axis].is_smooth = is_infinite(axis);
      if (is_infinite(axis)) {
        period[axis] = period_length(axis);
      } else if (images(axis) > 0) {
        axes[axis].images.clear();
        for (int image = -images(axis); image <= images(axis); ++image)
          axes[axis].images.push_back(image * period_length(axis));
      }
    }
    if (period == std::array<double, 3>{}) return std::nullopt;
    return FarImagesTable(FarImages(cell_, period, nearest_), axes);
  }

  DemagnetizingTensor between(std::array<int, 3> const& distance, FarImagesTable const* far) const {
    DemagnetizingTensor sum;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (images(axis) == 0 && distance[axis] >= cells_[axis]) return sum;
    if (far != nullptr) add(sum, -options_.strength, (*far)(distance));
    auto const [x, y, z] = nearest_;
    for (int i = -x; i <= x; ++i)
      for (int j = -y; j <= y; ++j)
        for (int k = -z; k <= z; ++k)
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
  std::array<int, 3> cells_{}, period_{}, nearest_{};
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
