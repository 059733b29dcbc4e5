// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/crystal.hpp>
#include <cayspin/demagnetization/dipole_images.hpp>
#include <cayspin/demagnetization/dipole_tensor.hpp>
#include <cayspin/demagnetization/good_length.hpp>
#include <cayspin/demagnetization/images.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2 {

struct DipolarOptions {
  double strength = 1;
  /// For each vector of the cell: the number of images on each side beyond the nearest one; 0 for a
  /// vector along which the lattice is not periodic. infinitely_many_images along one vector can be
  /// combined only with itself or 0 along another.
  std::array<int, 3> periodic_images{};
  /// Demagnetising factors N along x, y and z of the body that the images fill: its mean
  /// magnetization M adds the field -strength * N * M. The factors are used only with infinitely
  /// many images along all three vectors. 0: the body has no poles on its surface.
  std::array<double, 3> demagnetizing_factors{};
};

namespace detail {

/// Tensors between the sites of a crystal's cells. For a part of a lattice, they are the tensors of
/// the whole lattice. period() returns the extents of the cyclic convolution in cells: those of the
/// lattice along vectors with images, and enough for all distances along the others.
class InteractionsOfDipoles {
 public:
  InteractionsOfDipoles(Lattice const& lattice, Crystal crystal, DipolarOptions const& options)
      : crystal_(std::move(crystal)), options_(options) {
    lattice.validate();
    require_one_replica("cayspin::DipolarField", lattice);
    crystal_.validate();
    auto const& shape = whole(lattice).shape;
    require(lattice.cell_sites == static_cast<std::int64_t>(crystal_.basis.size()),
            "the lattice and the crystal differ in the sites of a cell");
    require(std::isfinite(options.strength), "the strength is not finite");
    for (double const factor : options.demagnetizing_factors)
      require(std::isfinite(factor), "a demagnetizing factor is not finite");
    for (auto& vector : crystal_.cell)
      for (std::size_t axis = 0; axis < 3; ++axis) vector[axis] *= lattice.spacing[axis];
    std::vector<Point> periods;
    bool has_number = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      int const images = options.periodic_images[axis];
      require(images >= 0, "the number of images is negative");
      auto const extent = axis == 2 ? shape[axis] / lattice.cell_sites : shape[axis];
      cells_[axis] = static_cast<int>(extent);
      period_[axis] = images > 0 ? cells_[axis] : good_length(2 * cells_[axis] - 1);
      if (images == infinitely_many_images)
        periods.push_back(add_scaled(cells_[axis], crystal_.cell[axis], {}));
      else if (images > 0)
        has_number = true;
    }
    require(periods.empty() || !has_number,
            "a number of images along one axis, and infinitely many along another");
    if (!periods.empty()) {
      auto const [shortest, longest] = std::ranges::minmax(
          periods, {}, [](Point const& period) { return detail::length(period); });
      require(length(longest) <= largest_period_ratio * length(shortest),
              "infinitely many images along axes whose lengths differ by more than 1e4 : 1");
      images_.emplace(periods);
    }
    auto const [x, y, z] = lattice.spacing;
    scale_ = options.strength * x * y * z;
    if (periods.size() == 3)
      for (std::size_t axis = 0; axis < 3; ++axis)
        of_shape_[axis] = scale_ * options.demagnetizing_factors[axis] /
                          (crystal_.volume() * cells_[0] * cells_[1] * cells_[2]);
  }

  std::array<int, 3> const& cells() const { return cells_; }
  std::array<int, 3> const& period() const { return period_; }
  std::size_t sites() const { return crystal_.basis.size(); }

  /// Returns T with H = T m, strength included, for a dipole m at the site `source` of one cell and
  /// H at the site `site` of another or the same cell. `distance`: from the cell of m to that of H,
  /// as indices of the cyclic convolution, so that negative distances count from the end. T is 0
  /// for distances that no two cells have.
  DipoleTensor between(std::array<int, 3> const& distance, std::size_t site,
                       std::size_t source) const {
    DipoleTensor sum;
    Point basis{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      basis = add_scaled(crystal_.basis[site][axis] - crystal_.basis[source][axis],
                         crystal_.cell[axis], basis);
    std::array<Steps, 3> steps;
    for (std::size_t axis = 0; axis < 3; ++axis) steps[axis] = steps_of(axis, distance[axis]);
    auto const& [a, b, c] = crystal_.cell;
    for (auto const& i : steps[0])
      for (auto const& j : steps[1])
        for (auto const& k : steps[2]) {
          auto const r =
              add_scaled(i.cells, a, add_scaled(j.cells, b, add_scaled(k.cells, c, basis)));
          sum.add(i.weight * j.weight * k.weight, images_ ? (*images_)(r) : dipole_tensor(r));
        }
    DipoleTensor result;
    result.add(scale_ / (4 * std::numbers::pi), sum);
    result.xx -= of_shape_[0], result.yy -= of_shape_[1], result.zz -= of_shape_[2];
    return result;
  }

 private:
  struct Step {
    double cells, weight;
  };
  using Steps = std::vector<Step>;

  static void require(bool holds, char const* what) {
    if (!holds) throw std::invalid_argument(std::string("cayspin::DipolarField: ") + what);
  }

  /// Returns the distances along an axis that share one index of the convolution. For a distance of
  /// half a period, two images are equally near, one on each side. The mean over both choices gives
  /// the outermost image on each side the weight 1/2.
  Steps steps_of(std::size_t axis, int distance) const {
    int const images = options_.periodic_images[axis], cells = cells_[axis];
    if (images == 0) {
      int const back = distance - period_[axis];
      if (distance < cells) return {{double(distance), 1}};
      return -back < cells ? Steps{{double(back), 1}} : Steps{};
    }
    int const nearest = 2 * distance > cells ? distance - cells : distance;
    if (images == infinitely_many_images) return {{double(nearest), 1}};
    Steps steps;
    double const end = (images + 0.5) * cells;
    for (int image = -images - 1; image <= images; ++image) {
      double const at = nearest + double(image) * cells;
      if (std::abs(at) <= end) steps.push_back({at, std::abs(at) == end ? 0.5 : 1});
    }
    return steps;
  }

  Crystal crystal_;  // cell vectors in the lattice's unit of length
  DipolarOptions options_;
  std::array<int, 3> cells_{}, period_{};
  std::optional<DipoleImages> images_;
  double scale_ = 1;
  Point of_shape_{};
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
