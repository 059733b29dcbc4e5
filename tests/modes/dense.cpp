// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Modes against the eigenvalues of the whole matrix, at equilibria of random fields.
#include "../support/larger.hpp"
#include "modes.hpp"

#include <Eigen/Eigenvalues>

#include <complex>
#include <random>
#include <utility>

namespace cayspin::test {
namespace {

/// The Hessian of the energy, with two axes in each site's tangent plane as basis, and the matrix
/// `turning`: a displacement v has the rate turning * hessian * v. Requires a field that is at most
/// cubic in the spins.
struct Dense {
  Eigen::MatrixXd hessian, turning;
  double largest = 0;

  template <class Exec, class Field, class Spins>
  Dense(Exec const& exec, Field const& field, Spins const& spins, double damping) {
    auto const& lattice = spins.lattice();
    auto const sites = lattice.sites();
    auto const at = [](auto const& numbers, std::int64_t i) {
      return Vec3<double>{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    };
    auto const field_at = [&](std::vector<double> const& numbers) {
      Spins h("h", lattice);
      evaluate_field(exec, field, spins_of<Spins>(lattice, numbers), 0, h);
      exec.fence();
      return copy_to_host(h);
    };
    auto const m = copy_to_host(spins);
    auto const h = field_at(m);
    std::vector<Vec3<double>> axes;
    for (std::int64_t i = 0; i < sites; ++i) {
      auto const n = at(m, i);
      Vec3<double> const other =
          std::abs(n.x) < 0.6 ? Vec3<double>{1, 0, 0} : Vec3<double>{0, 1, 0};
      auto const e = cross(n, other);
      axes.push_back((1 / std::sqrt(dot(e, e))) * e);
      axes.push_back(cross(n, axes.back()));
    }
    hessian.setZero(2 * sites, 2 * sites);
    turning.setZero(2 * sites, 2 * sites);
    for (std::int64_t j = 0; j < 2 * sites; ++j) {
      // This combination of differences at two distances is exact for a cubic field.
      for (auto const& [distance, weight] : {std::pair{1.0, -1.0 / 3}, {0.5, 4.0 / 3}})
        for (double const side : {-1.0, 1.0}) {
          auto moved = m;
          auto const e = side * distance * axes[j];
          moved[3 * (j / 2)] += e.x, moved[3 * (j / 2) + 1] += e.y, moved[3 * (j / 2) + 2] += e.z;
          auto const changed = field_at(moved);
          for (std::int64_t i = 0; i < 2 * sites; ++i)
            hessian(i, j) -= side * weight / (2 * distance) * dot(axes[i], at(changed, i / 2));
        }
      hessian(j, j) += dot(at(m, j / 2), at(h, j / 2));
      turning(j, j) = -damping;
      turning(j ^ 1, j) = j % 2 == 0 ? 1 : -1;
    }
  }

  std::vector<std::complex<double>> rates() {
    Eigen::VectorXcd const found = (turning * hessian).eigenvalues();
    std::vector<std::complex<double>> rates;
    for (auto const& rate : found) {
      largest = larger(largest, std::abs(rate));
      if (rate.imag() >= 0) rates.push_back(rate);
    }
    std::ranges::sort(rates, {}, [](auto const& rate) { return std::abs(rate); });
    return rates;
  }
};

using Spins = SpinField<double, Kokkos::HostSpace>;
using Exec = Kokkos::DefaultHostExecutionSpace;

/// Returns false if no equilibrium was found.
template <class Field>
bool expect_dense_modes(Lattice const& lattice, Field const& field, double damping, unsigned seed) {
  Exec const exec;
  auto spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), seed));
  auto const minimum = minimize(exec, field, spins, {.torque = 1e-11});
  if (minimum.end != MinimizeEnd::converged) return false;
  auto const modes = normal_modes(exec, LandauLifshitz(field, damping), spins, {.count = 6});
  EXPECT_EQ(modes.end, ModesEnd::converged) << seed;
  Dense dense(exec, field, spins, damping);
  auto const rates = dense.rates();
  EXPECT_EQ(modes.modes.size(), 6) << seed;
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    EXPECT_NEAR(modes.modes[i].frequency, rates[i].imag(), 1e-9 * dense.largest) << seed;
    EXPECT_NEAR(modes.modes[i].decay, -rates[i].real(), 1e-9 * dense.largest) << seed;
  }
  auto const curvatures = lowest_curvatures(exec, field, spins, {.count = 6});
  EXPECT_EQ(curvatures.end, ModesEnd::converged) << seed;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const exact(
      0.5 * (dense.hessian + dense.hessian.transpose()));
  double const largest = exact.eigenvalues().cwiseAbs().maxCoeff();
  EXPECT_EQ(curvatures.curvatures.size(), 6) << seed;
  for (std::size_t i = 0; i < curvatures.curvatures.size(); ++i)
    EXPECT_NEAR(curvatures.curvatures[i].value, exact.eigenvalues()[static_cast<Eigen::Index>(i)],
                1e-9 * largest)
        << seed;
  return true;
}

TEST(ModesBesideDense, AreTheSlowestOfRandomEquilibria) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  auto const vector = [&] {
    Vec3<double> const v{any(random), any(random), any(random)};
    return (1 / std::sqrt(dot(v, v))) * v;
  };
  int found = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    auto const b = seed % 4 < 2 ? Boundary::open : Boundary::periodic;
    Lattice const lattice{{4, 3, seed % 2 == 0 ? 1 : 2}, {1, 0.9, 1.2}, {b, b, b}};
    Exchange const exchange(lattice, 0.5 + any(random) / 3);
    InterfacialDmi const dmi(lattice, any(random) / 3, {0, 0, 1});
    UniaxialAnisotropy const axis(any(random), vector());
    Zeeman const zeeman{0.5 * vector()};
    double const damping = seed % 5 == 0 ? 0 : 0.4 * std::abs(any(random));
    bool const is_found =
        seed % 3 == 0
            ? expect_dense_modes(lattice,
                                 EffectiveField(exchange, dmi, axis, zeeman,
                                                CubicAnisotropy(0.3, {1, 0, 0}, {0, 1, 0})),
                                 damping, seed)
            : expect_dense_modes(lattice, EffectiveField(exchange, dmi, axis, zeeman), damping,
                                 seed);
    if (is_found) ++found;
  }
  EXPECT_GE(found, 225);
}

}  // namespace
}  // namespace cayspin::test
