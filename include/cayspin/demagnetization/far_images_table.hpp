// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/far_images.hpp>
#include <cayspin/demagnetization/tensor.hpp>
#include <cayspin/detail/execution.hpp>

#include <Kokkos_Core.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// Sums over far images for all distances of a lattice. They vary smoothly along axes with
/// infinitely many images. Along such an axis, if it has more than ten distances, they are computed
/// at ten points and interpolated, with an error of 1e-12, where 1 is the trace of a cell's own
/// tensor.
class FarImagesTable {
 public:
  /// The distances 0, step, .. (distances - 1) * step along an axis.
  struct Axis {
    int distances = 1;
    double step = 1;
    bool is_smooth = false;
    std::vector<double> images = {0};  ///< shifts to images that are summed one by one
  };

  FarImagesTable(FarImages const& far, std::array<Axis, 3> const& axes) {
    for (std::size_t axis = 0; axis < 3; ++axis) read(axes[axis], axis);
    auto const [nx, ny, nz] = extents_;
    sums_.resize(nx * ny * nz);
    Kokkos::parallel_for("cayspin::DemagnetizingField: far images",
                         Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, TaskIndex,
                                             Kokkos::Schedule<Kokkos::Dynamic>>(
                             0, static_cast<std::int64_t>(sums_.size()), Kokkos::ChunkSize(1)),
                         Find{*this, far, axes, sums_.data()});
    Kokkos::DefaultHostExecutionSpace().fence("cayspin::DemagnetizingField: far images");
  }

  DemagnetizingTensor operator()(std::array<int, 3> const& distance) const {
    DemagnetizingTensor sum;
    auto const& x = of_points_[0][static_cast<std::size_t>(distance[0])];
    auto const& y = of_points_[1][static_cast<std::size_t>(distance[1])];
    auto const& z = of_points_[2][static_cast<std::size_t>(distance[2])];
    for (auto const& [k, of_k] : z)
      for (auto const& [j, of_j] : y)
        for (auto const& [i, of_i] : x)
          add(sum, of_i * of_j * of_k, sums_[i + extents_[0] * (j + extents_[1] * k)]);
    return sum;
  }

 private:
  struct OfPoint {
    std::size_t point;
    double weight;
  };

  static constexpr std::size_t most_points = 10;

  void read(Axis const& axis, std::size_t number) {
    auto& points = points_[number];
    auto& of_points = of_points_[number];
    auto const distances = static_cast<std::size_t>(axis.distances);
    if (axis.is_smooth && distances > most_points) {
      double const half = 0.5 * (axis.distances - 1) * axis.step;
      for (std::size_t i = 0; i < most_points; ++i)
        points.push_back(half - half * std::cos(angle(i)));
      for (int d = 0; d < axis.distances; ++d)
        of_points.push_back(interpolated(points, d * axis.step));
    } else {
      for (std::size_t d = 0; d < distances; ++d) {
        points.push_back(static_cast<double>(d) * axis.step);
        of_points.push_back({{d, 1}});
      }
    }
    extents_[number] = points.size();
  }

  static double angle(std::size_t point) {
    return (static_cast<double>(point) + 0.5) * std::numbers::pi / most_points;
  }

  /// Returns the weights of Lagrange interpolation from Chebyshev points, by the barycentric
  /// formula.
  static std::vector<OfPoint> interpolated(std::vector<double> const& points, double at) {
    std::vector<OfPoint> weights;
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (at == points[i]) return {{i, 1}};
      double const weight = (i % 2 == 0 ? 1 : -1) * std::sin(angle(i)) / (at - points[i]);
      weights.push_back({i, weight});
      sum += weight;
    }
    for (auto& of : weights) of.weight /= sum;
    return weights;
  }

  struct Find {
    FarImagesTable const& of;
    FarImages const& far;
    std::array<Axis, 3> const& axes;
    DemagnetizingTensor* sums;

    void operator()(std::int64_t i) const {
      auto const n = static_cast<std::size_t>(i);
      auto const nx = of.extents_[0], ny = of.extents_[1];
      double const x = of.points_[0][n % nx], y = of.points_[1][n / nx % ny],
                   z = of.points_[2][n / nx / ny];
      for (double const dx : axes[0].images)
        for (double const dy : axes[1].images)
          for (double const dz : axes[2].images) add(sums[i], 1., far({x + dx, y + dy, z + dz}));
    }
  };

  std::array<std::vector<double>, 3> points_;
  std::array<std::vector<std::vector<OfPoint>>, 3> of_points_;
  std::array<std::size_t, 3> extents_{};
  std::vector<DemagnetizingTensor> sums_;
};

}  // namespace cayspin::inline v0_2::detail
