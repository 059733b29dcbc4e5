// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The table [thermal]: values in reduced units and in SI, and refusals.
#include "si_constants.hpp"
#include "wrong_scenes.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string thermal_scene(std::string const& thermal) {
  return std::string(llg_scene) + "[thermal]\n" + thermal;
}

TEST(ThermalScene, TemperatureAndSeedArrive) {
  EXPECT_FALSE(scene_of(llg_scene).thermal);
  auto const scene = scene_of(thermal_scene("temperature = 0.25\nseed = 7\n"));
  ASSERT_TRUE(scene.thermal);
  EXPECT_EQ(scene.thermal->temperature, 0.25);
  EXPECT_EQ(scene.thermal->seed, 7);
  EXPECT_EQ(scene_of(thermal_scene("temperature = 1")).thermal->seed, 0);
  EXPECT_EQ(scene_of(llg_scene, {"thermal.temperature=0.5"}).thermal->temperature, 0.5);
}

TEST(ThermalScene, ANumberAsTimeIsAFactor) {
  auto const with_time = [](char const* profile, char const* time) {
    return thermal_scene(fmt::format("temperature = {{ profile = {}, time = {} }}", profile, time));
  };
  EXPECT_DOUBLE_EQ(scene_of(with_time("200", "0.01")).thermal->temperature, 2);
  std::vector<std::string> const steps{"system.damping=0.1", "integrator.dt=0.1"};
  EXPECT_EQ(refusal_of(with_time("200", "0.01"), steps), "accepted");
  expect_holds(refusal_of(with_time("200", "1"), steps),
               "integrator.dt: damping times temperature times dt is 2: ");
  EXPECT_EQ(refusal_of(with_time("1", "0"), {"integrator.until_torque=1e-6"}), "accepted");
  expect_holds(refusal_of(with_time("1", "-1")),
               "thermal.temperature.time: is negative; accepted: a number >= 0");
  expect_holds(refusal_of(with_time("-1", "1")),
               "thermal.temperature.profile: is negative; accepted: a number >= 0");
}

// Temperature 0 means no noise, so keys that a temperature excludes are accepted.
TEST(ThermalScene, TemperatureZeroGoesWithEverything) {
  for (auto const& other : std::vector<std::vector<std::string>>{
           {"system.damping=0.0"},
           {"integrator.compensated=true"},
           {"integrator.until_torque=1e-6"},
           {"integrator.method='tsit5'", "integrator.tolerance=1e-4"}})
    EXPECT_EQ(refusal_of(thermal_scene("temperature = 0"), other), "accepted");
}

std::string in_si(std::string const& material) {
  return "units = \"SI\"\n[material]\n" + material + R"toml(
alpha = 0.5
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [8, 4]
[initial]
uniform = [1, 0, 0]
[integrator]
method = "heun"
dt = 1e-15
steps = 10
[thermal]
temperature = 300
)toml";
}

// The temperature is kB T divided by the energy of a site: mu0 * Ms^2 * V for a cell of volume V;
// for atoms J, K or D, or mu_s * 1 T if none of these is typed.
TEST(ThermalScene, KelvinAreConvertedByTheEnergyOfASite) {
  auto const cell =
      scene_of(in_si("Ms = 8e5\nA = 1.3e-11"), {"lattice.spacing=[4e-9, 5e-9, 3e-9]"});
  double const energy = mu0 * 8e5 * 8e5 * 4e-9 * 5e-9 * 3e-9;
  EXPECT_NEAR(cell.thermal->temperature, boltzmann * 300 / energy, 1e-14);
  EXPECT_NEAR(cell.thermal->temperature * cell.units.energy / boltzmann, 300, 1e-10);

  for (auto const& [keys, unit] : {std::pair{"J = 5e-21\nK = 1e-22\naxis = [0, 0, 1]", 5e-21},
                                   {"K = 1e-22\naxis = [0, 0, 1]", 1e-22},
                                   {"", 2e-23}}) {
    auto const atom = scene_of(in_si(std::string("mu_s = 2e-23\n") + keys),
                               {"lattice.spacing=3e-10", "thermal.temperature=2"});
    EXPECT_NEAR(atom.thermal->temperature, boltzmann * 2 / unit, 1e-12) << keys;
  }
}

TEST(ThermalScene, WrongKeys) {
  expect_refused(thermal_scene("temperature = 0.5\nseed = 3\n"), R"(
thermal.temperature = -0.5 | : | >= 0
thermal.temperature = inf | : | >= 0
thermal.temperature = '300 K' | : | Unexpected token "K"
thermal.temperature = | : | missing
thermal.seed = -1 | : | whole number >= 0
thermal.seed = 0.5 | : | whole number >= 0
thermal.seed =; thermal.sed = 3 | : | did you mean "seed"
system.damping = 0 | thermal.temperature: | needs damping
integrator.tolerance = 1e-4; integrator.method = 'tsit5' | : | chooses its steps
integrator.generator =; integrator.isotropy =; integrator.rotation =; integrator.error = 1e-4;
 integrator.method = 'auto' | : | chooses its steps
integrator.generator =; integrator.isotropy =; integrator.rotation =;
 integrator.method = 'classical_rk4' | : | |m| = 1
integrator.compensated = true | : | does not go with a temperature
integrator.until_torque = 1e-6 | : | do not come to rest
integrator.energy_control = true | : | conserves its energy
integrator.isotropy = 'energy' | : | only steps of kind = "rigid_body"
thermal.temperature = 4000 | integrator.dt: | a dt up to 0.005
)");
}

TEST(ThermalScene, RigidBodiesHaveNone) {
  expect_refused(body_scene, "thermal.temperature = 0.5 | thermal: | kind = \"rigid_body\"");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
