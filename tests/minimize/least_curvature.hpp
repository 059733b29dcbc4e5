// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <vector>

namespace cayspin::test {

/// Returns the least eigenvalue of the Hessian on the tangent planes, for a field that is affine in
/// m.
template <class Field>
double least_curvature(Field const& field, Lattice const& lattice, std::vector<double> const& m) {
  using Doubles = SpinField<double, Kokkos::HostSpace>;
  auto const spins = spins_of<Doubles>(lattice, m);
  Doubles const result("field", lattice);
  auto const field_of = [&](std::vector<double> const& numbers) {
    copy_from_host(numbers, spins);
    evaluate_field(Kokkos::DefaultHostExecutionSpace(), field, spins, 0, result);
    return numbers_of(result);
  };
  auto const sites = static_cast<Eigen::Index>(lattice.sites());
  auto const before = field_of(m);
  auto const vector = [](std::vector<double> const& numbers, Eigen::Index site) {
    return Eigen::Map<Eigen::Vector3d const>(numbers.data() + 3 * site);
  };
  auto const tangent = [&](Eigen::Index site, int which) {
    Eigen::Vector3d const spin = vector(m, site);
    Eigen::Vector3d const other =
        std::abs(spin.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    Eigen::Vector3d const first = spin.cross(other).normalized();
    return which == 0 ? first : Eigen::Vector3d(spin.cross(first));
  };
  Eigen::MatrixXd hessian(2 * sites, 2 * sites);
  for (Eigen::Index i = 0; i < 2 * sites; ++i) {
    auto moved = m;
    Eigen::Map<Eigen::Vector3d>(moved.data() + 3 * (i / 2)) += tangent(i / 2, i % 2);
    auto const after = field_of(moved);
    for (Eigen::Index j = 0; j < 2 * sites; ++j)
      hessian(j, i) = tangent(j / 2, j % 2).dot(vector(before, j / 2) - vector(after, j / 2));
    hessian(i, i) += vector(before, i / 2).dot(vector(m, i / 2));
  }
  Eigen::MatrixXd const symmetric = 0.5 * (hessian + hessian.transpose());
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

}  // namespace cayspin::test
