// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes in SI, compared with equal physics in reduced units and with numbers computed by hand.
#include "../support/larger.hpp"
#include "scenes_of_text.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

// Typed here, so that tests do not depend on the library's values.
constexpr double mu0 = 1.25663706127e-6, gamma = 1.760859e11, mu_B = 9.2740100657e-24,
                 meV = 1.602176634e-22, boltzmann = 1.380649e-23, pi = std::numbers::pi;

// The units of a reduced scene, in SI.
struct Reduced {
  double energy, field, time;
};

std::vector<double> field_of(SceneRun& run) { return packed<double>(run.field().vectors); }

// Compares fields in T, energies in J, and the spins after the scene's steps.
void expect_same_physics(std::string const& si_text, std::string const& reduced_text,
                         Reduced const& unit) {
  auto const si = scene_of(si_text), reduced = scene_of(reduced_text);
  for (auto const precision : precisions) {
    SCOPED_TRACE(to_string(precision));
    double const eps = epsilon(precision);
    auto const in_si = SceneRun::open(si, {.precision = precision}),
               in_reduced = SceneRun::open(reduced, {.precision = precision});
    auto const tesla = field_of(*in_si);
    auto expected = field_of(*in_reduced);
    double largest = 0;
    for (double& h : expected) largest = cayspin::test::larger(largest, std::abs(h *= unit.field));
    EXPECT_GT(largest, 0);
    EXPECT_LT(largest_distance(tesla, expected), 16 * eps * largest);
    auto const energy = in_si->sample().energy, other = in_reduced->sample().energy;
    EXPECT_NEAR(energy.value, other.value * unit.energy, 32 * eps * energy.magnitude);
    in_si->advance(si.integrator.steps);
    in_reduced->advance(reduced.integrator.steps);
    EXPECT_NEAR(in_si->time(), in_reduced->time() * unit.time, 1e-13 * in_si->time());
    EXPECT_LT(largest_distance(spins_of(*in_si), spins_of(*in_reduced)), 200 * eps);
    EXPECT_GT(largest_distance(spins_of(*in_si), spins_of(*SceneRun::open(si, {}))), 0.05);
  }
}

// Replaces `{NAME}` in a text by the number of that name, with all digits.
std::string with_numbers(std::string_view text, std::map<std::string, double> const& numbers) {
  std::string made(text);
  for (auto const& [name, number] : numbers)
    for (auto at = made.find('{' + name + '}'); at != made.npos; at = made.find('{' + name + '}'))
      made.replace(at, name.size() + 2, fmt::format("{:.17g}", number));
  return made;
}

TEST(SiScenes, AFerrimagnetHasTheFieldsOfItsReducedScene) {
  // The reduced units are 1 meV for energies and 1 Bohr magneton for moments.
  double const alpha = 0.1, field = meV / mu_B, time = (1 + alpha * alpha) / (gamma * field),
               dt = 2e-15;
  std::string const usual = R"toml(
[system]
kind = "llg"
{damping}
[lattice]
shape = [6, 5, 4]
boundary = ["open", "periodic", "open"]
crystal = "bcc"
gyromagnetic = [1, 0.9]
occupied = "(x-0.5)^2 + (y-0.5)^2 < 0.3"
frozen = "i == 1"
{lattice}
[field]
{field}
[initial]
random = { seed = 3 }
[torque]
{torque}
[integrator]
method = "heun"
dt = {dt}
steps = 20
[thermal]
seed = 8
temperature = {temperature}
)toml";
  auto const scene = [&](std::map<std::string, std::string> const& parts) {
    auto text = usual;
    for (auto const& [name, part] : parts)
      text.replace(text.find('{' + name + '}'), name.size() + 2, part);
    return text;
  };
  auto const in_si =
      "units = 'SI'\nmaterial = { mu_s = { bohr_magnetons = [2.22, 0.7] }, alpha = "
      "0.1, damping_form = 'gilbert', K = { meV = 0.3 }, axis = [1, 1, 0] }\n" +
      scene({{"damping", ""},
             {"lattice", "spacing = 2.866e-10"},
             {"field",
              "couplings = [ { between = [0, 1], J = { meV = 5 }, D = { meV = [0, "
              "0.5, 1] } }, { offset = [1, 0, 0], tensor = { meV = [[1, 2, 0], [0, "
              "1, 0], [1, 0, 3]] } }, { between = [1, 1], offset = [0, 1, 0], "
              "biquadratic = { meV = 2 } } ]\n"
              "anisotropy = [ { constant = { meV = 0.4 }, axis = [0, 0, 1], site = "
              "1 }, { cubic = { meV = 0.6 }, axes = [[1, 0, 0], [0, 1, 0]] } ]\n"
              "applied = [3, '5*cos(1e13*t)', 0]"},
             {"torque",
              "slonczewski = { damping_like = 2, field_like = 1, "
              "polarization = [0, 1, 1] }"},
             {"dt", "2e-15"},
             {"temperature", "20"}});
  auto const reduced = with_numbers(
      scene({{"damping", "damping = 0.1"},
             {"lattice", "moments = [2.22, 0.7]"},
             {"field",
              "couplings = [ { between = [0, 1], J = 5, D = [0, 0.5, 1] }, { offset = [1, 0, 0], "
              "tensor = [[1, 2, 0], [0, 1, 0], [1, 0, 3]] }, { between = [1, 1], offset = [0, 1, "
              "0], biquadratic = 2 } ]\n"
              "anisotropy = [ { constant = 0.8, axis = [0, 0, 1], site = 1 }, { cubic = 0.6, axes "
              "= [[1, 0, 0], [0, 1, 0]] }, { constant = 0.6, axis = [1, 1, 0] } ]\n"
              "applied = [{three}, '{five}*cos({turn}*t)', 0]"},
             {"torque",
              "slonczewski = { damping_like = {two}, field_like = {one}, polarization = "
              "[0, 1, 1] }"},
             {"dt", "{step}"},
             {"temperature", "{kT}"}}),
      {{"three", 3 / field},
       {"five", 5 / field},
       {"turn", 1e13 * time},
       {"two", 2 / field},
       {"one", 1 / field},
       {"step", dt / time},
       {"kT", boltzmann * 20 / meV}});
  expect_same_physics(in_si, reduced, {meV, field, time});
}

TEST(SiScenes, AFilmHasTheFieldsOfItsReducedScene) {
  double const Ms = 8e5, alpha = 0.2, a = 4e-9, field = mu0 * Ms, pressure = field * Ms,
               time = (1 + alpha * alpha) / (gamma * field), dt = 2e-13,
               u = -gamma * 1.054571817e-34 * 0.4 * 2e13 / (2 * 1.602176634e-19 * Ms);
  std::string const usual = R"toml(
[lattice]
shape = [9, 7, 2]
spacing = {spacing}
occupied = "(x-0.5)^2 + (y-0.5)^2 < 0.3"
[initial]
random = { seed = 3 }
[integrator]
method = "rkmk4"
steps = 20
dt = )toml";
  auto const shared = [&](std::string const& spacing) {
    auto text = usual;
    return text.replace(text.find("{spacing}"), 9, spacing);
  };
  auto const in_si = R"toml(units = "SI"
[material]
Ms = 8e5
A = "1.3e-11*(1 + 0.2*x)"
Ku = "5e4*y"
axis = [0, 0, 1]
D_bulk = "2e-3*(1 - 0.5*x)"
alpha = 0.2
damping_form = "gilbert"
[system]
kind = "llg"
[field]
anisotropy = { cubic = 4.8e4, axes = [[1, 0, 0], [0, 1, 0]] }
[torque]
zhang_li = { current_density = [2e13, "1e13*cos(1e11*t)", 0], polarization = 0.4, nonadiabaticity = 0.05 }
slonczewski = { current_density = 1e13, efficiency = 0.3, thickness = 6e-9, polarization = [0, 1, 0] }
)toml" + shared("[4e-9, 5e-9, 3e-9]") +
                     "2e-13\n";
  auto const reduced =
      with_numbers(R"toml(
[system]
kind = "llg"
damping = 0.2
[field]
exchange = "{A}*(1 + 0.2*x)"
dmi = { bulk = "{D}*(1 - 0.5*x)" }
anisotropy = [ { cubic = {Kc}, axes = [[1, 0, 0], [0, 1, 0]] }, { constant = "{K}*y", axis = [0, 0, 1] } ]
[torque]
zhang_li = { velocity = [{u}, "0.5*{u}*cos({turn}*t)", 0], nonadiabaticity = 0.05 }
slonczewski = { damping_like = {a}, polarization = [0, 1, 0] }
)toml" + shared("[1, 1.25, 0.75]") +
                       "{dt}\n",
                   {{"A", 2 * 1.3e-11 / (pressure * a * a)},
                    {"D", 2e-3 / (pressure * a)},
                    {"Kc", 4.8e4 / pressure},
                    {"K", 1e5 / pressure},
                    {"u", u / (a * gamma * field)},
                    {"turn", 1e11 * time},
                    {"a", 1.054571817e-34 * 0.3 * 1e13 / (2 * 1.602176634e-19 * Ms * 6e-9) / field},
                    {"dt", dt / time}});
  expect_same_physics(in_si, reduced, {pressure * 60e-27, field, time});
}

std::string iron(std::string const& couplings) {
  return "units = 'SI'\nmaterial = { mu_s = { bohr_magnetons = 2.22 }, alpha = 0 }\n"
         "system = { kind = 'llg' }\n"
         "lattice = { shape = [3, 4, 5], crystal = 'bcc', spacing = 2.866e-10, boundary = "
         "'periodic' }\nfield = { couplings = " +
         couplings +
         " }\ninitial = { uniform = [0, 0, 1] }\n"
         "integrator = { method = 'rkmk4', dt = 1e-17, steps = 1 }\n";
}

// By hand: 8 neighbours of 7.05e-21 J on 2.22 Bohr magnetons make 2739.42 T. Vampire agrees; its
// file lists each bond from both ends.
TEST(SiScenes, IronHasTheExchangeFieldOfItsEightNeighbours) {
  for (auto const& couplings : {std::string("{ shells = [7.05e-21] }"),
                                std::string("{ shells = { meV = [44.00263897494837]} }"),
                                fmt::format("{{ file = '{}/bcc_iron.ucf' }}", CAYSPIN_TEST_DATA)})
    for (auto const precision : precisions) {
      auto const run = SceneRun::open(scene_of(iron(couplings)), {.precision = precision});
      auto const field = field_of(*run);
      double const expected = 8 * 7.05e-21 / (2.22 * mu_B);
      EXPECT_NEAR(expected, 2739.42, 0.005);
      for (std::size_t site = 0; site < field.size() / 3; ++site) {
        EXPECT_EQ(field[3 * site], 0);
        EXPECT_NEAR(field[3 * site + 2], expected, 8 * epsilon(precision) * expected);
      }
      // Each of the 4 bonds per site counts once.
      double const energy = -4 * 120 * 7.05e-21;
      EXPECT_NEAR(run->sample().energy.value, energy, 8 * epsilon(precision) * -energy);
      auto const terms = run->energies();
      ASSERT_EQ(terms.size(), 1U);
      EXPECT_NEAR(terms[0].second, energy, 8 * epsilon(precision) * -energy);
    }
}

// A current moves a spiral of 24 cells. If the nonadiabaticity equals Gilbert's damping, the spiral
// keeps its shape and moves with the electrons, at 28.9755 m/s * sin(q * a) / (q * a) for 1e12
// A/m^2. Here q is the wave number of the spiral and a the spacing.
TEST(SiScenes, ASpiralOfPermalloyMovesWithTheElectrons) {
  auto const text = [](double alpha) {
    return fmt::format(R"toml(units = "SI"
material = {{ Ms = 8e5, alpha = {0}, damping_form = "gilbert" }}
system = {{ kind = "llg" }}
lattice = {{ shape = [24], spacing = 4e-9, boundary = "periodic" }}
torque = {{ zhang_li = {{ current_density = [1e12, 0, 0], polarization = 0.4, nonadiabaticity = {0} }} }}
initial = {{ expression = ["cos(2*pi*i/24)", "sin(2*pi*i/24)", "0"] }}
integrator = {{ method = "rkmk4", dt = 1e-12, steps = 200 }}
)toml",
                       alpha);
  };
  double const angle = 28.9755 * std::sin(pi / 12) / 4e-9 * 2e-10;
  for (double const alpha : {0.0, 0.5})
    for (auto const precision : precisions) {
      auto const spins = end_of(scene_of(text(alpha)), precision);
      for (std::size_t i = 0; i < 24; ++i) {
        double const phase = pi * static_cast<double>(i) / 12 + angle;
        EXPECT_NEAR(spins[3 * i], std::cos(phase), 2e-6 + 100 * epsilon(precision));
        EXPECT_NEAR(spins[3 * i + 1], std::sin(phase), 2e-6 + 100 * epsilon(precision));
        EXPECT_NEAR(spins[3 * i + 2], 0, 100 * epsilon(precision));
      }
    }
}

// An uncoupled spin moves as in a scene with the damping of its site.
TEST(SiScenes, GilbertsDampingMayDifferFromSiteToSite) {
  auto const end = [](std::string const& alpha, std::string const& form, Precision precision) {
    return end_of(scene_of("units = 'SI'\nmaterial = { Ms = 8e5, alpha = " + alpha +
                           ", damping_form = '" + form + R"toml(' }
system = { kind = "llg" }
lattice = { shape = [6], spacing = 4e-9 }
field = { applied = [0.5, 0, 1] }
torque = { slonczewski = { damping_like = 0.1, polarization = [0, 1, 0] } }
initial = { random = { seed = 2 } }
integrator = { method = "rkmk4", dt = 1e-13, steps = 100 }
)toml"),
                  precision);
  };
  for (std::string const form : {"gilbert", "landau_lifshitz"})
    for (auto const precision : precisions) {
      auto const both = end("'i < 3 ? 0.1 : 0.8'", form, precision),
                 small = end("0.1", form, precision), large = end("0.8", form, precision);
      for (std::size_t i = 0; i < both.size(); ++i)
        EXPECT_NEAR(both[i], i < 9 ? small[i] : large[i], 1e-11 + 100 * epsilon(precision)) << i;
      EXPECT_GT(largest_distance(small, large), 0.1);
    }
  auto const frozen = end_of(scene_of(R"toml(units = "SI"
material = { Ms = 8e5, alpha = "0.5", damping_form = "gilbert" }
system = { kind = "llg" }
lattice = { shape = [2], spacing = 4e-9, frozen = "i == 1" }
field = { applied = [0, 0, 1] }
initial = { uniform = [1, 0, 0] }
integrator = { method = "rkmk4", dt = 1e-13, steps = 100 }
)toml"),
                             Precision::double_precision);
  EXPECT_EQ(frozen[3], 1);
  EXPECT_LT(frozen[0], 0.9);
}

}  // namespace
}  // namespace cayspin::simulation::test
