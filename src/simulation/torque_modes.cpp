// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "torque_modes.hpp"

#include "failure.hpp"
#include "tangent_basis.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

namespace cayspin::simulation {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

struct Linearised {
  TangentBasis basis;
  Vector rates;
  Matrix matrix;  // derivatives of the rates
  bool is_complete;
};

Vector components(TangentBasis const& basis, Vectors const& vectors) {
  Vector found(static_cast<Eigen::Index>(basis.size()));
  for (std::size_t i = 0; i < basis.size(); ++i) {
    auto const* const of_site = &vectors[3 * basis.sites[i / 2]];
    auto const* const v = basis.vector(i);
    found[static_cast<Eigen::Index>(i)] = of_site[0] * v[0] + of_site[1] * v[1] + of_site[2] * v[2];
  }
  return found;
}

constexpr std::int64_t evaluations_of_column = 4;

std::int64_t evaluations_to_linearise(TangentBasis const& basis) {
  return 1 + evaluations_of_column * static_cast<std::int64_t>(basis.size());
}

/// Computes the matrix by finite differences of order 4, with a shift that balances their error
/// with round-off. Shifted spins are off the sphere. The rates are smooth there, too, so this does
/// not change their derivatives along tangent vectors.
Linearised linearise(TorqueMotion const& motion, TangentBasis const& basis) {
  auto const n = static_cast<Eigen::Index>(basis.size());
  Linearised found{basis, components(basis, motion.rates(basis.spins)), Matrix(n, n), false};
  double const shift = std::pow(motion.epsilon, 0.2);
  auto shifted = basis.spins;
  for (std::size_t column = 0; column < basis.size(); ++column) {
    if (motion.is_interrupted()) return found;
    auto const first = 3 * basis.sites[column / 2];
    auto const at = [&](double by) {
      for (std::size_t c = 0; c < 3; ++c)
        shifted[first + c] = basis.spins[first + c] + by * shift * basis.vector(column)[c];
      return components(basis, motion.rates(shifted));
    };
    found.matrix.col(static_cast<Eigen::Index>(column)) =
        (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * shift);
    for (std::size_t c = 0; c < 3; ++c) shifted[first + c] = basis.spins[first + c];
  }
  found.is_complete = true;
  return found;
}

double largest_torque_of(TorqueMotion const& motion, Vectors const& rates) {
  double largest = 0;
  for (std::size_t site = 0; site < rates.size() / 3; ++site) {
    auto const* const v = &rates[3 * site];
    double const speed = std::hypot(v[0], v[1], v[2]);
    if (speed != 0) largest = std::max(largest, speed / motion.turning[site]);
    if (!std::isfinite(speed)) return speed;
  }
  return largest;
}

/// Returns the spins, each moved by its tangent vector. If a vector is longer than `most`, all are
/// shortened by the same factor.
Vectors moved(TangentBasis const& basis, Vector const& by, double most) {
  double longest = 0;
  for (Eigen::Index i = 0; i < by.size(); i += 2)
    longest = std::max(longest, std::hypot(by[i], by[i + 1]));
  double const factor = longest > most ? most / longest : 1;
  auto spins = basis.spins;
  for (std::size_t i = 0; i < basis.sites.size(); ++i) {
    auto* const m = &spins[3 * basis.sites[i]];
    auto const *const u = basis.vector(2 * i), *const v = basis.vector(2 * i + 1);
    auto const row = static_cast<Eigen::Index>(2 * i);
    for (std::size_t c = 0; c < 3; ++c) m[c] += factor * (by[row] * u[c] + by[row + 1] * v[c]);
    double const length = std::hypot(m[0], m[1], m[2]);
    for (std::size_t c = 0; c < 3; ++c) m[c] /= length;
  }
  return spins;
}

}  // namespace

double largest_torque(TorqueMotion const& motion, Vectors const& spins) {
  return largest_torque_of(motion, motion.rates(spins));
}

RestWithTorques find_rest_with_torques(TorqueMotion const& motion, Vectors const& start,
                                       double torque, std::int64_t evaluations) {
  RestWithTorques found{start, largest_torque(motion, start), 1};
  double least = found.torque;
  int since_least = 0;
  while (std::isfinite(found.torque) && found.torque > torque && since_least < 12) {
    TangentBasis const basis(found.spins, motion.frozen);
    auto const cost = evaluations_to_linearise(basis) + 1;
    if (found.evaluations + cost > evaluations) break;
    found.evaluations += cost;
    auto const linear = linearise(motion, basis);
    if (!linear.is_complete) {
      found.is_interrupted = true;
      break;
    }
    // Takes the shortest step that solves the equations. It has no component along modes without
    // stiffness.
    Eigen::CompleteOrthogonalDecomposition<Matrix> factors;
    factors.setThreshold(1e3 * motion.epsilon);
    factors.compute(linear.matrix);
    found.spins = moved(basis, -factors.solve(linear.rates), 0.3);
    found.torque = largest_torque(motion, found.spins);
    since_least = found.torque < 0.9 * least ? 0 : since_least + 1;
    least = std::min(least, found.torque);
  }
  return found;
}

FoundModes find_modes_with_torques(TorqueMotion const& motion, Vectors const& spins,
                                   std::size_t count, std::int64_t evaluations) {
  FoundModes modes;
  TangentBasis const basis(spins, motion.frozen);
  if (basis.size() == 0) {  // no spin moves
    modes.end = ModesEnd::converged;
    return modes;
  }
  auto const cost = evaluations_to_linearise(basis);
  if (cost > evaluations) return modes;
  modes.evaluations = cost;
  auto const linear = linearise(motion, basis);
  if (!linear.is_complete) {
    modes.end = ModesEnd::interrupted;
    return modes;
  }
  double const fastest = linear.matrix.cwiseAbs().rowwise().sum().maxCoeff();
  if (!std::isfinite(fastest)) throw NumbersFailed("modes: the motion is not finite");
  Eigen::EigenSolver<Matrix> const solver(linear.matrix);
  if (motion.is_interrupted() || solver.info() != Eigen::Success) {
    modes.end = motion.is_interrupted() ? ModesEnd::interrupted : ModesEnd::stagnated;
    return modes;
  }
  std::vector<std::pair<double, Eigen::Index>> slowest;
  for (Eigen::Index i = 0; i < linear.matrix.rows(); ++i)
    if (auto const rate = solver.eigenvalues()[i]; rate.imag() >= 0)
      slowest.emplace_back(std::abs(rate), i);
  std::ranges::sort(slowest);
  // While a mode turns by a radian, the state must hardly move. Zero modes do not count.
  auto const is_fast = [&](auto const& mode) { return mode.first > 1e-6 * fastest; };
  auto const first = std::ranges::find_if(slowest, is_fast);
  double const speed = linear.rates.cwiseAbs().maxCoeff();
  if (first != slowest.end() && speed > 0.01 * first->first)
    throw NumbersFailed(fmt::format(
        "modes: the spins are not at rest: max |dm/dt| is {:.3g} in reduced units, and the slowest "
        "mode has a rate of {:.3g}",
        speed, first->first));
  modes.growing = static_cast<std::size_t>(std::ranges::count_if(slowest, [&](auto const& mode) {
    return solver.eigenvalues()[mode.second].real() > std::max(1e-7, 10 * motion.epsilon) * fastest;
  }));
  slowest.resize(std::min(slowest.size(), count));
  Eigen::MatrixXcd const shapes = solver.eigenvectors();
  for (auto const& [ignored, i] : slowest) {
    auto const rate = solver.eigenvalues()[i];
    auto const shape = shapes.col(i);
    modes.frequencies.push_back(rate.imag());
    modes.decays.push_back(0 - rate.real());
    modes.errors.push_back((linear.matrix * shape - rate * shape).norm() /
                           (fastest * shape.norm()));
    auto& numbers = modes.shapes.emplace_back(2 * spins.size());
    for (std::size_t row = 0; row < basis.size(); ++row)
      for (std::size_t c = 0; c < 3; ++c) {
        auto const value = shape[static_cast<Eigen::Index>(row)] * basis.vector(row)[c];
        auto* const complex = &numbers[2 * (3 * basis.sites[row / 2] + c)];
        complex[0] += value.real();
        complex[1] += value.imag();
      }
  }
  modes.end = ModesEnd::converged;
  return modes;
}

}  // namespace cayspin::simulation
