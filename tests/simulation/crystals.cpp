// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes of crystals, sublattices and currents, compared with closed forms.
#include "../support/antiferromagnet.hpp"
#include "io/method.hpp"
#include "scenes_of_text.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation::test {
namespace {

/// A cone of spins that turns rigidly; `phase` is the phase of the spin at i, j, k, s.
struct Cone {
  char const* name;
  std::string scene, phase;
  double frequency;  // of the cone, divided by cos(0.7)
};

// Each scene is a lattice and its couplings.
Cone const cones[] = {
    {"bcc",
     "[lattice]\nshape = [16, 6, 5]\ncrystal = 'bcc'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [1.25] }\n",
     "2*pi/16*3*(i+s/2) + 2*pi/6*(j+s/2) + 2*pi/5*2*(k+s/2)",
     10 - 10 * std::cos(3 * pi / 16) * std::cos(pi / 6) * std::cos(2 * pi / 5)},
    {"second shell of bcc",
     "[lattice]\nshape = [12, 6, 5]\ncrystal = 'bcc'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [1, -0.25] }\n",
     "2*pi/12*2*(i+s/2)", 8 - 8 * std::cos(pi / 6) + 0.5 * (std::cos(pi / 3) - 1)},
    {"kagome",
     "[lattice]\nshape = [9, 8]\ncrystal = 'kagome'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [0.75] }\n",
     "2*pi/3*s", 4.5},
    {"pyrochlore",
     "[lattice]\nshape = [3, 4, 3]\ncrystal = 'pyrochlore'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [0.5] }\n",
     "pi*(s>1&&s<4 || s>5&&s<8 || s>9&&s<12 || s>13)", 4},
    {"fcc",
     "[lattice]\nshape = [8, 5, 4]\ncrystal = 'fcc'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [0.5] }\n",
     "2*pi/8*3*(i + (s>1)/2)", 6 - 2 * (2 * std::cos(3 * pi / 8) + 1)},
    {"hcp",
     "[lattice]\nshape = [6, 6, 4]\ncrystal = 'hcp'\nboundary = 'periodic'\n"
     "[field]\ncouplings = { shells = [0.5] }\n",
     "pi*s", 6},
    {"chain with DMI",
     "[lattice]\nshape = [24]\nboundary = 'periodic'\n"
     "[field]\ncouplings = [ { offset = [1, 0, 0], J = 1.0, D = [0, 0, 0.3] } ]\n",
     "2*pi/24*5*i", 2 - 2 * std::cos(5 * pi / 12) - 0.6 * std::sin(5 * pi / 12)}};

TEST(CrystalScenes, ConesTurnAtTheFrequencyOfTheirMagnon) {
  for (auto const& [name, lattice, phase, frequency] : cones)
    for (auto const precision : precisions) {
      SCOPED_TRACE(fmt::format("{}, {} precision", name, to_string(precision)));
      double const rate = frequency * std::cos(0.7), end = 2;
      auto const scene = [&](std::string const& at) {
        return llg_scene(
            "0", "rkmk8", 100,
            fmt::format("{}[initial]\nexpression = [\"sin(0.7)*cos({})\", \"sin(0.7)*sin({})\", "
                        "\"cos(0.7)\"]\n",
                        lattice, at, at));
      };
      auto const expected =
          SceneRun::open(scene(fmt::format("{} + {:.17g}", phase, rate * end)), {});
      auto const found = end_of(scene(phase), precision);
      double const allowed =
          precision == Precision::double_precision ? 1e-10 : 100 * 100 * epsilon(precision);
      EXPECT_LT(largest_distance(found, spins_of(*expected)), allowed);
    }
}

// A wave in Neel's state of a simple cubic lattice: the spins of one sublattice open more than
// those of the other, and all turn rigidly about z, right-handed about the spins that open more. At
// small openings the frequency is sqrt((h + K)^2 - (h * gamma)^2), with the exchange field h, the
// anisotropy K and the structure factor gamma of the wave.
TEST(CrystalScenes, ConesOfAnAntiferromagnetTurnAtTheFrequencyOfTheirMagnon) {
  constexpr double h = 6 * 0.6, K = 0.3, opening = 0.7, end = 2;
  double const gamma = (std::cos(2 * pi / 8) + std::cos(2 * pi / 6) + std::cos(2 * pi / 4)) / 3;
  auto const cone = cayspin::test::AntiferromagneticCone::of(h, K, gamma, opening);
  std::string const up = "cos(pi*(i + j + k))";
  for (bool const up_opens_more : {true, false})
    for (auto const precision : precisions) {
      SCOPED_TRACE(fmt::format("{}, {} precision", up_opens_more, to_string(precision)));
      auto const scene = [&](double turned) {
        auto const phase =
            fmt::format("(2*pi*(i/8 + j/6 + k/4) + ({} > 0 ? 0 : pi) + {:.17g})", up, turned);
        auto const sine = fmt::format("({} {} 0 ? {:.17g} : {:.17g})", up,
                                      up_opens_more ? '>' : '<', std::sin(opening), cone.smaller);
        return llg_scene("0", "rkmk8", 100,
                         fmt::format(R"toml(
[lattice]
shape = [8, 6, 4]
boundary = "periodic"
[field]
couplings = {{ shells = [-0.6] }}
anisotropy = {{ constant = {0}, axis = [0, 0, 1] }}
[initial]
expression = ["{2}*cos{1}", "{2}*sin{1}", "{3}*sqrt(1 - {2}^2)"]
)toml",
                                     K, phase, sine, up));
      };
      double const rate = up_opens_more ? cone.frequency : -cone.frequency;
      auto const expected = SceneRun::open(scene(rate * end), {});
      double const allowed =
          precision == Precision::double_precision ? 1e-11 : 100 * 100 * epsilon(precision);
      EXPECT_LT(largest_distance(end_of(scene(0), precision), spins_of(*expected)), allowed);
    }
}

TEST(CrystalScenes, FrozenSpinsStay) {
  auto const scene = llg_scene("0.3", "heun", 50, R"toml(
[lattice]
shape = [12, 3, 2]
crystal = "bcc"
frozen = "i < 2 && s == 1"
moments = [1, 2]
[field]
couplings = { shells = [1] }
applied = [0, 0, 2]
[thermal]
temperature = 0.2
seed = 3
[initial]
random = { seed = 1 }
)toml");
  for (auto const precision : precisions) {
    auto const run = SceneRun::open(scene, {.precision = precision});
    auto const before = spins_of(*run);
    run->advance(50);
    auto const after = spins_of(*run);
    for (std::size_t site = 0; site < before.size() / 3; ++site) {
      bool const frozen = site % 12 < 2 && site / 36 % 2 == 1;
      EXPECT_EQ(frozen, before[3 * site] == after[3 * site]) << site;
    }
  }
}

// With the moments mu and the gyromagnetic ratios g, H = -(1 / mu) dE/dm. So without damping, E and
// the sum of (mu / g) * m are conserved.
TEST(CrystalScenes, MomentsConserveEnergyAndAngularMomentum) {
  auto const run = SceneRun::open(llg_scene("0", "rkmk8", 100, R"toml(
[lattice]
shape = [6, 5, 4]
crystal = "honeycomb"
boundary = "periodic"
moments = [1.5, 0.6]
gyromagnetic = [0.9, 1.2]
[field]
couplings = { shells = [-0.8, 0.2] }
[initial]
random = { seed = 2 }
)toml"),
                                  {});
  auto const sums = [&] {
    auto const m = spins_of(*run);
    std::array<double, 3> sum{};
    for (std::size_t site = 0; site < m.size() / 3; ++site)
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += (site / 30 % 2 == 0 ? 1.5 / 0.9 : 0.6 / 1.2) * m[3 * site + c];
    return sum;
  };
  auto const energy = run->sample().energy.value;
  auto const before = sums();
  run->advance(100);
  EXPECT_NEAR(run->sample().energy.value, energy, 1e-9);
  auto const after = sums();
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-9);
}

// Two sublattices of different moments at one temperature: the mean of each follows the Langevin
// function of its own mu * h / T.
TEST(CrystalScenes, EachMomentHasTheTemperature) {
  auto const scene = llg_scene("1", "heun", 1000, R"toml(
[lattice]
shape = [32, 32, 8]
basis = [[0, 0, 0], [0.5, 0.5, 0.5]]
moments = [0.5, 2]
gyromagnetic = [1.3, 0.8]
[field]
applied = [0, 0, 1]
[thermal]
temperature = 1
seed = 7
[initial]
uniform = [0, 0, 1]
)toml");
  auto const run = SceneRun::open(scene, {});
  run->advance(500);
  double sums[2] = {};
  for (int look = 0; look < 10; ++look) {
    run->advance(50);
    auto const m = spins_of(*run);
    for (std::size_t site = 0; site < m.size() / 3; ++site)
      sums[site / 1024 % 2] += m[3 * site + 2];
  }
  for (int site : {0, 1}) {
    double const x = site == 0 ? 0.5 : 2, expected = 1 / std::tanh(x) - 1 / x;
    // A mean over 8192 spins and ten nearly independent samples.
    EXPECT_NEAR(sums[site] / (10 * 8192), expected, 0.01) << site;
  }
}

// m.p = tanh(I + atanh(m0.p)), where m0 is the first spin and I is the integral of damping_like
// over time.
TEST(CrystalScenes, ASpinUnderSlonczewski) {
  auto const scene = llg_scene("0", "rkmk8", 100, R"toml(
[lattice]
shape = [1]
[torque]
slonczewski = { damping_like = "0.4*t", polarization = [0, 0, 1] }
[initial]
uniform = [0.6, 0, -0.8]
)toml");
  for (auto const precision : precisions)
    EXPECT_NEAR(end_of(scene, precision)[2], std::tanh(0.4 * 2 + std::atanh(-0.8)),
                500 * epsilon(precision));
}

// A wall of width 1 in a current. A free wall moves at (1 + damping * xi) * u while its plane
// turns. Below Walker's current a hard axis holds the plane, and the wall moves at
// (1 + damping^2) * (xi / damping) * u. Both velocities are exact up to second-order effects of the
// lattice.
TEST(CrystalScenes, AWallUnderACurrent) {
  constexpr double damping = 0.4, xi = 0.25, u = 0.1;
  for (bool const has_hard_axis : {false, true}) {
    double const expected =
        has_hard_axis ? (1 + damping * damping) * (xi / damping) * u : (1 + damping * xi) * u;
    double errors[2];
    for (int fine : {0, 1}) {
      int const sites = 80 << fine;
      auto const run = SceneRun::open(
          llg_scene(fmt::to_string(damping), "rkmk4", 2000,
                    fmt::format(R"toml(
[lattice]
shape = [{}]
spacing = {}
[field]
exchange = 1
anisotropy = [ {{ constant = 1, axis = [0, 0, 1] }}, {{ constant = {}, axis = [1, 0, 0] }} ]
[torque]
zhang_li = {{ velocity = [{}, 0, 0], nonadiabaticity = {} }}
[initial]
expression = ["0", "1/cosh(40*(x - 0.4))", "-tanh(40*(x - 0.4))"]
)toml",
                                sites, 40.0 / sites, has_hard_axis ? -1.0 : 0.0, u, xi)),
          {});
      auto const place = [&] { return 20 * run->sample().magnetization.z; };
      run->advance(1000);
      auto const before = place();
      run->advance(1000);
      errors[fine] = (place() - before) / 20 - expected;
    }
    SCOPED_TRACE(fmt::format("hard axis {}: {:.3g}, {:.3g}", has_hard_axis, errors[0], errors[1]));
    EXPECT_GT(errors[0] / errors[1], 3.6);
    EXPECT_LT(errors[0] / errors[1], 4.4);
    EXPECT_LT(std::abs((4 * errors[1] - errors[0]) / 3), 1e-3 * expected);
  }
}

TEST(CrystalScenes, GoOnWithTheSameBits) {
  auto const scene = llg_scene("0.05", "heun", 40, R"toml(
[lattice]
shape = [6, 5, 4]
crystal = "kagome"
moments = [1, 2, 1.5]
occupied = "i != 2 || s != 1"
[field]
couplings = [ { between = [0, 1], J = 1, D = [0, 0.1, 0.2] }, { between = [1, 2], offset = [0, 0, 1], tensor = [[1, 0, 0], [0, 2, 0], [0.5, 0, 1]], biquadratic = 0.2 } ]
anisotropy = [ { constant = 0.3, axis = [0, 1, 1], site = 2 }, { cubic = 0.1, axes = [[1, 0, 0], [0, 1, 0]], site = 0 } ]
applied = [0, "sin(t)", 0.1]
[torque]
slonczewski = { damping_like = 0.1, polarization = [1, 0, 0] }
[thermal]
temperature = 0.05
seed = 3
[initial]
random = { seed = 1 }
)toml");
  for (auto const precision : precisions) expect_same_bits_after_a_break(scene, 17, precision);
}

// A bcc antiferromagnet in a field below its spin-flop field relaxes to Neel's state.
TEST(CrystalScenes, Relax) {
  auto const scene = llg_scene("0.5", "heun", 1, R"toml(
[lattice]
shape = [6, 5, 4]
crystal = "bcc"
boundary = "periodic"
[field]
couplings = { shells = [-1] }
anisotropy = { constant = 0.5, axis = [0, 0, 1] }
applied = [0, 0, 1]
[initial]
random = { seed = 4 }
)toml");
  auto const run = SceneRun::open(scene, {});
  auto const found = run->relax();
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_NEAR(found.energy.value, 120 * -8.0 - 240 * 0.25, 1e-6);
}

// Relaxation works with different moments and with fields that are not linear: a ferrimagnet along
// its field, and a crystal with cubic anisotropy.
TEST(CrystalScenes, RelaxMomentsAndCubicAxes) {
  auto const relaxed = [](std::string const& lattice, std::string const& field) {
    auto const run =
        SceneRun::open(llg_scene("0.5", "heun", 1,
                                 fmt::format("[lattice]\nshape = [6, 5, 4]\n{}\n[field]\n{}\n"
                                             "[initial]\nrandom = {{ seed = 4 }}\n",
                                             lattice, field)),
                       {});
    auto const found = run->relax({.torque = 1e-7});
    EXPECT_EQ(found.end, MinimizeEnd::converged);
    return found.energy.value;
  };
  EXPECT_NEAR(relaxed("crystal = 'bcc'\nboundary = 'periodic'\nmoments = [3, 0.4]\n"
                      "gyromagnetic = [1, 2]",
                      "couplings = { shells = [-1] }\napplied = [0, 0, 0.1]\n"
                      "anisotropy = { constant = 0.1, axis = [0, 0, 1] }"),
              120 * (-8.0 - 0.1 - 0.1 * (3 - 0.4)), 1e-6);
  EXPECT_NEAR(relaxed("boundary = 'periodic'",
                      "exchange = 1\nanisotropy = { cubic = -0.3, axes = [[1, 0, 0], [0, 1, 0]] }"),
              120 * -0.1, 1e-6);
}

}  // namespace
}  // namespace cayspin::simulation::test
