// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/crystal.hpp>
#include <cayspin/demagnetization/dipole_tensor.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// A lattice of points with one to three periods a, b, c. for_each_within() visits all points
/// r + i * a + j * b + k * c that are within a given distance of the origin.
class PointsOfLattice {
 public:
  PointsOfLattice() = default;
  /// `periods`: 1 to 3 linearly independent vectors.
  explicit PointsOfLattice(std::vector<Point> const& periods) : count_(periods.size()) {
    for (std::size_t i = 0; i < count_; ++i) vectors_[i] = periods[i];
    if (count_ == 1) vectors_[1] = across(vectors_[0]);
    if (count_ < 3) {
      auto const n = vector_product(vectors_[0], vectors_[1]);
      vectors_[2] = add_scaled(1 / length(n), n, {});
    }
    auto const& [a, b, c] = vectors_;
    double const volume = scalar_product(a, vector_product(b, c));
    dual_ = {add_scaled(1 / volume, vector_product(b, c), {}),
             add_scaled(1 / volume, vector_product(c, a), {}),
             add_scaled(1 / volume, vector_product(a, b), {})};
    measure_ = std::abs(volume);
  }

  std::size_t dimensions() const { return count_; }
  /// Returns the volume of a cell. With two periods, this is the area of the cell; with one, its
  /// length.
  double measure() const { return measure_; }
  /// Returns the unit normal of the plane of two periods.
  Point const& normal() const { return vectors_[2]; }

  /// Returns the reciprocal lattice: the scalar product of its vector i with period j is 2 * pi if
  /// i = j, else 0.
  PointsOfLattice reciprocal() const {
    std::vector<Point> waves;
    for (std::size_t i = 0; i < count_; ++i)
      waves.push_back(add_scaled(2 * std::numbers::pi, dual_[i], {}));
    return PointsOfLattice(waves);
  }

  /// Calls work(point, {i, j, k}) for every point = r + i * a + j * b + k * c with a length of at
  /// most `distance`.
  template <class Work>
  void for_each_within(Point const& r, double distance, Work const& work) const {
    std::array<int, 3> first{}, last{};
    for (std::size_t i = 0; i < count_; ++i) {
      double const at = scalar_product(r, dual_[i]), reach = distance * length(dual_[i]);
      first[i] = static_cast<int>(std::ceil(-at - reach));
      last[i] = static_cast<int>(std::floor(-at + reach));
    }
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int k = first[2]; k <= last[2]; ++k) {
          auto const place =
              add_scaled(i, vectors_[0], add_scaled(j, vectors_[1], add_scaled(k, vectors_[2], r)));
          if (length(place) <= distance) work(place, std::array{i, j, k});
        }
  }

 private:
  /// Returns a unit vector perpendicular to `a`.
  static Point across(Point const& a) {
    std::size_t least = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
      if (std::abs(a[axis]) < std::abs(a[least])) least = axis;
    Point axis{};
    axis[least] = 1;
    auto const found = vector_product(a, axis);
    return add_scaled(1 / length(found), found, {});
  }

  std::size_t count_ = 0;
  std::array<Point, 3> vectors_{}, dual_{};
  double measure_ = 0;
};

/// The tensor of a dipole, summed over infinitely many images along one to three periods. With
/// three periods, the body that the images fill has no poles on its surface ("tin-foil" boundary),
/// so that its mean magnetization produces no demagnetising field.
///
/// With two or three periods, Ewald's sums are used: C. Kittel, Introduction to Solid State
/// Physics, appendix B; D. E. Parry, Surf. Sci. 49, 433 (1975). With one period, the nearest image
/// and 32 more on each side are summed. An integral, corrected by differences over a period,
/// replaces all other images.
class DipoleImages {
 public:
  explicit DipoleImages(std::vector<Point> const& periods) : lattice_(periods) {
    if (periods.size() == 1) {
      period_ = length(periods[0]);
      direction_ = add_scaled(1 / period_, periods[0], {});
      return;
    }
    bool const is_bulk = periods.size() == 3;
    // With this value, neither sum has more than about twice as many terms as the other.
    alpha_ = is_bulk ? 2.2 / std::cbrt(lattice_.measure()) : 1.77 / std::sqrt(lattice_.measure());
    lattice_.reciprocal().for_each_within(
        {}, 2 * ewald_reach * alpha_, [&](Point const& g, std::array<int, 3> const& numbers) {
          if (numbers <= std::array{0, 0, 0})
            return;  // 0, or the opposite of a g that is kept: terms of opposite g are equal
          double const g2 = scalar_product(g, g);
          double const gauss = std::exp(-g2 / (4 * alpha_ * alpha_));
          waves_.push_back({g, std::sqrt(g2), is_bulk ? gauss / g2 : gauss});
        });
  }

  DipoleTensor operator()(Point const& r) const {
    if (lattice_.dimensions() == 1) return along_line(r);
    DipoleTensor sum;
    lattice_.for_each_within(r, ewald_reach / alpha_,
                             [&](Point const& place, std::array<int, 3> const&) {
                               double const r2 = scalar_product(place, place);
                               if (r2 == 0) {
                                 sum.add_unit(self_field_of_ewald(alpha_));
                               } else {
                                 ShortRangeDipole const near(r2, alpha_);
                                 sum.add_unit(near.unit).add_product(near.product, place, place);
                               }
                             });
    if (lattice_.dimensions() == 3)
      add_waves_of_bulk(sum, r);
    else
      add_waves_of_film(sum, r);
    return sum;
  }

 private:
  struct Wave {
    Point g;
    double length, weight;
  };

  void add_waves_of_bulk(DipoleTensor& sum, Point const& r) const {
    double const factor = -8 * std::numbers::pi / lattice_.measure();
    for (auto const& [g, length, weight] : waves_)
      sum.add_product(factor * weight * std::cos(scalar_product(g, r)), g, g);
  }

  /// Returns exp(g * z) * erfc(g / (2 * alpha) + alpha * z) without overflow: 0 where erfc almost
  /// underflows, since the product is then negligible.
  double wave_beyond(double g, double z) const {
    double const at = g / (2 * alpha_) + alpha_ * z;
    return at > 26 ? 0 : std::exp(g * z) * std::erfc(at);
  }
  void add_waves_of_film(DipoleTensor& sum, Point const& r) const {
    auto const& n = lattice_.normal();
    double const z = scalar_product(n, r), area = lattice_.measure();
    double const of_z = std::exp(-alpha_ * alpha_ * z * z);
    double const root = std::sqrt(std::numbers::pi);
    sum.add_product(-4 * root * alpha_ / area * of_z, n, n);
    for (auto const& [g, length, gauss] : waves_) {
      double const up = wave_beyond(length, z), down = wave_beyond(length, -z);
      double const factor = 2 * std::numbers::pi / (area * length), phase = scalar_product(g, r);
      double const c = factor * std::cos(phase), s = factor * std::sin(phase);
      // The second derivative of up + down with respect to z.
      double const second = length * (length * (up + down) - 4 * alpha_ / root * gauss * of_z);
      sum.add_product(-c * (up + down), g, g)
          .add_product(-2 * s * length * (up - down), g, n)
          .add_product(c * second, n, n);
    }
  }

  DipoleTensor along_line(Point const& of) const {
    constexpr int images = 32;
    double const along = scalar_product(direction_, of);
    auto const r = add_scaled(-std::round(along / period_) * period_, direction_, of);
    DipoleTensor sum;
    for (int i = -images; i <= images; ++i)
      sum += dipole_tensor(add_scaled(i * period_, direction_, r));
    // Weights of the operator asinh(d/2) / (d/2), which turns the integral into a sum over images.
    // d is the central difference over a period.
    constexpr double second = -1. / 24, fourth = 3. / 640, sixth = -5. / 7168;
    constexpr std::array weights{1 - 2 * second + 6 * fourth - 20 * sixth,
                                 second - 4 * fourth + 15 * sixth, fourth - 6 * sixth, sixth};
    double const x = scalar_product(direction_, r);
    auto const rho = add_scaled(-x, direction_, r);
    for (int const side : {-1, 1})
      for (int n = -3; n <= 3; ++n)
        add_rest_of_line(sum, weights[static_cast<std::size_t>(std::abs(n))] / period_,
                         (images + 0.5 + n) * period_ + side * x, side, rho);
    return sum;
  }
  /// Adds `weight` times the integral of the tensor over a half-line of dipoles. The half-line
  /// starts at the distance u along the line from the point, on the side `side` (1 or -1); rho
  /// leads from the line to the point.
  void add_rest_of_line(DipoleTensor& sum, double weight, double u, int side,
                        Point const& rho) const {
    auto const& e = direction_;
    double const r = std::sqrt(u * u + scalar_product(rho, rho)), r3 = r * r * r;
    double const first = weight / (r * (r + u));
    double const second = weight * (2 * r + u) / (r3 * (r + u) * (r + u));
    sum.add_unit(-first)
        .add_product(first + weight * u / r3, e, e)
        .add_product(second, rho, rho)
        .add_product(2 * side * weight / r3, e, rho);
  }

  PointsOfLattice lattice_;
  double alpha_ = 0;
  std::vector<Wave> waves_;
  double period_ = 0;  // of a lattice with one period
  Point direction_{};
};

}  // namespace cayspin::inline v0_2::detail
