// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Site-dependent gyromagnetic ratios, compared with closed forms. Seeds are fixed; statistical
// limits are five standard errors.
#include "scenes_of_text.hpp"

#include <cayspin/units.hpp>

#include <array>
#include <cmath>
#include <string>

namespace cayspin::simulation::test {
namespace {

constexpr double ratios[] = {1, 0.5, 2.5};

// A spin with the gyromagnetic ratio g turns about z by g * H * t. The tangent of half its angle to
// z falls as exp(-damping * g * H * t).
TEST(GyromagneticOfSites, TurnsSpinsByTheirOwn) {
  constexpr double H = 0.7, damping = 0.2, t = 60 * 0.02;
  auto const scene = llg_scene("0.2", "rkmk4", 60,
                               "lattice = { shape = [9, 2], regions = 'i % 3', gyromagnetic = { "
                               "regions = [1, 0.5, 2.5] } }\nfield = { applied = [0, 0, 0.7] }\n"
                               "initial = { uniform = [0.6, 0, 0.8] }");
  for (auto const precision : precisions) {
    auto const end = end_of(scene, precision);
    for (std::size_t site = 0; site < 18; ++site) {
      double const turn = ratios[site % 9 % 3] * H * t;
      double const z = std::tanh(std::atanh(0.8) + damping * turn), across = std::sqrt(1 - z * z);
      double const tolerance = 1e-7 + 256 * epsilon(precision);
      EXPECT_NEAR(end[3 * site], across * std::cos(turn), tolerance) << site;
      EXPECT_NEAR(end[3 * site + 1], across * std::sin(turn), tolerance) << site;
      EXPECT_NEAR(end[3 * site + 2], z, tolerance) << site;
    }
  }
}

TEST(GyromagneticOfSites, IsGammaInSi) {
  constexpr double gammas[] = {1.7e11, 2.1e11}, t = 5e-12, B = 0.3;
  auto const end = end_of(scene_of(R"toml(
units = "SI"
system = { kind = "llg" }
material = { Ms = 8e5, alpha = 0, gamma = { regions = [1.7e11, 2.1e11] } }
lattice = { shape = [4], spacing = 2e-9, regions = "i % 2" }
field = { applied = [0, 0, 0.3] }
initial = { uniform = [1, 0, 0] }
integrator = { method = "euler", rotation = "exponential", dt = 1e-13, steps = 50 }
)toml"));
  for (std::size_t site = 0; site < 4; ++site) {
    EXPECT_NEAR(end[3 * site], std::cos(gammas[site % 2] * B * t), 1e-13);
    EXPECT_NEAR(end[3 * site + 1], std::sin(gammas[site % 2] * B * t), 1e-13);
  }
}

// A list for the sites of a cell acts like an expression of s, also with torques.
TEST(GyromagneticOfSites, IsThatOfTheSitesOfACell) {
  auto const crystal = [](std::string const& gyromagnetic, std::string const& method) {
    return scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [5, 4, 3]
crystal = "hcp"
moments = [1, 0.7]
gyromagnetic = {}
frozen = "i == 3"
[field]
couplings = {{ shells = [0.3] }}
applied = [0.1, 0.2, 0.3]
[torque.slonczewski]
damping_like = 0.2
field_like = 0.1
polarization = [1, 0, 1]
[initial]
random = {{ seed = 5 }}
[integrator]
method = "{}"
dt = 0.02
steps = 20
)toml",
                                gyromagnetic, method));
  };
  for (std::string const method : {"heun", "rkmk4", "projected_rk4"})
    for (auto const precision : precisions)
      EXPECT_LT(largest_distance(end_of(crystal("[0.6, 1.7]", method), precision),
                                 end_of(crystal("'s == 0 ? 0.6 : 1.7'", method), precision)),
                20 * 64 * epsilon(precision))
          << method;
}

// In SI, too, the ratio multiplies fields but not the torques of currents, in whichever form it is
// typed.
TEST(GyromagneticOfSites, LeavesTorquesInSi) {
  auto const torques = [](std::string const& gyromagnetic, std::string const& more) {
    return scene_of(fmt::format(R"toml(
units = "SI"
system = {{ kind = "llg" }}
material = {{ Ms = 8e5, A = 1e-11, alpha = 0.1, damping_form = "gilbert" }}
lattice = {{ shape = [6, 3], spacing = 2e-9, gyromagnetic = {} }}
field = {{ applied = [0, 0.1, 0.3] }}
torque = {{ slonczewski = {{ damping_like = 0.1, polarization = [1, 0, 1] }}{} }}
initial = {{ random = {{ seed = 5 }} }}
integrator = {{ method = "rkmk4", dt = 1e-14, steps = 40 }}
)toml",
                                gyromagnetic, more));
  };
  for (std::string const more :
       {"", ", zhang_li = { velocity = [100, 0, 0], nonadiabaticity = 0.05 }"})
    EXPECT_LT(largest_distance(end_of(torques("[2.0]", more)), end_of(torques("'2 + 0*i'", more))),
              40 * 64 * epsilon(Precision::double_precision))
        << more;
}

// Neither the field nor the torque at which a run ends at rest depends on the ratio.
TEST(GyromagneticOfSites, IsNoPartOfTheField) {
  for (std::string const ratio : {"1", "0.01", "'0.01'", "'0.01 + 0*i'"}) {
    double const g = ratio == "1" ? 1 : 0.01;
    auto const scene =
        scene_of(llg_scene("0.5", "rkmk4", 1,
                           "lattice = { shape = [2], gyromagnetic = " + ratio +
                               " }\nfield = { exchange = 0.5, applied = [0, 0, 1] }\n"
                               "initial = { uniform = [1, 0, 0.1] }")
                     .text,
                 {fmt::format("integrator={{method='rkmk4',dt={},steps=100000,until_torque=1e-3}}",
                              0.05 / g)});
    auto const run = SceneRun::open(scene, {});
    auto const field = packed<double>(run->field().vectors);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(field[i], i % 3 == 2 ? 1 : 0, 1e-14) << ratio;
    EXPECT_EQ(run->advance(100000, {.period = 1, .until_torque = true}), Advanced::at_rest);
    auto const m = packed<double>(run->spins().vectors);
    EXPECT_NEAR(std::hypot(m[0], m[1]), 0.98e-3, 0.03e-3) << ratio;
  }
}

struct MeanOfRegion {
  double sum = 0, of_squares = 0, count = 0;

  void add(double value) { sum += value, of_squares += value * value, ++count; }
  double value() const { return sum / count; }
  double error() const { return std::sqrt((of_squares / count - value() * value()) / count); }
};

// The mean of free spins decays as exp(-2 * damping * g * T * t), with the gyromagnetic ratio g and
// the temperature T.
TEST(GyromagneticOfSites, TakesPartInTheNoise) {
  auto const end = end_of(llg_scene(
      "0.5", "heun", 100,
      "lattice = { shape = [192, 64], regions = 'i % 3', gyromagnetic = { regions = [1, 0.5, 2.5] "
      "} }\ninitial = { uniform = [0, 0, 1] }\nthermal = { temperature = 0.2, seed = 4 }"));
  std::array<MeanOfRegion, 3> means;
  for (std::size_t site = 0; site < end.size() / 3; ++site)
    means[site % 192 % 3].add(end[3 * site + 2]);
  for (std::size_t kind = 0; kind < 3; ++kind)
    EXPECT_NEAR(means[kind].value(), std::exp(-2 * 0.5 * ratios[kind] * 0.2 * 2),
                5 * means[kind].error());
}

// In Gilbert's form, too, the mean at equilibrium depends on neither the damping nor the
// gyromagnetic ratio.
TEST(GyromagneticOfSites, KeepsLangevinsMean) {
  auto const end = end_of(scene_of(R"toml(
units = "SI"
system = { kind = "llg" }
material = { mu_s = 1.5e-23, alpha = { regions = [0.3, 1, 1] }, damping_form = "gilbert" }
lattice = { shape = [192, 64], spacing = 1e-9, regions = "i % 3", gyromagnetic = { regions = [1, 0.5, 2.5] } }
field = { applied = [0, 0, 1] }
initial = { uniform = [0, 0, 1] }
integrator = { method = "heun", dt = 1e-13, steps = 700 }
thermal = { temperature = 0.6, seed = 9 }
)toml"));
  double const x = 1.5e-23 / (units::boltzmann * 0.6);
  std::array<MeanOfRegion, 3> means;
  for (std::size_t site = 0; site < end.size() / 3; ++site)
    means[site % 192 % 3].add(end[3 * site + 2]);
  for (auto const& mean : means)
    EXPECT_NEAR(mean.value(), 1 / std::tanh(x) - 1 / x, 5 * mean.error());
}

TEST(GyromagneticOfSites, BoundsTheStep) {
  auto const stable_dt = [](std::string const& more) {
    return make_plan(llg_scene("0.1", "heun", 1,
                               "lattice = { shape = [5], " + more +
                                   " }\nfield = { exchange = 1, applied = [0, 0, 1] }\ninitial = { "
                                   "uniform = [1, 0, 0] }"),
                     Precision::double_precision)
        .stable_dt;
  };
  double const one = stable_dt("gyromagnetic = 1");
  EXPECT_NEAR(stable_dt("gyromagnetic = '1 + 0.5*i'") * 3, one, 1e-12 * one);
}

// In SI, Slonczewski strengths are fields, which turn spins by the gamma of their site.
TEST(GyromagneticOfSites, BoundsTheStepOfSlonczewskiTorques) {
  auto const stable_dt = [](std::string const& gamma) {
    return make_plan(scene_of(R"toml(
units = "SI"
system = { kind = "llg" }
material = { mu_s = 1.5e-23, alpha = 0.1, damping_form = "gilbert", gamma = { regions = )toml" +
                              gamma + R"toml( } }
lattice = { shape = [4], spacing = 3e-10, regions = "i % 2" }
initial = { uniform = [1, 0, 0] }
integrator = { method = "heun", dt = 1e-13, steps = 1 }
torque = { slonczewski = { polarization = [0, 0, 1], damping_like = 1 } }
)toml"),
                     Precision::double_precision)
        .stable_dt;
  };
  double const slow = stable_dt("[1.76e11, 1.76e11]");
  EXPECT_NEAR(stable_dt("[1.76e11, 1.76e13]") * 100, slow, 1e-12 * slow);
}

TEST(GyromagneticOfSites, IsRefusedInOneLine) {
  auto const with = [](std::string const& value, std::string const& integrator) {
    return [=] {
      return scene_of(
          fmt::format("system = {{ kind = 'llg', damping = 0 }}\nlattice = {{ shape = "
                      "[3], gyromagnetic = {} }}\nfield = {{ exchange = 1 }}\ninitial "
                      "= {{ uniform = [1, 0, 0] }}\nintegrator = {{ dt = 0.1, steps = "
                      "1, {} }}",
                      value, integrator));
    };
  };
  expect_refused(with("'i'", "method = 'heun'"),
                 "lattice.gyromagnetic: is 0 at site (0, 0, 0); accepted: numbers > 0");
  expect_refused(with("'1+i'", "method = 'series4'"), "one gyromagnetic ratio for all spins");
  expect_refused(with("'1+i'", "method = 'euler', isotropy = 'analytic'"),
                 "gyromagnetic ratios that differ");
  expect_refused(with("'1+i'", "method = 'heun', energy_control = true"), "other than 1");
  expect_refused(with("'1+i'", "method = 'red_black2'"), "neighbours only");
}

}  // namespace
}  // namespace cayspin::simulation::test
