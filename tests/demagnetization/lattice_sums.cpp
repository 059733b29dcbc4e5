// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The field of dipoles in uniformly magnetised crystals against lattice sums, and the bound on the
// eigenvalues of the matrix from moments to fields.
#include "crystals.hpp"

#include <cayspin/demagnetization/demagnetizing_field.hpp>
#include <cayspin/demagnetization/dipolar_bound.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace cayspin::test {
namespace {

Vec3<double> of_uniform(Crystal const& crystal, Numbers const& cells, DipolarOptions const& options,
                        Vec3<double> const& m) {
  auto const lattice = crystal.lattice(cells);
  SpinField<double, Kokkos::HostSpace> spins("spins", lattice), field("field", lattice);
  for (std::int64_t site = 0; site < spins.sites(); ++site) spins.set(site, m);
  DipolarField<double>(lattice, crystal, options)(spins, field, 0);
  auto const h = field.get(0);
  for (std::int64_t site = 1; site < spins.sites(); ++site) {
    auto const off = field.get(site) - h;
    EXPECT_LT(std::sqrt(dot(off, off)), 1e-12);
  }
  return h;
}

TEST(LatticeSums, CubicCrystalsHaveLorentzsField) {
  Vec3<double> const m{0.3, -0.8, 0.5};
  for (auto const& crystal : {Crystal::simple_cubic(), Crystal::bcc(), Crystal::fcc()})
    for (auto const& cells : {Numbers{2, 2, 2}, {3, 5, 4}}) {
      auto const sites = static_cast<double>(crystal.basis.size());
      auto const h = of_uniform(crystal, cells, {.periodic_images = {all, all, all}}, m);
      auto const off = h - sites / 3 * m;
      EXPECT_LT(std::sqrt(dot(off, off)), 1e-12);
      // Demagnetising factors: a sphere has no field left, and a film has N = 1 along its normal.
      double const third = 1. / 3;
      DipolarOptions const sphere{.periodic_images = {all, all, all},
                                  .demagnetizing_factors = {third, third, third}};
      auto const none = of_uniform(crystal, cells, sphere, m);
      EXPECT_LT(std::sqrt(dot(none, none)), 1e-12);
      auto const film =
          of_uniform(crystal, cells,
                     {.periodic_images = {all, all, all}, .demagnetizing_factors = {0, 0, 1}}, m);
      EXPECT_NEAR(film.z, -2. / 3 * sites * m.z, 1e-12);
      EXPECT_NEAR(film.x, sites / 3 * m.x, 1e-12);
    }
}

// de Wette, Phys. Rev. 123, 103 (1961), and Benson and Mills, Phys. Rev. 178, 839 (1969): the
// plane sum of 1/r^3 over a square lattice is 9.0336216831.
TEST(LatticeSums, OfChainsAndSquareLattices) {
  double const pi = std::numbers::pi, zeta3 = 1.2020569031595942;
  auto const cubic = Crystal::simple_cubic();
  auto const chain = of_uniform(cubic, {5, 1, 1}, {.periodic_images = {all, 0, 0}}, {1, 1, 0});
  EXPECT_NEAR(chain.x, 4 * zeta3 / (4 * pi), 1e-14);
  EXPECT_NEAR(chain.y, -2 * zeta3 / (4 * pi), 1e-14);
  // The sum is 4 * zeta(3/2) * beta(3/2).
  double const square_sum = 4 * std::riemann_zeta(1.5) * 0.8645026534612020;
  auto const square = of_uniform(cubic, {4, 3, 1}, {.periodic_images = {all, all, 0}}, {0, 1, 1});
  EXPECT_NEAR(square.z, -square_sum / (4 * pi), 1e-13);
  EXPECT_NEAR(square.y, square_sum / (8 * pi), 1e-13);
  EXPECT_NEAR(square_sum, 9.0336216831, 1e-9);
  // On a triangular lattice the sum is 6 * zeta(3/2) * L(3/2), with the Dirichlet series L of the
  // coefficients 1, -1, 0, 1, -1, 0, ...
  double l = 0;
  for (int n = 2000000; n >= 0; --n) l += std::pow(3. * n + 1, -1.5) - std::pow(3. * n + 2, -1.5);
  Crystal const triangular{Crystal::honeycomb().cell, {{0, 0, 0}}};
  auto const flat =
      of_uniform(triangular, {3, 4, 1}, {.periodic_images = {all, all, 0}}, {0, 0, 1});
  EXPECT_NEAR(flat.z, -6 * std::riemann_zeta(1.5) * l / (4 * pi), 1e-9);
}

// The error in the middle of an open chain falls as 1/n^2.
TEST(LatticeSums, LongOpenChainsComeCloseToPeriodicOnes) {
  auto const cubic = Crystal::simple_cubic();
  double const expected =
      of_uniform(cubic, {5, 1, 1}, {.periodic_images = {all, 0, 0}}, {1, 0, 0}).x;
  for (std::int64_t const n : {101, 1001}) {
    auto const lattice = cubic.lattice({n, 1, 1});
    SpinField<double, Kokkos::HostSpace> spins("spins", lattice), field("field", lattice);
    for (std::int64_t site = 0; site < n; ++site) spins.set(site, {1, 0, 0});
    DipolarField<double>(lattice, cubic)(spins, field, 0);
    double const half = static_cast<double>(n) / 2;
    EXPECT_NEAR(expected - field.get(n / 2).x, 2 / (4 * std::numbers::pi * half * half),
                0.01 / (half * half));
  }
}

// Far away, the field of a dipole equals that of a cell in DemagnetizingField: both have the same
// unit, at any spacing.
TEST(LatticeSums, DipolesHaveTheUnitOfCells) {
  Lattice const lattice{.shape = {40, 1, 1}, .spacing = {0.7, 0.5, 0.6}};
  SpinField<double, Kokkos::HostSpace> spins("spins", lattice), points("points", lattice),
      cells("cells", lattice);
  for (std::int64_t site = 0; site < 40; ++site) spins.set(site, {0, 0, 0});
  spins.set(0, {0.6, 0, 0.8});
  DipolarField<double>(lattice, Crystal::simple_cubic())(spins, points, 0);
  DemagnetizingField<double> const demag(lattice);
  demag(spins, cells, 0);
  EXPECT_NEAR(points.get(39).x / cells.get(39).x, 1, 1e-3);
  EXPECT_NEAR(points.get(39).z / cells.get(39).z, 1, 1e-3);
}

// Finds the eigenvalue by power iteration, with different moments in a cell.
TEST(DipolarBound, IsAboveTheLargestEigenvalueAndNotFarAbove) {
  for (auto sample : open_crystals)
    for (auto const& images : {Images{}, {all, all, 0}, {all, all, all}}) {
      for (auto& cells : sample.cells)
        if (cells > 1) cells = 4;
      auto const lattice = sample.lattice();
      std::vector<double> moments;
      for (std::size_t site = 0; site < sample.crystal.basis.size(); ++site)
        moments.push_back(1 + 0.5 * static_cast<double>(site % 2));
      auto const moment_of = [&](std::int64_t site) {
        auto const plane = static_cast<std::size_t>(site / (lattice.shape[0] * lattice.shape[1]));
        return moments[plane % moments.size()];
      };
      DipolarField<double> const dipoles(lattice, sample.crystal, {.periodic_images = images});
      using Spins = SpinField<double, Kokkos::HostSpace>;
      auto spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 5));
      Spins field("field", lattice);
      double eigenvalue = 0;
      for (int i = 0; i < 60; ++i) {
        double of_spins = 0, of_field = 0;
        for (std::int64_t site = 0; site < lattice.sites(); ++site) {
          of_spins += dot(spins.get(site), spins.get(site));
          spins.set(site, std::sqrt(moment_of(site)) * spins.get(site));
        }
        dipoles(spins, field, 0);
        for (std::int64_t site = 0; site < lattice.sites(); ++site) {
          auto const h = std::sqrt(moment_of(site)) * field.get(site);
          of_field += dot(h, h);
          spins.set(site, h);
        }
        eigenvalue = std::sqrt(of_field / of_spins);
        for (std::int64_t site = 0; site < lattice.sites(); ++site)
          spins.set(site, 1 / std::sqrt(of_field) * spins.get(site));
      }
      double const bound = dipolar_bound(lattice, sample.crystal, moments, images);
      EXPECT_GE(bound, eigenvalue);
      bool const is_lattice = lattice.shape[0] > 1;
      EXPECT_LE(bound, is_lattice ? 7 * eigenvalue : bound) << moments.size();
    }
}

// The film has one layer of cells. Its thickness `across` scales the dipoles, but does not change
// the distances between them.
TEST(DipolarBound, OfAThinFilmIsNotFarAboveThatOfItsLayer) {
  for (double const across : {0.1, 0.6, 2.0}) {
    Lattice film = Lattice::square(16, 16);
    film.spacing[2] = across;
    // The sum of 1/r^3 over an infinite square lattice is 9.0336.
    double const layer = 9.0336 * across / (4 * std::numbers::pi);
    Crystal const cubic{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {{0, 0, 0}}};
    double const bound = dipolar_bound(film, cubic, {1});
    EXPECT_GE(bound, layer);
    EXPECT_LE(bound, 3 * layer) << across;
  }
}

TEST(DipolarBound, NeedsAMomentForEachSite) {
  auto const crystal = Crystal::bcc();
  auto const lattice = crystal.lattice({2, 2, 2});
  for (auto const& moments : {std::vector<double>{}, {1.0}, {1.0, 1.0, 1.0}})
    EXPECT_THROW(dipolar_bound(lattice, crystal, moments), std::invalid_argument);
  EXPECT_GT(dipolar_bound(lattice, crystal, {1, 1}), 0);
}

// Chains along y, each of which consists of one site and its images.
TEST(DipolarBound, CountsImagesAlongAnAxisOfOneCell) {
  Crystal const chains{{{{1, 0, 0}, {0, 0.3, 0}, {0, 0, 1}}}, {{0, 0, 0}}};
  for (int const images : {1, 20, all}) {
    Images const along_y{0, images, 0};
    auto const h = of_uniform(chains, {2, 1, 1}, {.periodic_images = along_y}, {0, 1, 0});
    double const bound = dipolar_bound(chains.lattice({2, 1, 1}), chains, {1}, along_y);
    EXPECT_GE(bound, h.y);
    EXPECT_LE(bound, 7 * h.y);
  }
}

}  // namespace
}  // namespace cayspin::test
