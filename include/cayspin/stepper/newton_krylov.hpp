// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stepper/field_algebra.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// Solver of v = g(v) on a field by Newton's method with step halving. GMRES solves the linear
/// systems; it approximates each product of g' and a vector by a finite difference of g. Allocates
/// 16 fields at its first use.
template <class Spins>
class NewtonKrylov {
  using Real = typename Spins::value_type;
  static constexpr std::size_t krylov_dimension = 12;
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();

 public:
  /// `g(v, to)` writes g(v) to `to`. `v` is the first guess and becomes the solution; `image`
  /// becomes g(v). Returns true if, within `iterations` Newton iterations, the largest component of
  /// |g(v) - v| fell to `tolerance` or, if round-off prevents further progress, to 512 * tolerance.
  template <class Exec, class Map>
  bool solve(Exec const& exec, Map const& g, Spins const& v, Spins const& image, double tolerance,
             int iterations) {
    allocate(v.lattice());
    g(v, image);
    double norm = residual(exec, v, image);
    for (int iteration = 0; iteration < iterations; ++iteration) {
      double const largest = largest_difference(exec, v, image);
      if (largest <= tolerance) return true;
      if (!std::isfinite(norm)) return false;
      solve_linear(exec, g, v, image, norm);
      double scale = 1, before = norm;
      for (;; scale /= 2) {
        bool const is_last = scale < 1e-3;
        // A small g(v) - v that does not fall is round-off.
        if (scale < 1 && largest <= (is_last ? 512 : 8) * tolerance) {
          g(v, image);
          return true;
        }
        if (is_last) return false;
        combine(exec, scale, correction_, 1, v, point_);
        g(point_, image);
        norm = residual(exec, point_, image);
        if (norm < (1 - 1e-4 * scale) * before) break;
      }
      combine(exec, 1, point_, 0, point_, v);
    }
    return false;
  }

 private:
  void allocate(Lattice const& lattice) {
    if (!basis_.empty()) return;
    for (std::size_t i = 0; i <= krylov_dimension; ++i)
      basis_.emplace_back("NewtonKrylov::basis_" + std::to_string(i), lattice);
    correction_ = Spins("NewtonKrylov::correction", lattice);
    point_ = Spins("NewtonKrylov::point", lattice);
    image_ = Spins("NewtonKrylov::image", lattice);
  }

  template <class Exec>
  double residual(Exec const& exec, Spins const& v, Spins const& image) {
    combine(exec, 1, image, -1, v, basis_[0]);
    return length(exec, basis_[0]);
  }

  // Solves (1 - g') correction_ = basis_[0], where `norm` is the length of basis_[0]. Stops when
  // the residual is a thousandth of `norm`, or after krylov_dimension vectors.
  template <class Exec, class Map>
  void solve_linear(Exec const& exec, Map const& g, Spins const& v, Spins const& image,
                    double norm) {
    constexpr std::size_t m = krylov_dimension;
    std::array<std::array<double, m + 1>, m> h{};  // h[j] is column j
    std::array<double, m> cosine{}, sine{};
    std::array<double, m + 1> rest{norm};
    double const small = std::sqrt(epsilon * static_cast<double>(whole(v.lattice()).sites()));
    combine(exec, 1 / norm, basis_[0], 0, basis_[0], basis_[0]);
    std::size_t size = 0;
    while (size < m && std::abs(rest[size]) > 1e-3 * norm) {
      auto& column = h[size];
      auto const &q = basis_[size], &next = basis_[size + 1];
      combine(exec, small, q, 1, v, point_);
      g(point_, image_);
      combine(exec, 1, image, -1, image_, image_);
      combine(exec, 1, q, 1 / small, image_, next);
      for (std::size_t i = 0; i <= size; ++i) {
        column[i] = inner_product(exec, basis_[i], next);
        combine(exec, -column[i], basis_[i], 1, next, next);
      }
      double const left = length(exec, next);
      if (left > 0) combine(exec, 1 / left, next, 0, next, next);
      for (std::size_t i = 0; i < size; ++i) rotate(cosine[i], sine[i], column[i], column[i + 1]);
      double const radius = std::hypot(column[size], left);
      cosine[size] = radius > 0 ? column[size] / radius : 1;
      sine[size] = radius > 0 ? left / radius : 0;
      column[size] = radius;
      rest[size + 1] = 0;
      rotate(cosine[size], sine[size], rest[size], rest[size + 1]);
      ++size;
      if (!(left > epsilon * radius)) break;
    }
    Kokkos::deep_copy(exec, correction_.allocation(), Real(0));
    for (std::size_t i = size; i-- > 0;) {
      for (std::size_t j = i + 1; j < size; ++j) rest[i] -= h[j][i] * rest[j];
      rest[i] = h[i][i] != 0 ? rest[i] / h[i][i] : 0;
      combine(exec, rest[i], basis_[i], 1, correction_, correction_);
    }
  }

  static void rotate(double c, double s, double& a, double& b) {
    double const rotated = c * a + s * b;
    b = c * b - s * a;
    a = rotated;
  }

  std::vector<Spins> basis_;
  Spins correction_, point_, image_;
};

}  // namespace cayspin::inline v0_2::detail
