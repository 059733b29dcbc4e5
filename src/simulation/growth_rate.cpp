// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "growth_rate.hpp"

#include "failure.hpp"
#include "turning_of_sites.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cayspin::simulation {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Returns B = G^-1, with a 2 x 2 block for each spin, where G maps the field on a spin to the
/// velocity of that spin. With the Hessian H, a motion x * exp(rate * t) about a state obeys
/// rate * x = -G H x, that is, (H + rate * B) x = 0.
Matrix inverse_turning(io::Scene const& scene, StateHessian const& state) {
  auto const [precession, damping] = turning_of_sites(scene);
  auto const n = static_cast<Eigen::Index>(state.size());
  Matrix found = Matrix::Zero(n, n);
  for (Eigen::Index i = 0; i < n; i += 2) {
    auto const site = state.sites[static_cast<std::size_t>(i / 2)];
    double const p = precession[site], d = damping[site], square = p * p + d * d;
    if (!(square > 0))
      throw NumbersFailed("rates: a spin without precession and damping does not move");
    found.block(i, i, 2, 2) << d / square, -p / square, p / square, d / square;
  }
  return found;
}

/// Estimates the rate of growth: the positive root of det(H + rate * B), with both matrices
/// restricted to the span of two vectors, the unstable mode and that mode turned by 90 degrees in
/// each tangent plane. Without such a root, returns a rougher estimate.
double growth_of_two(Matrix const& hessian, Matrix const& inverse, Vector const& mode) {
  Matrix two(mode.size(), 2);
  two.col(0) = mode;
  for (Eigen::Index i = 0; i < mode.size(); i += 2) {
    two(i, 1) = -mode[i + 1];
    two(i + 1, 1) = mode[i];
  }
  Eigen::Matrix2d const h = two.transpose() * hessian * two, b = two.transpose() * inverse * two;
  double const square = b.determinant(), none = h.determinant();
  double const half =
      0.5 * (h(0, 0) * b(1, 1) + h(1, 1) * b(0, 0) - h(0, 1) * b(1, 0) - h(1, 0) * b(0, 1));
  double const growth = (std::sqrt(std::max(half * half - square * none, 0.0)) - half) / square;
  return growth > 0 ? growth : -h(0, 0) / b.norm();
}

}  // namespace

double growth_rate(io::Scene const& scene, StateHessian const& saddle, Matrix const& hessian,
                   Vector const& unstable, std::function<void()> const& poll) {
  Matrix const inverse = inverse_turning(scene, saddle);
  double shift = growth_of_two(hessian, inverse, unstable);
  double const least = 1e-4 * shift;  // smaller rates are those of zero modes
  Vector mode = unstable;
  for (int factors = 0; factors < 12; ++factors) {
    poll();
    shift *= 1.001;  // at the rate itself the matrix is singular
    Eigen::PartialPivLU<Matrix> const shifted(hessian + shift * inverse);
    double growth = 0;
    for (int step = 0; step < 20; ++step) {
      Vector const next = shifted.solve(inverse * mode);
      double const along = mode.dot(next);
      growth = shift - 1 / along;
      bool const is_settled = (next - along * mode).norm() < 1e-10 * next.norm();
      mode = next.normalized();
      if (is_settled && growth > least) return growth;
      if (is_settled) break;
    }
    // If the iteration found another mode, the shift was too small.
    shift = growth > least ? growth : 4 * shift;
  }
  return 0;
}

}  // namespace cayspin::simulation
