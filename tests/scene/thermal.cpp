// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The table [thermal]: what arrives, in reduced units and in SI, and what is refused.
#include "scene_file.hpp"

namespace cayspin::inline v0_1::io::test {
namespace {

constexpr double mu0 = 1.25663706127e-6, boltzmann = 1.380649e-23;

std::string thermal_scene(std::string const& thermal) {
  return std::string(llg_scene) + "[thermal]\n" + thermal;
}

TEST(ThermalScene, TemperatureAndSeedArrive) {
  Folder const folder;
  EXPECT_FALSE(read_text(folder, llg_scene).thermal);
  auto const scene = read_text(folder, thermal_scene("temperature = 0.25\nseed = 7\n"));
  ASSERT_TRUE(scene.thermal);
  EXPECT_EQ(scene.thermal->temperature, 0.25);
  EXPECT_EQ(scene.thermal->seed, 7);
  EXPECT_EQ(read_text(folder, thermal_scene("temperature = 1")).thermal->seed, 0);
  EXPECT_EQ(read_text(folder, llg_scene, {"thermal.temperature=0.5"}).thermal->temperature, 0.5);
}

// At temperature 0 there is no noise that something could not go with.
TEST(ThermalScene, TemperatureZeroGoesWithEverything) {
  Folder const folder;
  for (std::string const other :
       {"system.damping=0.0", "integrator.compensated=true", "integrator.until_torque=1e-6"})
    EXPECT_EQ(refusal(folder.write(thermal_scene("temperature = 0")), {other}), std::nullopt);
  EXPECT_EQ(refusal(folder.write(thermal_scene("temperature = 0")),
                    {"integrator.method='tsit5'", "integrator.tolerance=1e-4"}),
            std::nullopt);
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

// kB T over the energy of a site: mu0 Ms^2 V of a cell, and of atoms J, K, D or mu_s times 1 T.
TEST(ThermalScene, KelvinAreConvertedByTheEnergyOfASite) {
  Folder const folder;
  auto const cell =
      read_text(folder, in_si("Ms = 8e5\nA = 1.3e-11"), {"lattice.spacing=[4e-9, 5e-9, 3e-9]"});
  double const energy = mu0 * 8e5 * 8e5 * 4e-9 * 5e-9 * 3e-9;
  EXPECT_NEAR(cell.thermal->temperature, boltzmann * 300 / energy, 1e-14);
  EXPECT_NEAR(cell.thermal->temperature * cell.units.energy / boltzmann, 300, 1e-10);

  for (auto const& [keys, unit] : {std::pair{"J = 5e-21\nK = 1e-22\naxis = [0, 0, 1]", 5e-21},
                                   {"K = 1e-22\naxis = [0, 0, 1]", 1e-22},
                                   {"", 2e-23}}) {
    auto const atom = read_text(folder, in_si(std::string("mu_s = 2e-23\n") + keys),
                                {"lattice.spacing=3e-10", "thermal.temperature=2"});
    EXPECT_NEAR(atom.thermal->temperature, boltzmann * 2 / unit, 1e-12) << keys;
  }
}

class WrongThermal : public testing::TestWithParam<WrongScene> {};
TEST_P(WrongThermal, IsRefusedInOneLine) {
  expect_refused(thermal_scene("temperature = 0.5\nseed = 3\n"), GetParam());
}
INSTANTIATE_TEST_SUITE_P(
    Keys, WrongThermal,
    testing::Values(
        WrongScene{"negative", "temperature = 0.5", "temperature = -0.5",
                   ":33: thermal.temperature: ", ">= 0"},
        WrongScene{"not_finite", "temperature = 0.5", "temperature = inf",
                   ":33: thermal.temperature: ", ">= 0"},
        WrongScene{"text", "temperature = 0.5", "temperature = \"300 K\"",
                   ":33: thermal.temperature: ", "is a string"},
        WrongScene{"missing", "temperature = 0.5\n", "", ":32: thermal.temperature: ", "missing"},
        WrongScene{"seed", "seed = 3", "seed = -1", ":34: thermal.seed: ", "whole number >= 0"},
        WrongScene{"broken_seed", "seed = 3", "seed = 0.5",
                   ":34: thermal.seed: ", "whole number >= 0"},
        WrongScene{"unknown", "seed = 3", "sed = 3", ":34: thermal.sed: ", "did you mean \"seed\""},
        WrongScene{"no_damping", "damping = 0.05", "damping = 0",
                   ":33: thermal.temperature: ", "needs damping"},
        WrongScene{"adaptive", "method = \"rkmk4\"", "method = \"tsit5\"\ntolerance = 1e-4",
                   ":22: integrator.method: ", "chooses its steps"},
        WrongScene{"automatic",
                   "method = \"rkmk4\"\ngenerator = \"default\"\nisotropy = "
                   "\"zero\"\nrotation = \"cayley\"",
                   "method = \"auto\"\nerror = 1e-4",
                   ":22: integrator.method: ", "chooses its steps"},
        WrongScene{"drifting",
                   "method = \"rkmk4\"\ngenerator = \"default\"\nisotropy = "
                   "\"zero\"\nrotation = \"cayley\"",
                   "method = \"classical_rk4\"", ":22: integrator.method: ", "|m| = 1"},
        WrongScene{"compensated", "dt = 0.01", "dt = 0.01\ncompensated = true",
                   ":27: integrator.compensated: ", "does not go with a temperature"},
        WrongScene{"torque", "dt = 0.01", "dt = 0.01\nuntil_torque = 1e-6",
                   ":27: integrator.until_torque: ", "do not come to rest"},
        WrongScene{"control", "dt = 0.01", "dt = 0.01\nenergy_control = true",
                   ":27: integrator.energy_control: ", "conserves its energy"},
        WrongScene{"isotropy", "isotropy = \"zero\"", "isotropy = \"energy\"",
                   ":24: integrator.isotropy: ", "conserves its energy"},
        WrongScene{"noise", "temperature = 0.5", "temperature = 4000",
                   ":26: integrator.dt: ", "a dt up to 0.005"}),
    name_of);

TEST(ThermalScene, RigidBodiesHaveNone) {
  expect_refused(std::string(body_scene) + "[thermal]\ntemperature = 0.5\n",
                 {"", "", "", ":15: thermal: ", "kind = \"rigid_body\""});
}

}  // namespace
}  // namespace cayspin::inline v0_1::io::test
