// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A Bloch wall, relaxed on finer and finer chains: energy and profile, compared with the continuum.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double exchange = 1.5, anisotropy = 0.8;
double const width = std::sqrt(exchange / anisotropy);
double const continuum_energy = 2 * std::sqrt(exchange * anisotropy);

struct Wall {
  double energy, profile_error;
};

Wall relaxed_wall(int sites) {
  double const dx = 20 * width / sites;
  auto const position = [&](auto i) { return (i + 0.5) * dx - 10 * width; };
  Slab const slab{.lattice = Lattice::chain(sites, dx),
                  .exchange = exchange,
                  .anisotropy = anisotropy,
                  .demag = 1,
                  .damping = 1};
  auto spins = make_spins(slab.lattice, [&](auto i, auto, auto) {
    double const u = 1.4 * position(i) / width;
    return Vector{0, 1 / std::cosh(u), std::tanh(u)};
  });
  double const dt = 1.8 / (4 * exchange / (dx * dx) + 3);
  Rkmk4<Spins> stepper(spins);
  advance(stepper, slab.natural(), spins, dt, std::llround(std::ceil(40 / dt)));

  Wall wall{dx * (energy(Space{}, slab.field(), spins).value + 0.5 * anisotropy * sites), 0};
  auto const numbers = copy_to_host(spins);
  for (int i = 0; i < sites; ++i)
    wall.profile_error =
        larger(wall.profile_error, std::abs(numbers[3 * i + 2] - std::tanh(position(i) / width)));
  return wall;
}

TEST(BlochWall, EnergyAndProfile) {
  struct Row {
    int sites;
    char const *energy, *relative, *profile;
  };
  Row const rows[] = {{40, "2.1670938085", "-1.0862e-2", "2.07e-2"},
                      {80, "2.1851284934", "-2.6299e-3", "5.00e-3"},
                      {160, "2.1894603953", "-6.5263e-4", "1.22e-3"},
                      {320, "2.1905334067", "-1.6287e-4", "3.05e-4"}};
  std::vector<double> steps, energies, profiles;
  for (Row const& row : rows) {
    Wall const wall = relaxed_wall(row.sites);
    auto const name = [&](char const* what) {
      return std::to_string(row.sites) + " sites, " + what;
    };
    std::printf("    %-58s %.10f  (%s)\n", name("energy").c_str(), wall.energy, row.energy);
    EXPECT_NEAR(wall.energy, Printed(row.energy).value, 1e-9);
    double const relative = wall.energy / continuum_energy - 1;
    expect_figure(name("relative to the continuum"), relative, row.relative, 0);
    expect_figure(name("largest |m_z - profile|"), wall.profile_error, row.profile, 0);
    steps.push_back(1.0 / row.sites);
    energies.push_back(-relative);
    profiles.push_back(wall.profile_error);
  }
  expect_order("order of the energy", fitted_order(steps, energies), 2, 0.05);
  expect_order("order of the profile", fitted_order(steps, profiles), 2, 0.05);
}

}  // namespace
