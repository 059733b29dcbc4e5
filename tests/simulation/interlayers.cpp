// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Bonds between layers act on the spins at the interface, not at the centres of cells. Tests the
// gradient of the energy, the energy, and the field that saturates thick layers, which is that of
// the continuum.
#include "../support/larger.hpp"
#include "scenes_of_text.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

std::string const start_and_step = R"toml(
[initial]
random = { seed = 7 }
[integrator]
method = "heun"
dt = 0.01
steps = 1
)toml";

// Compares H with differences of the energy, whose error is of order angle^4: the energy has
// harmonics of all orders.
void expect_gradient(io::Scene const& scene, std::vector<std::size_t> const& sites) {
  auto const run = SceneRun::open(scene, {});
  auto const spins = spins_of(*run);
  auto const field = packed<double>(run->field().vectors);
  auto const moments = io::moments_of_sites(scene, {{0, 0, 0}, scene.lattice.shape});
  for (std::size_t const site : sites) {
    double const* const m = &spins[3 * site];
    double const* const h = &field[3 * site];
    auto const energy_at = [&](double angle) {  // with the spin turned about z
      auto turned = spins;
      double const c = std::cos(angle), s = std::sin(angle);
      turned[3 * site] = c * m[0] - s * m[1];
      turned[3 * site + 1] = s * m[0] + c * m[1];
      run->set_spins({turned.data(), true, {3, 4, 5}, {60, 15, 3, 1}});
      return run->sample().energy.value;
    };
    constexpr double angle = 5e-3;
    double const slope = (8 * (energy_at(angle) - energy_at(-angle)) -
                          (energy_at(2 * angle) - energy_at(-2 * angle))) /
                         (12 * angle);
    EXPECT_NEAR(-slope, moments[site] * (m[0] * h[1] - m[1] * h[0]), 1e-9) << site;
  }
}

TEST(Interlayers, SeeTheGradientOfTheEnergy) {
  for (std::string const exchange : {"exchange = { regions = [0.5, 0.7, 0.9] }", "",
                                     "exchange = 0.6\nexchange_between = [ { between = [1, 2], "
                                     "factor = 0.2 } ]"}) {
    auto const scene = scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [5, 4, 3]
spacing = [0.8, 1, 1.25]
boundary = ["open", "periodic", "open"]
regions = "i < 2 ? 0 : j % 2 + 1"
moments = "i == 4 && j == 1 ? 0 : 1 + 0.1*k"
[field]
{}
interlayer = [ {{ between = [0, 1], J = -0.15, biquadratic = 0.025 }}, {{ between = [2, 1], J = 0.1 }} ]
)toml",
                                            exchange) +
                                start_and_step);
    SCOPED_TRACE(exchange);
    expect_gradient(scene, {1, 2, 9, 12, 24, 47});
  }
}

// The spacer is one vacant plane across x, and one or two vacant rows across y. Both axes are
// periodic.
TEST(Interlayers, AcrossSpacersSeeTheGradientOfTheEnergy) {
  for (std::string const exchange : {"exchange = { regions = [0.5, 0.7, 0.9] }", ""}) {
    auto const scene = scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [5, 4, 3]
spacing = [0.8, 1, 1.25]
boundary = ["periodic", "periodic", "open"]
regions = "k == 1 ? 2 : i % 2"
moments = "i == 2 && j > 0 || j == 2 || k == 1 && j == 1 ? 0 : 1 + 0.1*k"
[field]
{}
interlayer = [ {{ between = [0, 1], J = -0.15, biquadratic = 0.025 }}, {{ between = [1, 1], J = 0.1, range = 1 }}, {{ between = [2, 2], J = 0.07, biquadratic = -0.02, range = 2 }}, {{ between = [0, 0], J = 0.12, range = 1 }} ]
)toml",
                                            exchange) +
                                start_and_step);
    SCOPED_TRACE(exchange);
    expect_gradient(scene, {0, 5, 6, 8, 15, 16, 23, 25, 39, 45, 46, 58});
  }
}

TEST(Interlayers, HaveTheEnergyOfTheSpinsAtTheFace) {
  auto const energy = [](std::string const& field, std::string const& start) {
    auto const scene = scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [2]
spacing = 0.5
regions = "i"
[field]
{}
interlayer = [ {{ between = [0, 1], J = 0.02, biquadratic = 0.01 }} ]
[initial]
expression = {}
[integrator]
method = "heun"
dt = 0.01
steps = 1
)toml",
                                            field, start));
    for (auto const& [name, value] : SceneRun::open(scene, {})->energies())
      if (name == "interlayer") return value;
    return 0.0;
  };
  auto const turned = R"(["i == 0 ? 1 : 0.6", "i == 0 ? 0 : 0.8", "0"])";
  EXPECT_NEAR(energy("", turned), -0.04 * 0.6 - 0.02 * 0.36, 1e-15);
  // Parallel spins are also parallel at the interface.
  EXPECT_NEAR(energy("exchange = 1", R"(["1", "0", "0"])"), -0.06, 1e-15);
  // The bond is across a site without a spin.
  for (auto const& name : {"x", "y", "z"}) {
    auto const along = [&](std::string const& shape) {
      auto const scene = scene_of(fmt::format(R"toml(
system = {{ kind = "llg", damping = 0.1 }}
[lattice]
shape = {0}
spacing = 0.5
regions = "i + j + k"
occupied = "i + j + k != 1"
[field]
interlayer = [ {{ between = [0, 2], J = 0.02, biquadratic = 0.01, range = 1 }}, {{ between = [2, 0], J = 5, range = 0 }} ]
[initial]
expression = ["i + j + k == 0 ? 1 : 0.6", "i + j + k == 0 ? 0 : 0.8", "0"]
[integrator]
method = "heun"
dt = 0.01
steps = 1
)toml",
                                              shape));
      return SceneRun::open(scene, {})->sample().energy.value;
    };
    EXPECT_NEAR(along(*name == 'x'   ? "[3]"
                      : *name == 'y' ? "[1, 3]"
                                     : "[1, 1, 3]"),
                -0.04 * 0.6 - 0.02 * 0.36, 1e-15)
        << name;
  }
  // Stiff exchange holds the spins at the interface near those of the cells. The energy is lower by
  // torque^2 / k, where k = 2 * A / d^2 is the stiffness of a half cell and d the spacing.
  double const torque = 0.04 * 0.8 + 2 * 0.02 * 0.6 * 0.8, k = 2 * 1e3 / 0.25;
  EXPECT_NEAR(energy("exchange = 1e3", turned), -0.04 * 0.6 - 0.02 * 0.36 - torque * torque / k,
              1e-10);
}

// `lattice`: the shape, the spacing and the regions.
io::Scene with_an_interlayer(std::string const& lattice, std::string const& exchange, double J) {
  return scene_of(
      fmt::format("system = {{ kind = 'llg', damping = 0.1 }}\nlattice = {{ {} }}\n"
                  "field = {{ exchange = {}, interlayer = [{{ between = [0, 1], J = {} }}] }}\n",
                  lattice, exchange, J) +
      start_and_step);
}

TEST(Interlayers, AreRefusedWhereTheExchangeBesideThemIsWeak) {
  std::string const words = "is 1 times the exchange of half a cell";
  std::string const chain = "shape = [3], regions = 'i'";
  expect_refused([&] { return with_an_interlayer(chain, "1", 2); }, words);
  expect_refused([&] { return with_an_interlayer(chain, "{ regions = [1, 0.1, 1] }", 0.2); },
                 words);
  expect_refused([&] { return with_an_interlayer(chain, "{ regions = [0.1, 1, 1] }", 0.2); },
                 words);
  // Neither the exchange of other cells nor the spacing of axes without such faces counts.
  for (auto const& scene :
       {with_an_interlayer(chain, "{ regions = [1, 1, 0.01] }", 0.2),
        with_an_interlayer("shape = [2, 2, 2], spacing = [10, 10, 1], regions = 'k'", "1", 0.2)})
    EXPECT_NO_THROW(SceneRun::open(scene, {})->advance(1));
}

TEST(Interlayers, AreRefusedBesideNegativeExchange) {
  std::string const chain = "shape = [2], regions = 'i'";
  for (std::string const exchange : {"-1", "{ regions = [-1, -2] }"})
    expect_refused([&] { return with_an_interlayer(chain, exchange, 0.1); },
                   "field.exchange: is negative beside an interlayer");
}

// Two layers of thickness d with an antiferromagnetic bond saturate at the field B for which
// 2 * A * k * tanh(k * d) = 2 * |J|, with k^2 = Ms * B / (2 * A).
TEST(Interlayers, OfThickLayersSaturateWhereTheContinuumDoes) {
  constexpr double A = 1.5e-11, Ms = 1e6, J = 1.5e-3, thickness = 2e-8;
  auto const excess = [](double B) {
    double const k = std::sqrt(Ms * B / (2 * A));
    return 2 * A * k * std::tanh(k * thickness) - 2 * J;
  };
  double below = 0.01, above = 2;
  for (int i = 0; i < 100; ++i)
    (excess((below + above) / 2) > 0 ? above : below) = (below + above) / 2;
  struct Case {
    double cell, error;
    long spacer;  // in cells
  };
  for (auto const& [cell, error, spacer] : {Case{2e-9, 0.02, 0}, {1e-9, 0.005, 0}, {2e-9, 0.02, 2}})
    for (double const side : {-1.0, 1.0}) {
      long const layer = std::lround(thickness / cell);
      auto const scene =
          scene_of(fmt::format(R"toml(
units = "SI"
system = {{ kind = "llg" }}
material = {{ Ms = {}, A = {}, alpha = 1, damping_form = "gilbert" }}
[lattice]
shape = [1, 1, {}]
spacing = {}
regions = "z < 0.5 ? 0 : 1"
occupied = "k < {} || k >= {}"
[field]
exchange_between = [ {{ between = [0, 1], factor = 0 }} ]
interlayer = [ {{ between = [0, 1], J = {}, range = {} }} ]
applied = [{}, 0, 0]
[initial]
expression = ["1", "z < 0.5 ? 0.2 : -0.2", "0"]
[integrator]
method = "heun"
dt = 1e-15
steps = 1
)toml",
                               Ms, A, 2 * layer + spacer, cell, layer, layer + spacer, -J, spacer,
                               below * (1 + side * error)));
      auto const run = SceneRun::open(scene, {});
      run->relax({.torque = 1e-9});
      auto const end = spins_of(*run);
      double largest = 0;
      for (std::size_t i = 1; i < end.size(); i += 3)
        largest = cayspin::test::larger(largest, std::abs(end[i]));
      if (side > 0)
        EXPECT_LT(largest, 1e-3) << cell << ' ' << spacer;
      else
        EXPECT_GT(largest, 2e-2) << cell << ' ' << spacer;
    }
}

// Vacant cells between layers act only as a spacer.
TEST(Interlayers, AcrossASpacerAreThoseOfLayersThatTouch) {
  auto const layers = [](int spacer, std::string const& axis, std::string const& method) {
    std::string const other = fmt::format("({0} < 4 ? {0} : {0} - {1})", axis, spacer);
    auto const shape = [&](char of) {
      return *axis.c_str() == of ? 8 + spacer : of == 'i' ? 19 : of == 'j' ? 3 : 2;
    };
    return scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [{0}, {1}, {2}]
spacing = [0.8, 1, 1.25]
regions = "{3} < 4 ? 0 : 1"
occupied = "{3} < 4 || {3} >= {4}"
[field]
exchange = 0.8
exchange_between = [ {{ between = [0, 1], factor = 0 }} ]
interlayer = [ {{ between = [0, 1], J = -0.15, biquadratic = 0.02, range = {5} }} ]
applied = [0.2, "0.1*cos(t)", 0]
[initial]
expression = ["sin(1 + 2.3*i + 1.9*{6})", "cos(i + 1.3*{6})", "sin(2*i + 0.4*{6})"]
[integrator]
method = "{7}"
dt = 0.02
steps = 10
)toml",
                                shape('i'), shape('j'), shape('k'), axis, 4 + spacer, spacer, other,
                                method));
  };
  for (std::string const axis : {"j", "k"})
    for (auto const precision : precisions)
      for (std::string const method : {"heun", "rkmk4"}) {
        auto const touching = end_of(layers(0, axis, method), precision);
        for (int const spacer : {1, 3}) {
          auto const scene = layers(spacer, axis, method);
          auto const apart = end_of(scene, precision);
          auto const& [nx, ny, nz] = scene.lattice.shape;
          double largest = 0;
          std::size_t next = 0;
          for (std::size_t site = 0; site < apart.size() / 3; ++site) {
            auto const at = static_cast<std::int64_t>(site) / nx;
            auto const place = axis == "j" ? at % ny : at / ny;
            if (place >= 4 && place < 4 + spacer) continue;
            for (std::size_t c = 0; c < 3; ++c, ++next)
              largest =
                  cayspin::test::larger(largest, std::abs(apart[3 * site + c] - touching[next]));
          }
          EXPECT_EQ(next, touching.size());
          EXPECT_LT(largest, 10 * 64 * epsilon(precision)) << axis << spacer << method;
        }
      }
}

TEST(Interlayers, AcrossASpacerGoOnAfterABreak) {
  for (std::string const method : {"rkmk4", "tsit5"})
    expect_same_bits_after_a_break(
        scene_of(fmt::format(R"toml(
system = {{ kind = "llg", damping = 0.1 }}
lattice = {{ shape = [25, 4, 3], regions = "i % 2", occupied = "i % 5 != 2" }}
initial = {{ random = {{ seed = 3 }} }}
field = {{ exchange = 1, interlayer = [ {{ between = [1, 1], J = 0.2, range = 1 }} ] }}
integrator = {{ method = "{}", {}dt = 0.02, steps = 12 }}
)toml",
                             method, method == "tsit5" ? "tolerance = 1e-5, " : "")),
        5);
}

}  // namespace
}  // namespace cayspin::simulation::test
