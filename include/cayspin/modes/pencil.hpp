// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <vector>

// Eigenvalue problems B c = rate * S c in a small subspace. B (`hessian`) is the Hessian there. S
// (`turning`) is the inverse of the operator G by which spins turn (vectors.hpp).
namespace cayspin::inline v0_2::detail {

/// An eigenvalue, and its vector in the subspace. One mode represents a complex conjugate pair: the
/// one whose eigenvalue has a positive imaginary part.
struct RitzMode {
  std::complex<double> rate;
  Eigen::VectorXcd coefficients;

  bool is_real() const { return rate.imag() == 0; }
};

struct Pencil {
  Eigen::MatrixXd hessian, turning;

  Eigen::Index size() const { return hessian.rows(); }

  /// Changes the basis of the subspace to the columns of `q`.
  void change_basis(Eigen::MatrixXd const& q) {
    hessian = (q.transpose() * hessian * q).eval();
    turning = (q.transpose() * turning * q).eval();
  }
};

inline void sort_by(std::vector<RitzMode>& modes, auto const& number) {
  std::ranges::stable_sort(modes,
                           [&](auto const& a, auto const& b) { return number(a) < number(b); });
}

/// Returns the modes of undamped motion about a minimum, slowest first. Their rates are imaginary:
/// the problem is Hermitian in the inner product of the Hessian. Returns no modes if the Hessian is
/// not clearly positive definite.
inline std::vector<RitzMode> undamped_modes(Pencil const& pencil) {
  using namespace std::complex_literals;
  Eigen::LLT<Eigen::MatrixXd> const factors(pencil.hessian);
  if (factors.info() != Eigen::Success) return {};
  Eigen::VectorXd const pivots = factors.matrixLLT().diagonal();
  if (!(pivots.minCoeff() > 1e-5 * pivots.maxCoeff())) return {};
  Eigen::MatrixXd inner = factors.matrixL().solve(pencil.turning);
  inner = factors.matrixL().solve(inner.transpose().eval());  // transpose of L^-1 S L^-T; skew
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> const found(-1i * inner);
  std::vector<RitzMode> modes;
  double const least = 1e-14 * found.eigenvalues().cwiseAbs().maxCoeff();
  for (Eigen::Index i = pencil.size(); i-- > 0 && found.eigenvalues()[i] > least;) {
    Eigen::VectorXcd const column = found.eigenvectors().col(i);
    modes.push_back({1i / found.eigenvalues()[i], factors.matrixU().solve(column)});
  }
  return modes;
}

/// Returns the modes of any pencil, slowest first. Unless undamped_modes finds them, the Hessian is
/// shifted before it is inverted, because it may be singular. The shift is at least `least_shift`,
/// which is positive. It must not be small compared with the rates: zero modes that drift, as those
/// of an antiferromagnet do, contribute 1 / shift^2 to the inverse.
inline std::vector<RitzMode> slowest_modes(Pencil const& pencil, bool is_undamped,
                                           double least_shift) {
  if (is_undamped)
    if (auto modes = undamped_modes(pencil); !modes.empty()) return modes;
  double const rates = pencil.hessian.norm() / pencil.turning.norm();
  double const shift = std::max(least_shift, 1e-2 * rates);
  Eigen::MatrixXd const shifted = pencil.hessian - shift * pencil.turning;
  Eigen::EigenSolver<Eigen::MatrixXd> const found(shifted.partialPivLu().solve(pencil.turning));
  std::vector<RitzMode> modes;
  if (found.info() != Eigen::Success) return modes;
  Eigen::VectorXcd const inverse = found.eigenvalues();
  Eigen::MatrixXcd const vectors = found.eigenvectors();
  double const least = 1e-14 * inverse.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < pencil.size(); ++i) {
    if (!(std::abs(inverse[i]) > least)) continue;
    auto const rate = shift + 1.0 / inverse[i];
    if (rate.imag() >= 0 && std::isfinite(std::abs(rate))) modes.push_back({rate, vectors.col(i)});
  }
  sort_by(modes, [](auto const& mode) { return std::abs(mode.rate); });
  return modes;
}

/// Returns the eigenvectors of the Hessian, lowest eigenvalue first, for a pencil whose `turning`
/// is the identity.
inline std::vector<RitzMode> lowest_modes(Pencil const& pencil) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const found(pencil.hessian);
  std::vector<RitzMode> modes;
  if (found.info() != Eigen::Success || !found.eigenvalues().allFinite()) return modes;
  for (Eigen::Index i = 0; i < pencil.size(); ++i) {
    Eigen::VectorXcd const vector = found.eigenvectors().col(i).cast<std::complex<double>>();
    modes.push_back({found.eigenvalues()[i], vector});
  }
  return modes;
}

/// Returns the real and imaginary parts of the first `count` modes, as normalised columns of length
/// `rows`.
inline Eigen::MatrixXd columns_of(std::vector<RitzMode> const& modes, std::size_t count,
                                  Eigen::Index rows) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t i = 0; i < std::min(count, modes.size()); ++i) {
    columns.push_back(modes[i].coefficients.real());
    if (!modes[i].is_real()) columns.push_back(modes[i].coefficients.imag());
  }
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    auto const& column = columns[static_cast<std::size_t>(i)];
    double const norm = column.norm();
    if (norm > 0) matrix.col(i).head(column.size()) = column / norm;
  }
  return matrix;
}

/// Returns an orthonormal basis of the space that the columns span.
inline Eigen::MatrixXd orthonormal(Eigen::MatrixXd const& columns) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(columns);
  factors.setThreshold(1e-10);
  return factors.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), factors.rank());
}

/// Returns, as columns, the coefficients of orthonormal combinations of vectors. `products`: the
/// Gram matrix of the vectors. There are fewer columns than vectors if the vectors are linearly
/// dependent (Stathopoulos and Wu 2002). `least`: eigenvalues of the scaled Gram matrix up to this
/// count as 0.
inline Eigen::MatrixXd orthonormalizing(Eigen::MatrixXd const& products, double least) {
  Eigen::VectorXd scale = products.diagonal();
  for (double& square : scale) square = square > 0 ? 1 / std::sqrt(square) : 0;
  Eigen::MatrixXd const scaled = scale.asDiagonal() * products * scale.asDiagonal();
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const found(scaled);
  Eigen::Index first = 0;
  while (first < products.rows() && !(found.eigenvalues()[first] > least)) ++first;
  Eigen::Index const kept = products.rows() - first;
  Eigen::VectorXd const roots = found.eigenvalues().tail(kept).cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * found.eigenvectors().rightCols(kept) * roots.asDiagonal();
}

}  // namespace cayspin::inline v0_2::detail
