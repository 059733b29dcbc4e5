// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Site-dependent moments, sources and temperatures, compared with closed forms. Seeds are fixed,
// and statistical limits are three standard errors. Both precisions have the same noise, so about
// one seed in 46 would put at least one of the 8 values beyond its limit.
#include "scenes_of_text.hpp"

#if defined(CAYSPIN_HAS_FFTW)
#include <cayspin/demagnetization/demagnetizing_field.hpp>
#endif
#include <cayspin/units.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

// Each moment keeps its m_z and turns by gamma * H * t in its own field along z,
// H = B + (2 * Ku / Ms - mu0 * Ms) * m_z.
TEST(MomentsOfSites, PrecessInTheFieldOfTheirOwnMagnetization) {
  auto const scene = scene_of(R"toml(
units = "SI"
system = { kind = "llg" }
[material]
Ms = { regions = [8e5, 2e5, 1.4e6] }
Ku = { regions = [5e4, 3e4, 0] }
axis = [0, 0, 1]
alpha = 0
[lattice]
shape = [9, 2, 2]
spacing = 5e-9
regions = "i % 3"
[field]
applied = [0, 0, 0.2]
slab_demag = { normal = [0, 0, 1] }
[initial]
uniform = [0.6, 0, 0.8]
[integrator]
method = "euler"
rotation = "exponential"
dt = 1e-13
steps = 400
)toml");
  constexpr double Ms[] = {8e5, 2e5, 1.4e6}, Ku[] = {5e4, 3e4, 0}, t = 4e-11;
  for (auto const precision : precisions) {
    auto const end = end_of(scene, precision);
    for (std::size_t site = 0; site < end.size() / 3; ++site) {
      auto const region = site % 9 % 3;
      double const B =
          0.2 + 0.8 * (2 * Ku[region] / Ms[region] - units::vacuum_permeability * Ms[region]);
      double const angle = units::electron_gamma * B * t;
      double const tolerance = 4 * 400 * epsilon(precision);
      EXPECT_NEAR(end[3 * site], 0.6 * std::cos(angle), tolerance) << site;
      EXPECT_NEAR(end[3 * site + 1], 0.6 * std::sin(angle), tolerance) << site;
      EXPECT_NEAR(end[3 * site + 2], 0.8, tolerance) << site;
    }
  }
}

std::string const all_terms = R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [5, 4, 3]
spacing = [0.8, 1, 1.25]
boundary = ["open", "periodic", "open"]
regions = "i < 2 ? 0 : j % 2 + 1"
moments = { regions = [1, 0.25, 2] }
[field]
exchange = { regions = [0.5, 0.2, 0.7] }
dmi = { interfacial = 0.2, normal = [0, 0, 1] }
anisotropy = [ { constant = { regions = [0.4, -0.3, 0.1] }, axis = [1, 2, 3] }, { constant = -0.1, axis = [0, 0, 1] } ]
applied = [0.1, 0, 0.2]
sources = [ { profile = ["x", "y*z", "0.3*i"] }, { profile = { regions = [[0, 0, 1], [1, 0, 0], [0, 1, 0]] }, time = "0.4" } ]
)toml";
std::string const rest = R"toml(
[initial]
random = { seed = 7 }
[integrator]
method = "heun"
dt = 0.01
steps = 1
)toml";

/// Returns -dE/d(angle) as the spin at `site` turns about e, for an energy without harmonics above
/// the second.
double torque_about(SceneRun& run, std::vector<double> const& spins, std::size_t site,
                    std::array<double, 3> const& e) {
  auto const energy_at = [&](double angle) {
    auto turned = spins;
    double const* m = &spins[3 * site];
    double const c = std::cos(angle), s = std::sin(angle);
    double const along = e[0] * m[0] + e[1] * m[1] + e[2] * m[2];
    std::array const cross{e[1] * m[2] - e[2] * m[1], e[2] * m[0] - e[0] * m[2],
                           e[0] * m[1] - e[1] * m[0]};
    for (std::size_t i = 0; i < 3; ++i)
      turned[3 * site + i] = c * m[i] + s * cross[i] + (1 - c) * along * e[i];
    run.set_spins({turned.data(), true, {3, 4, 5}, {60, 15, 3, 1}});
    return run.sample().energy.value;
  };
  constexpr double right = std::numbers::pi / 2;
  double const first = (energy_at(right) - energy_at(-right)) / 2;
  double const second =
      (energy_at(right / 2) - energy_at(-right / 2)) / 2 - std::numbers::sqrt2 / 2 * first;
  return -(first + 2 * second);
}

void expect_gradient(std::string const& text) {
  auto const scene = scene_of(text);
  auto const run = SceneRun::open(scene, {});
  auto const spins = spins_of(*run);
  auto const field = packed<double>(run->field().vectors);
  io::SiteBox const box{{0, 0, 0}, scene.lattice.shape};
  auto const moments = io::moments_of_sites(scene, box);
  ASSERT_EQ(moments.size(), 60U);
  for (std::size_t const site : {0U, 7U, 23U, 38U, 59U})
    for (std::array<double, 3> const& e :
         {std::array{1.0, 0.0, 0.0}, {0.0, 0.6, 0.8}, {0.0, 0.0, 1.0}}) {
      double const* const m = &spins[3 * site];
      double const* const h = &field[3 * site];
      double const torque = e[0] * (m[1] * h[2] - m[2] * h[1]) +
                            e[1] * (m[2] * h[0] - m[0] * h[2]) + e[2] * (m[0] * h[1] - m[1] * h[0]);
      EXPECT_NEAR(torque_about(*run, spins, site, e), moments[site] * torque, 1e-12) << site;
    }
}

TEST(MomentsOfSites, SeeTheGradientOfTheEnergy) { expect_gradient(all_terms + rest); }

#if defined(CAYSPIN_HAS_FFTW)
TEST(MomentsOfSites, SeeTheGradientOfTheEnergyWithTheDemagnetizingField) {
  std::string const demag = "demag = { periodic_images = [0, 2, 0], multirate = false }\n";
  expect_gradient(all_terms + demag + rest);
}

// The field is the library's convolution of moment times spin.
TEST(MomentsOfSites, MakeTheDemagnetizingField) {
  auto const lattice_text = std::string(R"toml(
[system]
kind = "llg"
damping = 0
[lattice]
shape = [6, 5, 4]
spacing = [1, 0.7, 1.3]
moments = "i == 2 ? 0 : 0.5 + 0.3*j"
[field]
demag = { strength = 1.5, multirate = false }
)toml");
  auto const scene = scene_of(lattice_text + rest);
  Lattice lattice;
  lattice.shape = {6, 5, 4};
  lattice.spacing = {1, 0.7, 1.3};
  auto const moments = io::moments_of_sites(scene, {{0, 0, 0}, lattice.shape});
  auto const run = SceneRun::open(scene, {});
  auto sources = spins_of(*run);
  for (std::size_t i = 0; i < sources.size(); ++i) sources[i] *= moments[i / 3];
  using Spins = SpinField<double, Kokkos::HostSpace>;
  Spins spins("spins", lattice), field("field", lattice);
  copy_from_host(sources, spins);
  DemagnetizingField<double> const demag(lattice, {.strength = 1.5});
  demag(spins, field, 0);
  auto const expected = copy_to_host(field);
  auto const found = packed<double>(run->field().vectors);
  for (std::size_t i = 0; i < found.size(); ++i)
    if (moments[i / 3] != 0) {
      EXPECT_NEAR(found[i], expected[i], 1e-14) << i;
    }
}
#endif

// Regions with equal values act like the scene without regions.
TEST(MomentsOfSites, ThatAreAlikeAreOneMoment) {
  auto const film = [](std::string const& Ms, std::string const& Ku, std::string const& field) {
    return scene_of(fmt::format(R"toml(
units = "SI"
system = {{ kind = "llg" }}
[material]
Ms = {}
A = 1.3e-11
Ku = {}
axis = [0, 0, 1]
alpha = 0.1
damping_form = "gilbert"
[lattice]
shape = [11, 6, 2]
spacing = 4e-9
regions = "i > j"
[field]
{}
[initial]
random = {{ seed = 3 }}
[integrator]
method = "rkmk4"
dt = 1e-14
steps = 30
)toml",
                                Ms, Ku, field));
  };
  for (auto const precision : precisions) {
    auto const plain = film("8e5", "1e5", "applied = [0.1, 0, '0.1*cos(1e9*t)']");
    auto const regions = film("{ regions = [8e5, 8e5] }", "{ regions = [1e5, 1e5] }",
                              "sources = [ { profile = [0.1, 0, 0] }, { profile = [0, 0, 1], time "
                              "= '0.1*cos(1e9*t)' } ]");
    EXPECT_LT(largest_distance(end_of(plain, precision), end_of(regions, precision)),
              30 * 64 * epsilon(precision));
    EXPECT_NEAR(SceneRun::open(plain, {})->sample().energy.value,
                SceneRun::open(regions, {})->sample().energy.value, 1e-11);
  }
}

struct Mean {
  double sum = 0, of_squares = 0, count = 0;

  void add(double value) { sum += value, of_squares += value * value, ++count; }
  double value() const { return sum / count; }
  double error() const { return std::sqrt((of_squares / count - value() * value()) / count); }
};

// Compares the means of m_z and of m_z^2 with Langevin's, for independent moments of three kinds,
// each with its own damping and temperature. One sample is a site's mean over six points in time;
// sites are independent.
TEST(MomentsOfSites, HaveLangevinsMeansAtTheirTemperature) {
  auto const scene = scene_of(R"toml(
[system]
kind = "llg"
damping = { regions = [0.5, 1, 0.3] }
[lattice]
shape = [96, 128]
regions = "i % 3"
moments = { regions = [1, 2, 0.5] }
[field]
applied = [0, 0, 1]
[initial]
uniform = [0, 0, 1]
[thermal]
temperature = { regions = [0.4, 0.6, 0.7] }
seed = 9
[integrator]
method = "heun"
dt = 0.02
steps = 1000
)toml");
  constexpr double x[] = {1 / 0.4, 2 / 0.6, 0.5 / 0.7};
  constexpr int times = 6;
  for (auto const precision : precisions) {
    auto const run = SceneRun::open(scene, {.precision = precision});
    run->advance(400);
    std::vector<std::array<double, 2>> of_sites(96 * 128);
    for (int time = 0; time < times; ++time) {
      run->advance(100);
      auto const spins = spins_of(*run);
      for (std::size_t site = 0; site < of_sites.size(); ++site) {
        double const z = spins[3 * site + 2];
        of_sites[site][0] += z / times;
        of_sites[site][1] += z * z / times;
      }
    }
    std::array<std::array<Mean, 2>, 3> means;
    for (std::size_t site = 0; site < of_sites.size(); ++site)
      for (std::size_t power = 0; power < 2; ++power)
        means[site % 96 % 3][power].add(of_sites[site][power]);
    for (std::size_t region = 0; region < 3; ++region) {
      double const langevin = 1 / std::tanh(x[region]) - 1 / x[region];
      double const expected[] = {langevin, 1 - 2 * langevin / x[region]};
      for (std::size_t power = 0; power < 2; ++power) {
        auto const& mean = means[region][power];
        EXPECT_LT(mean.error(), 0.004);
        EXPECT_NEAR(mean.value(), expected[power], 3 * mean.error())
            << region << ", power " << power + 1 << ": "
            << (mean.value() - expected[power]) / mean.error();
      }
    }
  }
}

// The mean of free spins decays as exp(-2 * damping * I), where I is the integral of the
// temperature over time.
TEST(MomentsOfSites, DiffuseByATemperatureInTimeAndOfSites) {
  auto const scene = scene_of(R"toml(
[system]
kind = "llg"
damping = 0.5
[lattice]
shape = [128, 64]
[initial]
uniform = [0, 0, 1]
[thermal]
temperature = { profile = "i % 2 + 1", time = "0.3*t" }
seed = 4
[integrator]
method = "heun"
dt = 0.01
steps = 100
)toml");
  auto const end = end_of(scene);
  std::array<Mean, 2> means;
  for (std::size_t site = 0; site < end.size() / 3; ++site) means[site % 2].add(end[3 * site + 2]);
  for (std::size_t kind = 0; kind < 2; ++kind) {
    double const integral = 0.15 * static_cast<double>(kind + 1);
    EXPECT_NEAR(means[kind].value(), std::exp(-2 * 0.5 * integral), 3 * means[kind].error());
  }
}

TEST(MomentsOfSites, ATemperatureInTimeThatIsOneNumberIsThatNumber) {
  auto const chain = [](std::string const& temperature, std::string const& more) {
    return llg_scene("0.1", "heun", 30,
                     fmt::format("lattice = {{ shape = [40, 3] }}\nfield = {{ exchange = 0.3 }}\n"
                                 "initial = {{ random = {{ seed = 1 }} }}\n"
                                 "thermal = {{ temperature = {}, seed = 2 }}\n{}",
                                 temperature, more));
  };
  EXPECT_EQ(end_of(chain("0.5", "")), end_of(chain("'0.5'", "")));
  expect_refused([&] { return chain("'0.5-t'", ""); }, "thermal.temperature: is negative");
}

// A spin turns by the integral of a time-dependent field along z. Sources with the same time
// dependence add up, and mu0 multiplies all.
TEST(Sources, TurnSpinsByTheirIntegral) {
  auto const scene = scene_of(R"toml(
[system]
kind = "llg"
damping = 0
[lattice]
shape = [16, 3]
[field]
mu0 = 0.5
applied = [0, 0, 0.2]
sources = [ { profile = [0, 0, "i"], time = "cos(2*t)" }, { profile = [0, 0, "2*j"], time = "exp(-t)" }, { profile = [0, 0, "i+2"], time = "cos(2*t)" } ]
[initial]
uniform = [1, 0, 0]
[integrator]
method = "rkmk8"
dt = 0.01
steps = 100
)toml");
  auto const end = end_of(scene);
  for (std::size_t site = 0; site < end.size() / 3; ++site) {
    double const angle = 0.1 + static_cast<double>(site % 16 + 1) * std::sin(2.0) / 2 +
                         static_cast<double>(site / 16) * (1 - std::exp(-1.0));
    EXPECT_NEAR(end[3 * site], std::cos(angle), 1e-13) << site;
    EXPECT_NEAR(end[3 * site + 1], std::sin(angle), 1e-13) << site;
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
