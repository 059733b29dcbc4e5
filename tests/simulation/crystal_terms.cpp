// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Anisotropies of crystals and DMI of D2d symmetry, compared with closed forms and with derivatives
// of the energy.
#include "scenes_of_text.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

using Vector = std::array<double, 3>;

Vector cross(Vector const& a, Vector const& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(Vector const& a, Vector const& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Returns dE/d(angle) as the spin at `site` of a 5 x 4 x 3 lattice turns about e, from the
/// energies at 15 angles, pi / 8 apart. This is exact for energies without harmonics above the
/// seventh.
double slope_about(SceneRun& run, std::vector<double> const& spins, std::size_t site,
                   Vector const& e) {
  Vector const m{spins[3 * site], spins[3 * site + 1], spins[3 * site + 2]};
  auto const turned_by = cross(e, m);
  double slope = 0;
  for (int i = 1; i < 16; ++i) {
    double const angle = i * pi / 8, c = std::cos(angle), s = std::sin(angle);
    auto turned = spins;
    for (std::size_t k = 0; k < 3; ++k)
      turned[3 * site + k] = c * m[k] + s * turned_by[k] + (1 - c) * dot(e, m) * e[k];
    run.set_spins({turned.data(), true, {3, 4, 5}, {60, 15, 3, 1}});
    slope += (i % 2 == 0 ? -0.5 : 0.5) / std::tan(angle / 2) * run.sample().energy.value;
  }
  return slope;
}

std::string film_with(std::string const& lattice, std::string const& field) {
  return "system = { kind = 'llg', damping = 0.1 }\n[lattice]\nshape = [5, 4, 3]\n"
         "spacing = [0.8, 1, 1.25]\nboundary = ['open', 'periodic', 'open']\n" +
         lattice + "[field]\n" + field +
         "[initial]\nrandom = { seed = 7 }\n"
         "[integrator]\nmethod = 'heun'\ndt = 0.01\nsteps = 1\n";
}

TEST(CrystalTerms, AreTheDerivativeOfTheirEnergy) {
  std::string const regions = "regions = 'i < 2 ? 0 : j % 2 + 1'\n";
  std::string const axes =
      "{ regions = [[1, 0, 0], [1, 1, 0], [0, 3, 4]] }, { regions = [[0, 1, 1], [1, -1, 0], [1, 0, "
      "0]] }";
  for (std::string const& field :
       {std::string(
            "anisotropy = { cubic = 0.3, axes = [[1, 2, 2], [2, 1, -2]], constant2 = -2 }\n"),
        "anisotropy = { cubic = '0.3 - 0.1*i', constant2 = { regions = [1, -2, 3] }, axes = [" +
            axes + "] }\n",
        std::string("anisotropy = { hexagonal = 0.4, axis = [1, 2, 2], in_plane = [2, 1, -2] }\n"),
        std::string("anisotropy = { hexagonal = { regions = [0.4, 0, -0.2] }, axis = ['i+1', 'j', "
                    "0], in_plane = ['-j', 'i+1', 0] }\n"),
        std::string("dmi = { d2d = 0.7 }\n"), std::string("dmi = { d2d = '0.7 - 0.2*j' }\n"),
        std::string("dmi = { interfacial = '0.7 - 0.2*j', normal = ['i - 1.5', 'j', 1] }\n"),
        std::string(
            "exchange = '1 + 0.2*i'\nexchange_between = [{ between = [0, 1], factor = 0.3 "
            "}]\ndmi = { d2d = 0.3 }\nanisotropy = [{ constant = 1, axis = [1, 2, 3] }, { "
            "constant = '0.1*i', axis = [0, 0, 1] }, { cubic = 1, axes = [[1, 0, 0], [0, 1, "
            "0]] }, { hexagonal = 0.1, axis = [0, 0, 1], in_plane = [1, 1, 0] }]\nin_time = "
            "{ exchange = 'cos(t) - 0.4', anisotropy = -0.7, dmi = '2*exp(-t)' }\n"
            "slab_demag = { normal = [0, 0, 1] }\n")})
    for (std::string const lattice :
         {"", "occupied = 'i != 2 || j != 1'\n", "moments = { regions = [1, 0.25, 2] }\n"}) {
      auto const scene = scene_of(film_with(regions + lattice, field));
      auto const run = SceneRun::open(scene, {});
      auto const spins = spins_of(*run);
      auto const h_of = packed<double>(run->field().vectors);
      auto const moments = io::moments_of_sites(scene, {{0, 0, 0}, scene.lattice.shape});
      for (std::size_t const site : {0U, 13U, 38U, 59U})
        for (Vector const& e : {Vector{1, 0, 0}, Vector{0, 0.6, 0.8}}) {
          Vector const m{spins[3 * site], spins[3 * site + 1], spins[3 * site + 2]};
          Vector const h{h_of[3 * site], h_of[3 * site + 1], h_of[3 * site + 2]};
          double const moment = moments.empty() ? 1 : moments[site];
          EXPECT_NEAR(-slope_about(*run, spins, site, e), moment * dot(e, cross(m, h)), 2e-12)
              << site << field << lattice;
        }
    }
}

// A helix that turns right-handed by q per site about its axis e has m.(m' x e) = sin(q) for any
// phase, where m' is the next spin after m.
TEST(CrystalTerms, D2dTurnsSpinsToTheLeftAlongXAndToTheRightAlongY) {
  constexpr double D = 0.3;
  auto const energy = [&](std::string const& shape, std::string const& normal,
                          std::string const& direction) {
    auto const scene = llg_scene(
        "0.1", "heun", 1,
        fmt::format(
            "[lattice]\nshape = {}\nboundary = 'periodic'\nspacing = 0.5\n[field]\ndmi = {{ "
            "d2d = {} }}\n[initial]\nstate = 'helix'\nperiod = 4\nnormal = {}\ndirection = "
            "{}\n",
            shape, D, normal, direction));
    return SceneRun::open(scene, {})->sample().energy.value;
  };
  double const of_bond = D / 0.5 * std::sin(2 * pi / 8);
  EXPECT_NEAR(energy("[16, 1, 1]", "[1, 0, 0]", "[1, 0, 0]"), 16 * of_bond, 1e-13);
  EXPECT_NEAR(energy("[16, 1, 1]", "[-1, 0, 0]", "[1, 0, 0]"), -16 * of_bond, 1e-13);
  EXPECT_NEAR(energy("[1, 16, 1]", "[0, 1, 0]", "[0, 1, 0]"), -16 * of_bond, 1e-13);
  EXPECT_NEAR(energy("[1, 16, 1]", "[0, -1, 0]", "[0, 1, 0]"), 16 * of_bond, 1e-13);
  for (std::string const normal : {"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"})
    EXPECT_NEAR(energy("[1, 1, 16]", normal, "[0, 0, 1]"), 0, 1e-13);
  // Cycloids have no D2d energy.
  EXPECT_NEAR(energy("[16, 1, 1]", "[0, 1, 0]", "[1, 0, 0]"), 0, 1e-13);
  EXPECT_NEAR(energy("[16, 1, 1]", "[0, 0, 1]", "[1, 0, 0]"), 0, 1e-13);
}

// On a chain along x or y, D2d acts like bulk DMI of one sign or the other, also at free
// boundaries. On a chain along z it has no effect.
TEST(CrystalTerms, D2dIsThatOfTheBulkAlongAnAxis) {
  auto const end = [](std::string const& shape, std::string const& dmi, Precision precision) {
    return end_of(llg_scene("0.1", "rkmk4", 100,
                            fmt::format("[lattice]\nshape = {}\n[field]\nexchange = 1\ndmi = {}\n"
                                        "[initial]\nrandom = {{ seed = 3 }}\n",
                                        shape, dmi)),
                  precision);
  };
  for (auto const precision : precisions)
    for (std::string const more : {"", ", free_boundary = true"}) {
      double const allowed = 100 * 16 * epsilon(precision);
      auto const of = [&](std::string const& shape, std::string const& dmi) {
        return end(shape, "{ " + dmi + more + " }", precision);
      };
      EXPECT_LT(largest_distance(of("[20, 1, 1]", "d2d = 0.4"), of("[20, 1, 1]", "bulk = -0.4")),
                allowed);
      EXPECT_LT(largest_distance(of("[1, 20, 1]", "d2d = 0.4"), of("[1, 20, 1]", "bulk = 0.4")),
                allowed);
      EXPECT_LT(largest_distance(of("[1, 1, 20]", "d2d = 0.4"), of("[1, 1, 20]", "bulk = 0.0")),
                allowed);
    }
}

// Regions with opposite normals act like regions with D of opposite signs.
TEST(CrystalTerms, NormalsOfRegionsAreThoseOfTheirInterfaces) {
  auto const end = [](std::string const& dmi) {
    return end_of(scene_of(film_with("regions = 'k % 3'\n", "exchange = 1\ndmi = " + dmi + "\n")));
  };
  auto const one = end("{ interfacial = { regions = [0.3, -0.2, 0.1] }, normal = [1, 2, 2] }");
  auto const other = end(
      "{ interfacial = { regions = [0.3, 0.2, 0.1] }, normal = { regions = [[1, 2, 2], [-2, -4, "
      "-4], [0.5, 1, 1]] } }");
  EXPECT_LT(largest_distance(one, other), 16 * epsilon(Precision::double_precision));
}

double energy_of_spin(std::string const& anisotropy, std::string const& start) {
  return SceneRun::open(
             llg_scene("0", "heun", 1,
                       fmt::format("lattice = {{ shape = [1] }}\nfield = {{ anisotropy = "
                                   "{} }}\ninitial = {{ uniform = {} }}\n",
                                   anisotropy, start)),
             {})
      ->sample()
      .energy.value;
}

TEST(CrystalTerms, HaveTheEnergiesOfTheirDirections) {
  std::string const cubic = "{ cubic = 3, constant2 = 5, axes = [[0, 0, 1], [1, 0, 0]] }";
  EXPECT_NEAR(energy_of_spin(cubic, "[0, -1, 0]"), 0, 1e-15);
  EXPECT_NEAR(energy_of_spin(cubic, "[1, 0, -1]"), 3.0 / 4, 1e-15);
  EXPECT_NEAR(energy_of_spin(cubic, "[1, -1, 1]"), 3.0 / 3 + 5.0 / 27, 1e-15);
  std::string const hexagonal = "{ hexagonal = 3, axis = [1, 0, 0], in_plane = [0, 1, 1] }";
  EXPECT_NEAR(energy_of_spin(hexagonal, "[1, 0, 0]"), 0, 1e-15);
  for (int degrees = 0; degrees < 180; degrees += 10) {
    double const phi = degrees * pi / 180, theta = 0.9;
    double const a = std::sin(theta) * std::cos(phi), b = std::sin(theta) * std::sin(phi),
                 half = std::sqrt(0.5);
    // The component b is along the cross product of `axis` and `in_plane`, (0, -1, 1).
    EXPECT_NEAR(
        energy_of_spin(hexagonal, fmt::format("[{:.17g}, {:.17g}, {:.17g}]", std::cos(theta),
                                              (a - b) * half, (a + b) * half)),
        3 * std::pow(std::sin(theta), 6) * std::cos(6 * phi), 1e-14);
  }
}

// Expects a spin slightly off an easy direction to return after one period.
void expect_period(std::string const& anisotropy, std::string const& start, double frequency) {
  constexpr int steps = 4000;
  auto const scene = scene_of(fmt::format(
      "system = {{ kind = 'llg', damping = 0 }}\nlattice = {{ shape = [1] }}\nfield = {{ anisotropy "
      "= {} }}\ninitial = {{ uniform = {} }}\nintegrator = {{ method = 'rkmk4', dt = {:.17g}, steps "
      "= {} }}\n",
      anisotropy, start, 2 * pi / frequency / steps, steps));
  auto const run = SceneRun::open(scene, {});
  auto const first = spins_of(*run);
  run->advance(steps / 2);
  EXPECT_GT(largest_distance(spins_of(*run), first), 1e-4);
  run->advance(steps / 2);
  EXPECT_LT(largest_distance(spins_of(*run), first), 1e-9);
}

TEST(CrystalTerms, SpinsTurnAtTheFrequencyOfTheirResonance) {
  constexpr double K = -0.3, K2 = 0.2;
  expect_period("{ cubic = -0.3, constant2 = 0.2, axes = [[1, 0, 0], [0, 1, 0]] }",
                "[1, 1.0003, 1]", -4.0 / 3 * (K + K2 / 3));
  // The spin is in an easy plane. The energy of the plane is P * m_z^2 / 2, with P = of_plane.
  constexpr double of_plane = 0.8, of_six = 0.02;
  expect_period(
      "[{ constant = -0.8, axis = [0, 0, 1] }, { hexagonal = -0.02, axis = [0, 0, 1], in_plane = "
      "[3, 4, 0] }]",
      "[0.6, 0.8, 0.0001]", std::sqrt(36 * of_six * (of_plane + 6 * of_six)));
}

// A spin along an easy direction in the plane leaves that direction if the opposite field exceeds
// 36 * |K|.
TEST(CrystalTerms, AHexagonalSpinSwitchesWhereItsStiffnessEnds) {
  for (double const share : {0.99, 1.01}) {
    auto const scene = llg_scene(
        "1", "heun", 1,
        fmt::format("lattice = {{ shape = [1] }}\ninitial = {{ uniform = [1, 1e-6, 0] }}\n[field]\n"
                    "applied = [{}, 0, 0]\nanisotropy = [{{ constant = -2, axis = [0, 0, 1] }}, {{ "
                    "hexagonal = -0.02, axis = [0, 0, 1], in_plane = [1, 0, 0] }}]\n",
                    -36 * 0.02 * share));
    auto const run = SceneRun::open(scene, {});
    run->relax({.torque = 1e-10});
    auto const end = spins_of(*run);
    if (share < 1)
      EXPECT_NEAR(end[0], 1, 1e-9);
    else
      EXPECT_LT(end[0], 0.9);
  }
}

TEST(CrystalTerms, BoundsOfStepsAreThoseOfTheirStiffness) {
  auto const bound = [](std::string const& field) {
    return make_plan(llg_scene("0", "rkmk4", 50,
                               "lattice = { shape = [8, 8, 8] }\nfield = { " + field +
                                   " }\ninitial = { uniform = [0, 0, 1] }\n"),
                     Precision::double_precision)
        .stable_dt;
  };
  double const unit = bound("anisotropy = { constant = 1, axis = [0, 0, 1] }");
  EXPECT_NEAR(bound("anisotropy = { cubic = 1, axes = [[1, 0, 0], [0, 1, 0]] }"), unit / 2, 1e-12);
  EXPECT_NEAR(bound("anisotropy = { cubic = '1', axes = [[1, 0, 0], [0, 1, 0]], constant2 = -3 }"),
              unit / 5, 1e-12);
  EXPECT_NEAR(bound("anisotropy = { hexagonal = 1, axis = [0, 0, 1], in_plane = [1, 0, 0] }"),
              unit / 36, 1e-12);
  EXPECT_NEAR(bound("dmi = { d2d = -2 }"), unit / 8, 1e-12);
  EXPECT_NEAR(bound("dmi = { d2d = -2 }, in_time = { dmi = '1 - 3*t' }"), unit / 16, 1e-12);
  EXPECT_NEAR(
      bound("anisotropy = { constant = 1, axis = [0, 0, 1] }, in_time = { anisotropy = -4 }"),
      unit / 4, 1e-12);
}

}  // namespace
}  // namespace cayspin::simulation::test
