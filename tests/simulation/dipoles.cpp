// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes with dipoles of crystals, compared with sums over pairs and closed forms.
#include "scenes_of_text.hpp"
#include "simulation/multirate_method.hpp"

#include <cayspin/units.hpp>
#include <cayspin/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

io::Scene with_dipoles(std::string const& lattice, std::string const& field,
                       std::vector<std::string> const& overrides = {}) {
  return scene_of("system = { kind = 'llg', damping = 0.1 }\n[lattice]\n" + lattice +
                      "\n[field]\n" + field +
                      "\n[initial]\nrandom = { seed = 3 }\n[integrator]\nmethod = 'heun'\n"
                      "dt = 0.02\nsteps = 20\n",
                  overrides);
}

std::string const oblique =
    "shape = [4, 3, 3]\ncell = [[1, 0.2, 0], [-0.3, 1.1, 0.1], [0, 0.2, 0.9]]\n"
    "basis = [[0, 0, 0], [0.5, 0.1, 0], [0.2, 0.5, 0.4], [0.7, 0.8, 0.6]]\n";

struct Moments {
  std::vector<Vec3<double>> places, m;
  std::vector<double> moments;
};

/// Returns the moments of a scene in reduced units, in the order of its spins.
Moments moments_of(io::Scene const& scene, std::vector<double> const& spins) {
  Moments all;
  auto const crystal = io::crystal(scene.lattice);
  auto const basis = static_cast<std::int64_t>(crystal.basis.size());
  auto const& [nx, ny, planes] = scene.lattice.shape;
  io::SiteBox const box{{0, 0, 0}, scene.lattice.shape};
  auto const occupied = io::occupied(scene, box);
  auto const of_sites = io::moments_of_sites(scene, box);
  for (std::int64_t site = 0; site < nx * ny * planes; ++site) {
    std::int64_t const plane = site / (nx * ny);
    auto const of_cell = static_cast<std::size_t>(plane % basis);
    auto const r = crystal.position({site % nx, site / nx % ny, plane / basis}, of_cell);
    auto const& s = scene.lattice.spacing;
    auto const i = static_cast<std::size_t>(site);
    all.places.push_back({s[0] * r[0], s[1] * r[1], s[2] * r[2]});
    all.m.push_back({spins[3 * i], spins[3 * i + 1], spins[3 * i + 2]});
    double const moment =
        of_sites.empty() ? io::of_cell_site(scene.lattice.moments, of_cell) : of_sites[i];
    all.moments.push_back(occupied.empty() || occupied[i] ? moment : 0);
  }
  return all;
}

/// Returns the sum of mu * (3 * (r.m) * r - r^2 * m) / (4 * pi * r^5) over all other sites, where r
/// is the vector from the other site.
Vec3<double> field_at(Moments const& all, std::size_t site) {
  Vec3<double> h{0, 0, 0};
  for (std::size_t other = 0; other < all.m.size(); ++other) {
    if (other == site) continue;
    auto const r = all.places[site] - all.places[other];
    double const r2 = dot(r, r);
    auto const& m = all.m[other];
    h = h + all.moments[other] / (4 * pi * r2 * r2 * std::sqrt(r2)) * (3 * dot(r, m) * r - r2 * m);
  }
  return h;
}

TEST(Dipoles, OfScenesAreSumsOverPairs) {
  for (auto const* const moments :
       {"", "moments = [1, 0.5, 2, 1.5]", "moments = [1, 0, 2, 0.25]",
        "moments = '0.5 + 0.2*i + 0.1*s'", "occupied = 'i + j > 1'",
        "moments = [1, 0.5, 2, 1.5]\noccupied = 'i + j > 1'", "spacing = 2"})
    for (auto const precision : precisions) {
      auto const scene =
          with_dipoles(oblique + moments, "mu0 = 2\ndipoles = { strength = 0.75 }\n");
      auto const run = SceneRun::open(scene, {.precision = precision});
      auto const all = moments_of(scene, spins_of(*run));
      auto const found = packed<double>(run->field().vectors);
      double const volume = std::pow(scene.lattice.spacing[0], 3);
      double energy = 0;
      for (std::size_t site = 0; site < all.m.size(); ++site) {
        if (all.moments[site] == 0) continue;
        auto const h = 1.5 * volume * field_at(all, site);
        energy -= all.moments[site] * dot(all.m[site], h) / 2;
        double const tolerance = 100 * epsilon(precision);
        EXPECT_NEAR(found[3 * site], h.x, tolerance) << moments << ", site " << site;
        EXPECT_NEAR(found[3 * site + 1], h.y, tolerance) << moments << ", site " << site;
        EXPECT_NEAR(found[3 * site + 2], h.z, tolerance) << moments << ", site " << site;
      }
      auto const count = static_cast<double>(all.m.size());
      EXPECT_NEAR(run->sample().energy.value, energy, 20 * count * epsilon(precision)) << moments;
      auto const terms = run->energies();
      ASSERT_EQ(terms.size(), 1U);
      EXPECT_EQ(terms[0].first, "dipoles");
      EXPECT_NEAR(terms[0].second, energy, 20 * count * epsilon(precision)) << moments;
    }
}

// At each site, the field of couplings is divided by the moment; the dipolar field is not.
TEST(Dipoles, StandBesideCouplings) {
  std::string const lattice = "shape = [3, 4, 2]\ncrystal = 'bcc'\nmoments = [0.5, 2]\n",
                    couplings =
                        "couplings = { shells = [0.7] }\n"
                        "anisotropy = { constant = 0.3, axis = [1, 2, 3], site = 1 }\n",
                    applied = "applied = [0.1, -0.2, 0.3]\n";
  auto const field_of = [&](std::string const& field) {
    return packed<double>(SceneRun::open(with_dipoles(lattice, field), {})->field().vectors);
  };
  auto const both = field_of(couplings + applied + "dipoles = true\n");
  auto const bonds = field_of(couplings + applied), dipoles = field_of("dipoles = true\n");
  for (std::size_t i = 0; i < both.size(); ++i)
    EXPECT_NEAR(both[i], bonds[i] + dipoles[i], 1e-14) << i;
}

TEST(Dipoles, AreTheDemagOfCrystalsAndNotOfCells) {
  auto const end = [](std::string const& lattice, std::string const& field) {
    return end_of(with_dipoles(lattice, field));
  };
  for (std::string const lattice :
       {"shape = [3, 4, 2]\ncrystal = 'bcc'\nmoments = [0.5, 2]",
        "shape = [5, 4]\ncell = [[1, 0, 0], [0.5, 0.8, 0], [0, 0, 1]]\nboundary = 'periodic'"})
    EXPECT_EQ(end(lattice, "demag = true"), end(lattice, "dipoles = true"));
  EXPECT_GT(largest_distance(end("shape = [5, 4, 2]\nspacing = [1, 1, 0.5]", "demag = true"),
                             end("shape = [5, 4, 2]\nspacing = [1, 1, 0.5]", "dipoles = true")),
            1e-3);
}

// At a distance r = 0.25 nm along its moment mu, the field of an atom in T is mu0 * mu / (2 * pi *
// r^3).
TEST(Dipoles, AreInTeslaAndJoules) {
  auto const scene = scene_of(R"toml(
units = "SI"
system = { kind = "llg" }
[material]
mu_s = { bohr_magnetons = [2.2, 0.5] }
alpha = 0
[lattice]
shape = [1, 1, 1]
spacing = 5e-10
basis = [[0, 0, 0], [0.5, 0, 0]]
[field]
dipoles = true
[initial]
uniform = [1, 0, 0]
[integrator]
method = "heun"
dt = 1e-15
steps = 1
)toml");
  auto const run = SceneRun::open(scene, {});
  auto const field = packed<double>(run->field().vectors);
  double const per_moment =
      units::vacuum_permeability * units::bohr_magneton / (2 * pi * std::pow(2.5e-10, 3));
  EXPECT_NEAR(field[0] / (0.5 * per_moment), 1, 1e-14);
  EXPECT_NEAR(field[3] / (2.2 * per_moment), 1, 1e-14);
  double const energy = -2.2 * 0.5 * per_moment * units::bohr_magneton;
  EXPECT_NEAR(run->sample().energy.value / energy, 1, 1e-14);
}

TEST(Dipoles, OfPeriodicCrystalsHaveLorentzsField) {
  auto const field_of = [](std::string const& dipoles) {
    auto const scene = scene_of(
        "system = { kind = 'llg', damping = 0.1 }\n"
        "lattice = { shape = [2, 3, 2], crystal = 'fcc', boundary = 'periodic', spacing = 3 }\n"
        "initial = { uniform = [0.6, 0, 0.8] }\nfield = { dipoles = " +
        dipoles + " }\nintegrator = { method = 'heun', dt = 0.1, steps = 1 }\n");
    return packed<double>(SceneRun::open(scene, {})->field().vectors);
  };
  auto const foil = field_of("true"), film = field_of("{ demagnetizing_factors = [0, 0, 1] }");
  for (std::size_t site = 0; site < 48; ++site) {
    EXPECT_NEAR(foil[3 * site], 0.6 * 4 / 3, 1e-12);
    EXPECT_NEAR(foil[3 * site + 1], 0, 1e-12);
    EXPECT_NEAR(foil[3 * site + 2], 0.8 * 4 / 3, 1e-12);
    EXPECT_NEAR(film[3 * site + 2], -0.8 * 4 * 2 / 3, 1e-12);
  }
}

// Dipoles in a chain align along it. Each dipole then has an energy of -2 * zeta(3) / (4 * pi).
TEST(Dipoles, OfAChainRelaxAlongIt) {
  auto const scene = with_dipoles("shape = [24]\nboundary = 'periodic'", "dipoles = true");
  auto const run = SceneRun::open(scene, {});
  auto const minimum = run->relax({.torque = 1e-9});
  EXPECT_EQ(minimum.end, MinimizeEnd::converged);
  EXPECT_NEAR(run->sample().energy.value, -24 * 2 * 1.2020569031595942 / (4 * pi), 1e-11);
}

TEST(Dipoles, MayBeMultirate) {
  std::string const lattice = "shape = [3, 4, 2]\ncrystal = 'bcc'\nmoments = [0.5, 2]\n";
  auto const scene = [&](std::string const& dipoles) {
    return with_dipoles(lattice, "couplings = { shells = [0.7] }\ndipoles = " + dipoles,
                        {"integrator.method='rkmk4'"});
  };
  EXPECT_FALSE(has_slow_field(scene("true")));
  auto const multirate = scene("{ strength = 0.2, multirate = true }");
  EXPECT_TRUE(has_slow_field(multirate));
  EXPECT_EQ(without_multirate(multirate), "field.dipoles.multirate=false");
  EXPECT_LT(largest_distance(end_of(multirate), end_of(scene("{ strength = 0.2 }"))), 1e-5);
}

TEST(Dipoles, GoOnAfterABreak) {
  for (auto const precision : precisions)
    expect_same_bits_after_a_break(
        scene_of("system = { kind = 'llg', damping = 0.1 }\n"
                 "thermal = { temperature = 0.1, seed = 4 }\n"
                 "lattice = { shape = [3, 4, 2], crystal = 'hcp', moments = [0.5, 2], "
                 "frozen = 'i == 0', boundary = ['periodic', 'open', 'periodic'] }\n"
                 "field = { dipoles = true, couplings = { shells = [0.7] } }\n"
                 "initial = { random = { seed = 5 } }\n"
                 "integrator = { method = 'heun', dt = 0.02, steps = 20 }\n"),
        7, precision);
}

// Moments of 4 have four times the field and a quarter of the largest stable step.
TEST(Dipoles, BoundTheStableStep) {
  auto const stable = [](std::string const& rest) {
    auto const scene = with_dipoles("shape = [4, 4, 4]\ncrystal = 'bcc'\n" + rest,
                                    "dipoles = { strength = 3, multirate = false }",
                                    {"integrator.method='rkmk4'"});
    return make_plan(scene, Precision::double_precision).stable_dt;
  };
  double const of_one = stable("");
  EXPECT_GT(of_one, 0.05);
  EXPECT_LT(of_one, 1);
  EXPECT_NEAR(stable("moments = 4"), of_one / 4, 1e-12);
  EXPECT_NEAR(stable("gyromagnetic = 2"), of_one / 2, 1e-12);
  EXPECT_NEAR(stable("moments = '4'"), of_one / 4, 1e-12);
}

TEST(Dipoles, CountTheirMemory) {
  auto const bytes = [](std::string const& field) {
    auto const scene = with_dipoles("shape = [16, 16, 16]\ncrystal = 'bcc'", field);
    return make_plan(scene, Precision::double_precision).memory.field;
  };
  // The kernel has 24 values at each of 17 x 32 x 32 wave numbers. The buffer has 3 complex values
  // in each of 17 x 512 rows.
  std::int64_t const expected = 8 * (17 * 32 * 32 * 24 + 2 * 3 * 17 * 512);
  auto const found = bytes("dipoles = true") - bytes("applied = [0, 0, 1]");
  EXPECT_GE(found, expected);
  EXPECT_LE(found, expected + 8 * 3 * 32 * 18 * 18 * 3);  // memory for H
}

}  // namespace
}  // namespace cayspin::simulation::test
