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
template <class Scalar>
struct RitzMode {
  std::complex<Scalar> rate;
  Eigen::VectorX<std::complex<Scalar>> coefficients;

  bool is_real() const { return rate.imag() == 0; }
};

/// Eigen's solvers take seconds to compile: a program can do that once for all its source files, by
/// extern templates.
template <class Scalar>
struct Pencil {
  using Complex = std::complex<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;
  using Vector = Eigen::VectorX<Scalar>;
  using ComplexMatrix = Eigen::MatrixX<Complex>;
  using ComplexVector = Eigen::VectorX<Complex>;
  using Modes = std::vector<RitzMode<Scalar>>;

  Matrix hessian, turning;

  Eigen::Index size() const { return hessian.rows(); }

  /// Changes the basis of the subspace to the columns of `q`.
  void change_basis(Matrix const& q);

  /// Returns the modes of undamped motion about a minimum, slowest first. Their rates are
  /// imaginary: the problem is Hermitian in the inner product of the Hessian. Returns no modes if
  /// the Hessian is not clearly positive definite.
  Modes undamped_modes() const;

  /// Returns the modes of any pencil, slowest first. Unless undamped_modes finds them, the Hessian
  /// is shifted before it is inverted, because it may be singular. The shift is at least
  /// `least_shift`, which is positive. It must not be small compared with the rates: zero modes
  /// that drift, as those of an antiferromagnet do, contribute 1 / shift^2 to the inverse.
  Modes slowest_modes(bool is_undamped, Scalar least_shift) const;

  /// Returns the eigenvectors of the Hessian, lowest eigenvalue first, if `turning` is the
  /// identity.
  Modes lowest_modes() const;

  /// Returns the real and imaginary parts of the first `count` modes, as normalised columns of
  /// length `rows`.
  static Matrix columns_of(Modes const& modes, std::size_t count, Eigen::Index rows);

  /// Returns an orthonormal basis of the space that the columns span.
  static Matrix orthonormal(Matrix const& columns);

  /// Returns, as columns, the coefficients of orthonormal combinations of vectors. `products`: the
  /// Gram matrix of the vectors. There are fewer columns than vectors if the vectors are linearly
  /// dependent (Stathopoulos and Wu 2002). `least`: eigenvalues of the scaled Gram matrix up to
  /// this count as 0.
  static Matrix orthonormalizing(Matrix const& products, Scalar least);
};

template <class Scalar>
void Pencil<Scalar>::change_basis(Matrix const& q) {
  hessian = (q.transpose() * hessian * q).eval();
  turning = (q.transpose() * turning * q).eval();
}

template <class Scalar>
auto Pencil<Scalar>::undamped_modes() const -> Modes {
  Complex const i_unit(0, 1);
  Eigen::LLT<Matrix> const factors(hessian);
  if (factors.info() != Eigen::Success) return {};
  Vector const pivots = factors.matrixLLT().diagonal();
  if (!(pivots.minCoeff() > Scalar(1e-5) * pivots.maxCoeff())) return {};
  Matrix inner = factors.matrixL().solve(turning);
  inner = factors.matrixL().solve(inner.transpose().eval());  // transpose of L^-1 S L^-T; skew
  Eigen::SelfAdjointEigenSolver<ComplexMatrix> const found(-i_unit * inner);
  // All inverse rates have the round-off of the largest one. If there is a zero mode, the largest
  // one belongs to it, and the others would be inaccurate.
  Scalar const largest = found.eigenvalues().cwiseAbs().maxCoeff();
  if (!(largest * hessian.norm() < Scalar(1e5) * turning.norm())) return {};
  Modes modes;
  Scalar const least = Scalar(1e-14) * largest;
  for (Eigen::Index i = size(); i-- > 0 && found.eigenvalues()[i] > least;) {
    ComplexVector const column = found.eigenvectors().col(i);
    modes.push_back({i_unit / found.eigenvalues()[i], factors.matrixU().solve(column)});
  }
  return modes;
}

template <class Scalar>
auto Pencil<Scalar>::slowest_modes(bool is_undamped, Scalar least_shift) const -> Modes {
  if (is_undamped)
    if (auto modes = undamped_modes(); !modes.empty()) return modes;
  Scalar const rates = hessian.norm() / turning.norm();
  Scalar const shift = std::max(least_shift, Scalar(1e-2) * rates);
  Matrix const shifted = hessian - shift * turning;
  Eigen::EigenSolver<Matrix> const found(shifted.partialPivLu().solve(turning));
  Modes modes;
  if (found.info() != Eigen::Success) return modes;
  ComplexVector const inverse = found.eigenvalues();
  ComplexMatrix const vectors = found.eigenvectors();
  Scalar const least = Scalar(1e-14) * inverse.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (!(std::abs(inverse[i]) > least)) continue;
    auto const rate = shift + Scalar(1) / inverse[i];
    if (rate.imag() >= 0 && std::isfinite(std::abs(rate))) modes.push_back({rate, vectors.col(i)});
  }
  std::ranges::stable_sort(modes, {}, [](auto const& mode) { return std::abs(mode.rate); });
  return modes;
}

template <class Scalar>
auto Pencil<Scalar>::lowest_modes() const -> Modes {
  Eigen::SelfAdjointEigenSolver<Matrix> const found(hessian);
  Modes modes;
  if (found.info() != Eigen::Success || !found.eigenvalues().allFinite()) return modes;
  for (Eigen::Index i = 0; i < size(); ++i) {
    ComplexVector const vector = found.eigenvectors().col(i).template cast<Complex>();
    modes.push_back({found.eigenvalues()[i], vector});
  }
  return modes;
}

template <class Scalar>
auto Pencil<Scalar>::columns_of(Modes const& modes, std::size_t count, Eigen::Index rows)
    -> Matrix {
  std::vector<Vector> columns;
  for (std::size_t i = 0; i < std::min(count, modes.size()); ++i) {
    columns.push_back(modes[i].coefficients.real());
    if (!modes[i].is_real()) columns.push_back(modes[i].coefficients.imag());
  }
  Matrix matrix = Matrix::Zero(rows, static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    auto const& column = columns[static_cast<std::size_t>(i)];
    Scalar const norm = column.norm();
    if (norm > 0) matrix.col(i).head(column.size()) = column / norm;
  }
  return matrix;
}

template <class Scalar>
auto Pencil<Scalar>::orthonormal(Matrix const& columns) -> Matrix {
  Eigen::ColPivHouseholderQR<Matrix> factors(columns);
  factors.setThreshold(Scalar(1e-10));
  return factors.householderQ() * Matrix::Identity(columns.rows(), factors.rank());
}

template <class Scalar>
auto Pencil<Scalar>::orthonormalizing(Matrix const& products, Scalar least) -> Matrix {
  Vector scale = products.diagonal();
  for (Scalar& square : scale) square = square > 0 ? 1 / std::sqrt(square) : 0;
  Matrix const scaled = scale.asDiagonal() * products * scale.asDiagonal();
  Eigen::SelfAdjointEigenSolver<Matrix> const found(scaled);
  Eigen::Index first = 0;
  while (first < products.rows() && !(found.eigenvalues()[first] > least)) ++first;
  Eigen::Index const kept = products.rows() - first;
  Vector const roots = found.eigenvalues().tail(kept).cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * found.eigenvectors().rightCols(kept) * roots.asDiagonal();
}

/// Returns the eigenvalues of a * b, in no order.
template <class Scalar>
Eigen::VectorX<std::complex<Scalar>> eigenvalues_of_product(
    Eigen::MatrixX<Scalar> const& a, Eigen::MatrixX<std::complex<Scalar>> const& b) {
  constexpr bool with_vectors = false;
  return Eigen::ComplexEigenSolver<Eigen::MatrixX<std::complex<Scalar>>>(a * b, with_vectors)
      .eigenvalues();
}

}  // namespace cayspin::inline v0_2::detail
