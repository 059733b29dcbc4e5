// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The anisotropy at open sides by which a scene represents the free boundary of DMI.
#include "scene_file.hpp"

#include <cayspin/crystal.hpp>

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string const dmi_film = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [4, 3, 2]
[field]
exchange = 2
dmi = { interfacial = 0.6, normal = [0, 0, 1], free_boundary = true }
[initial]
uniform = [0, 0, 1]
[integrator]
method = "heun"
dt = 0.1
steps = 1
)toml";

/// Returns for each site the sum of the anisotropy constants along an axis.
std::vector<double> constants_along(Scene const& scene, Triple const& axis) {
  std::vector<double> sum(static_cast<std::size_t>(sites(scene)));
  for (auto const& term : scene.field.anisotropies) {
    if (std::abs(cayspin::detail::scalar_product(axis, term.axis)) < 0.999) continue;
    auto const found = numbers_of_sites(scene, term.factors, "field.anisotropy", whole(scene));
    for (std::size_t site = 0; site < sum.size(); ++site) sum[site] += found[site];
  }
  return sum;
}

// Each open side adds a constant of -D^2 / A along the DMI vector of its bonds. A is the scene's
// exchange: H = A * Lap(m).
TEST(FreeBoundary, IsAHardAxisAtEachOpenSide) {
  auto const scene = scene_of(dmi_film);
  EXPECT_EQ(scene.field.anisotropies.size(), 2U);  // no DMI along the normal, z
  auto const of_x = constants_along(scene, {0, 1, 0}), of_y = constants_along(scene, {1, 0, 0});
  double const one = -0.6 * 0.6 / 2;
  for (std::size_t site = 0; site < 24; ++site) {
    auto const i = site % 4, j = site / 4 % 3;
    EXPECT_DOUBLE_EQ(of_x[site], i == 0 || i == 3 ? one : 0) << site;
    EXPECT_DOUBLE_EQ(of_y[site], j == 0 || j == 2 ? one : 0) << site;
  }
  EXPECT_TRUE(needs_pass(scene));
  auto const periodic = scene_of(dmi_film, {"lattice.boundary=['open','periodic','open']"});
  for (double const each : constants_along(periodic, {1, 0, 0})) EXPECT_EQ(each, 0);
  EXPECT_TRUE(scene_of(replaced(dmi_film, "free_boundary = true", "free_boundary = false"))
                  .field.anisotropies.empty());
}

// With spacing h, the boundary condition gives the spin beyond the end:
//   m' = m + (h * D / A) * m x d.
// The bond to that spin has the field
//   (A / h^2) * (m' - m) + (D / h) * d x m',
// which exerts the torque of this anisotropy.
TEST(FreeBoundary, IsTheTorqueOfATurnedSpin) {
  using cayspin::detail::scalar_product, cayspin::detail::vector_product;
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  auto const draw = [&] { return Triple{normal(random), normal(random), normal(random)}; };
  auto const unit = [](Triple const& v) {
    double const length = std::hypot(v[0], v[1], v[2]);
    return Triple{v[0] / length, v[1] / length, v[2] / length};
  };
  auto const sum = [](Triple const& a, double factor, Triple const& b) {
    return Triple{a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
  };
  for (int round = 0; round < 20; ++round) {
    auto const n = unit(draw()), m = unit(draw());
    constexpr double A = 2, D = 0.6, h = 0.5;
    auto const scene = scene_of(
        dmi_film, {"lattice={shape=[3],spacing=0.5}",
                   fmt::format("field.dmi={{interfacial=0.6,normal=[{},{},{}],free_boundary=true}}",
                               n[0], n[1], n[2])});
    ASSERT_EQ(scene.field.anisotropies.size(), 1U);
    auto const& term = scene.field.anisotropies[0];
    double const K = numbers_of_sites(scene, term.factors, "", whole(scene))[2];
    auto const d = vector_product(n, Triple{1, 0, 0});
    auto const beyond = sum(m, h * D / A, vector_product(m, d));
    auto field = sum(Triple{}, D / h, vector_product(d, beyond));
    field = sum(field, A / (h * h), sum(beyond, -1, m));
    auto const difference =
        sum(field, -K * scalar_product(m, term.axis), term.axis);  // parallel to m
    for (double const torque : vector_product(m, difference)) EXPECT_NEAR(torque, 0, 1e-14);
  }
}

TEST(FreeBoundary, OfTheBulkIsAlongTheBonds) {
  auto const scene = scene_of(dmi_film, {"field.dmi={bulk=0.6,free_boundary=true}"});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Triple along{};
    along[axis] = 1;
    auto const found = constants_along(scene, along);
    for (std::size_t site = 0; site < 24; ++site) {
      std::size_t const at[]{site % 4, site / 4 % 3, site / 12}, last[]{3, 2, 1};
      EXPECT_DOUBLE_EQ(found[site], at[axis] == 0 || at[axis] == last[axis] ? -0.18 : 0);
    }
  }
}

TEST(FreeBoundary, OfD2dIsAlongTheBondsInThePlane) {
  auto const scene = scene_of(dmi_film, {"field.dmi={d2d=0.6,free_boundary=true}"});
  EXPECT_EQ(scene.field.anisotropies.size(), 2U);
  auto const of_x = constants_along(scene, {1, 0, 0}), of_y = constants_along(scene, {0, 1, 0});
  for (std::size_t site = 0; site < 24; ++site) {
    EXPECT_DOUBLE_EQ(of_x[site], site % 4 == 0 || site % 4 == 3 ? -0.18 : 0);
    EXPECT_DOUBLE_EQ(of_y[site], site / 4 % 3 == 1 ? 0 : -0.18);
  }
}

TEST(FreeBoundary, IsAlsoThatOfVacancies) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 20; ++round) {
    auto const is_there = fmt::format("random(i+4*j+12*k, {}) < 0.7", random() % 1000);
    auto const scene = scene_of(
        dmi_film,
        {"lattice.occupied='" + is_there + "'", "lattice.boundary=['open','periodic','open']",
         "field.exchange='" + is_there + " ? 1+i : 0'",
         "field.dmi={interfacial='0.1*(1+j)',normal=[0,0,1],free_boundary=true}"});
    auto const there = occupied(scene, whole(scene));
    auto const has = [&](int i, int j, int k) {
      return i >= 0 && i < 4 && there[static_cast<std::size_t>((k * 3 + (j + 3) % 3) * 4 + i)];
    };
    auto const of_x = constants_along(scene, {0, 1, 0}), of_y = constants_along(scene, {1, 0, 0});
    for (int k = 0, site = 0; k < 2; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i, ++site) {
          double const one = has(i, j, k) ? -0.01 * (1 + j) * (1 + j) / (1 + i) : 0;
          auto const n = static_cast<std::size_t>(site);
          EXPECT_NEAR(of_x[n], one * (!has(i - 1, j, k) + !has(i + 1, j, k)), 1e-15);
          EXPECT_NEAR(of_y[n], one * (!has(i, j - 1, k) + !has(i, j + 1, k)), 1e-15);
        }
    // In a part of the lattice, the values are those of the whole lattice.
    for (auto const& term : scene.field.anisotropies) {
      SiteBox const box{{1, 1, 1}, {2, 2, 1}};
      auto const all = numbers_of_sites(scene, term.factors, "", whole(scene));
      EXPECT_EQ(numbers_of_sites(scene, term.factors, "", box),
                numbers_in(box, scene.lattice.shape, 1, all));
    }
  }
}

// In mumax3, mirror spins at open sides act as a hard axis with Ku = -D^2 / (4 * A).
TEST(FreeBoundary, InSiIsThatOfMumax) {
  std::string const si = R"toml(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
D = 3e-3
normal = [0, 0, 1]
free_boundary = true
alpha = 0.1
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [4]
spacing = [2e-9, 1e-9, 1e-9]
[initial]
uniform = [0, 0, 1]
[integrator]
method = "heun"
dt = 1e-14
steps = 1
)toml";
  auto const scene = scene_of(si);
  // For comparison, a constant typed in SI: it is divided by mu0 Ms^2 / 2.
  double const ku = -9e-6 / (4 * 1.3e-11);
  auto const typed =
      scene_of(si, {"field.anisotropy={constant=" + fmt::format("{}", ku) + ",axis=[0,1,0]}"});
  auto const found = constants_along(scene, {0, 1, 0});
  EXPECT_NEAR(found[0], typed.field.anisotropies[0].constant, 1e-14 * std::abs(found[0]));
  EXPECT_EQ(found[1], 0);
  EXPECT_EQ(found[0], found[3]);
}

TEST(FreeBoundary, IsRefusedWithoutWhatItNeeds) {
  auto const said = [&](std::vector<std::string> const& overrides) {
    return refusal([&] { scene_of(dmi_film, overrides); });
  };
  expect_holds(said({"field.exchange=0"}), "field.dmi.free_boundary: needs exchange above 0");
  expect_holds(said({"field.exchange=-1"}), "needs exchange above 0");
  expect_holds(said({"field.dmi.free_boundary=1"}), "true, false");
  expect_holds(said({"field.dmi={free_boundary=true}"}), "field.dmi.interfacial: is missing");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
