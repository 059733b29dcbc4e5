// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Magnetization and energy of regions, and energies of terms, compared with sums over the spins.
#include "scenes_of_text.hpp"
#include "simulation/single_terms.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

std::string const and_steps = R"toml(
[initial]
random = { seed = 5 }
[integrator]
method = "rkmk4"
dt = 0.01
steps = 4
[output]
regions = true
terms = true
)toml";

// With seven regions, more than one pass is needed; the fifth region has no spin.
std::string const film = R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [7, 5, 3]
spacing = [0.8, 1, 1.25]
boundary = ["open", "periodic", "open"]
regions = "(i + 2*j + k) % 7"
occupied = "(i + 2*j + k) % 7 != 4"
moments = "1 + 0.1*i"
[field]
exchange = 0.7
dmi = { interfacial = 0.2, normal = [0, 0, 1] }
anisotropy = { constant = { regions = [0.4, -0.3, 0.1, 0, 1, 2, 0] }, axis = [1, 2, 3] }
applied = [0.1, 0, 0.2]
sources = [ { profile = ["x", 0, "0.3*i"] } ]
)toml" + and_steps;

double sum(std::vector<double> const& numbers, std::size_t first, std::size_t count) {
  auto const begin = numbers.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0);
}

TEST(MoreOfSamples, RegionsHaveTheMeansOfTheirSpinsWeightedByMoments) {
  auto const scene = scene_of(film);
  for (auto const precision : precisions) {
    auto const run = SceneRun::open(scene, {.precision = precision});
    run->advance(2);
    auto const spins = spins_of(*run), more = run->more_of_sample();
    ASSERT_EQ(more_scalars(scene).regions, 7);
    ASSERT_EQ(more.size(), more_scalars(scene).count());
    std::array<std::array<double, 4>, 7> sums{};
    for (std::size_t site = 0; site < spins.size() / 3; ++site) {
      auto const i = site % 7, j = site / 7 % 5, k = site / 35;
      double const moment = 1 + 0.1 * static_cast<double>(i);
      auto& of_region = sums[(i + 2 * j + k) % 7];
      for (std::size_t c = 0; c < 3; ++c) of_region[c] += moment * spins[3 * site + c];
      of_region[3] += moment;
    }
    double const tolerance = 16 * epsilon(precision);
    for (std::size_t region = 0; region < 7; ++region)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(more[3 * region + c], region == 4 ? 0 : sums[region][c] / sums[region][3],
                    tolerance)
            << region;
    EXPECT_EQ(more[21 + 4], 0);
  }
}

TEST(MoreOfSamples, EnergiesOfRegionsAndOfTermsAddUpToTheWhole) {
  auto const scene = scene_of(film);
  for (auto const precision : precisions) {
    auto const run = SceneRun::open(scene, {.precision = precision});
    run->advance(2);
    auto const more = run->more_of_sample();
    auto const names = more_scalars(scene).terms;
    EXPECT_EQ(names,
              (std::vector<std::string>{"exchange", "dmi", "anisotropy", "applied", "sources"}));
    auto const energy = run->sample().energy;
    double const tolerance = 16 * epsilon(precision) * energy.magnitude;
    EXPECT_NEAR(sum(more, 21, 7), energy.value, tolerance);
    EXPECT_NEAR(sum(more, 28, 5), energy.value, tolerance);
    auto const of_terms = run->energies();
    ASSERT_EQ(of_terms.size(), names.size());
    for (std::size_t term = 0; term < names.size(); ++term) {
      EXPECT_EQ(of_terms[term].first, names[term]);
      EXPECT_EQ(of_terms[term].second, more[28 + term]);
    }
  }
}

// A site has half of the energy of each of its bonds, and all of its energies of anisotropy and of
// the applied field.
TEST(MoreOfSamples, ASitesEnergyIsItsOwn) {
  auto const scene = scene_of(R"toml(
system = { kind = "llg", damping = 0.1 }
[lattice]
shape = [3]
spacing = 0.5
regions = "i"
[field]
exchange = 0.3
anisotropy = { constant = 0.8, axis = [0, 0, 1] }
applied = [0.2, 0, 0.4]
)toml" + and_steps);
  auto const run = SceneRun::open(scene, {});
  auto const m = spins_of(*run), more = run->more_of_sample();
  auto const bond = [&](std::size_t a) {
    double const dot =
        m[3 * a] * m[3 * a + 3] + m[3 * a + 1] * m[3 * a + 4] + m[3 * a + 2] * m[3 * a + 5];
    return 0.3 / 0.25 * (1 - dot);
  };
  double const bonds[] = {bond(0) / 2, (bond(0) + bond(1)) / 2, bond(1) / 2};
  double axes = 0, applied = 0;
  for (std::size_t site = 0; site < 3; ++site) {
    double const mx = m[3 * site], mz = m[3 * site + 2];
    double const axis = -0.4 * mz * mz, field = -0.2 * mx - 0.4 * mz;
    EXPECT_NEAR(more[9 + site], bonds[site] + axis + field, 1e-15) << site;
    axes += axis;
    applied += field;
  }
  EXPECT_NEAR(more[12], bond(0) + bond(1), 1e-15);
  EXPECT_NEAR(more[13], axes, 1e-15);
  EXPECT_NEAR(more[14], applied, 1e-15);
}

// At each end, a free boundary adds D^2/(2A) (m.x)^2 to the energy of bulk DMI.
TEST(MoreOfSamples, TheEnergyOfDmiIncludesItsFreeBoundaries) {
  auto const scene = scene_of(R"toml(
system = { kind = "llg", damping = 0.1 }
[lattice]
shape = [3]
spacing = 0.5
regions = "i"
[field]
exchange = 0.5
dmi = { bulk = 0.4, free_boundary = true }
)toml" + and_steps);
  ASSERT_EQ(more_scalars(scene).terms, (std::vector<std::string>{"exchange", "dmi"}));
  auto const run = SceneRun::open(scene, {});
  auto const m = spins_of(*run), more = run->more_of_sample();
  auto const twist = [&](std::size_t a) {  // the x component of the product of neighbours
    return m[3 * a + 1] * m[3 * a + 5] - m[3 * a + 2] * m[3 * a + 4];
  };
  double const ends = 0.16 * (m[0] * m[0] + m[6] * m[6]);
  EXPECT_NEAR(more[13], ends - 0.8 * (twist(0) + twist(1)), 1e-15);
  EXPECT_NEAR(sum(more, 12, 2), run->sample().energy.value, 1e-15);
}

TEST(MoreOfSamples, AreInSI) {
  std::string const reduced = R"toml(
[lattice]
shape = [2]
spacing = 5e-9
regions = "i"
[initial]
uniform = [0, 0.6, 0.8]
[integrator]
method = "rkmk4"
dt = 1e-13
steps = 1
[output]
regions = true
terms = true
)toml";
  auto const run = SceneRun::open(scene_of(R"toml(units = "SI"
system = { kind = "llg" }
material = { Ms = { regions = [8e5, 2e5] }, Ku = 4e4, axis = [0, 0, 1], alpha = 0 }
field = { applied = [0, 0.1, 0] }
)toml" + reduced),
                                  {});
  auto const more = run->more_of_sample();
  double const volume = 125e-27, axis = -4e4 * 0.64 * volume;
  double const applied[] = {-8e5 * 0.06 * volume, -2e5 * 0.06 * volume};
  for (std::size_t region = 0; region < 2; ++region)
    EXPECT_NEAR(more[6 + region], axis + applied[region], 1e-12 * std::abs(axis));
  EXPECT_NEAR(more[8], 2 * axis, 1e-12 * std::abs(axis));
  EXPECT_NEAR(more[9], applied[0] + applied[1], 1e-12 * std::abs(axis));
}

TEST(MoreOfSamples, RigidBodiesHaveOneTerm) {
  auto const run = SceneRun::open(scene_of(R"toml(
system = { kind = "rigid_body", inertia = [1, 2, 3] }
lattice = { shape = [4] }
initial = { random = { seed = 5 } }
integrator = { method = "rkmk4", dt = 0.01, steps = 1 }
output = { terms = true }
)toml"),
                                  {});
  EXPECT_EQ(run->more_of_sample(), std::vector<double>{run->sample().energy.value});
  EXPECT_EQ(more_scalars(run->scene()).terms, std::vector<std::string>{"rotation"});
}

TEST(MoreOfSamples, RegionsAreThoseOfTheLattice) {
  expect_refused(
      [] {
        return scene_of("system = { kind = 'llg', damping = 0.1 }\nlattice = { shape = [9] }\n" +
                        and_steps);
      },
      "output.regions: stands without lattice.regions");
}

}  // namespace
}  // namespace cayspin::simulation::test
