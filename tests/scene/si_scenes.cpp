// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// units = "SI": conversion to reduced units, and refusals.
#include "io/changes.hpp"
#include "io/expression.hpp"
#include "si_constants.hpp"
#include "wrong_scenes.hpp"

#include <cmath>

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr std::string_view si_film = R"toml(units = "SI"

[material]
Ms = 8e5
A = 1.3e-11
Ku = 500
axis = [0, 2, 0]
D = 3e-3
normal = [0, 0, 1]
alpha = 0.5
damping_form = "gilbert"

[system]
kind = "llg"

[lattice]
shape = [8, 4]
spacing = [4e-9, 4e-9, 3e-9]

[field]
applied = ["0.025*sin(2*pi*1e9*t)", 0.1, 0]
slab_demag = { normal = [0, 0, 1], strength = 0.8 }

[initial]
uniform = [1, 0, 0]

[integrator]
method = "tsit5"
tolerance = 1e-5
dt = 1e-12
end = 5e-11
max_dt = 1e-13
until_torque = 1e-6
isotropy = { constant = 1e9 }
)toml";

constexpr std::string_view si_chain = R"toml(units = "SI"

[material]
mu_s = { bohr_magnetons = 2.0 }
J = { meV = 10 }
K = 1e-22
axis = [0, 0, 1]
D = { meV = 1 }
normal = [0, 0, 1]
alpha = 0.5
damping_form = "landau_lifshitz"

[system]
kind = "llg"

[lattice]
shape = [16]
spacing = 2.5e-10

[field]
applied = [0, 0, 2]
slab_demag = { normal = [0, 0, 1] }

[initial]
uniform = [1, 0, 0]

[integrator]
method = "rkmk4"
dt = 1e-16
steps = 10
)toml";

void expect_close(double value, double expected) {
  EXPECT_NEAR(value, expected, 4e-16 * std::abs(expected));
}

TEST(SiScene, PeriodsOfOutputAreInSeconds) {
  auto const scene = parse_scene(std::string(si_film), "scene.toml",
                                 {"output={every={time=1e-11},scalars_every={time=2e-12}}"});
  EXPECT_EQ(scene.output.every, 10);
  EXPECT_EQ(scene.output.scalars_every, 2);
}

TEST(SiScene, MicromagneticsComesToReducedUnits) {
  auto const scene = scene_of(si_film);
  double const pressure = mu0 * 8e5 * 8e5, second = gamma * mu0 * 8e5 / 1.25;
  EXPECT_TRUE(scene.units.si);
  expect_close(scene.units.time, 1 / second);
  expect_close(scene.units.length, 4e-9);
  expect_close(scene.units.field, mu0 * 8e5);
  expect_close(scene.units.energy, pressure * 48e-27);
  EXPECT_EQ(scene.system.damping, 0.5);
  expect_close(scene.lattice.spacing[0], 1);
  expect_close(scene.lattice.spacing[1], 1);
  expect_close(scene.lattice.spacing[2], 0.75);
  expect_close(scene.field.exchange.value().constant, 2 * 1.3e-11 / (pressure * 16e-18));
  ASSERT_EQ(scene.field.anisotropies.size(), 1U);
  expect_close(scene.field.anisotropies[0].constant, 2 * 500 / pressure);
  EXPECT_EQ(scene.field.anisotropies[0].axis, (Triple{0, 1, 0}));
  expect_close(scene.field.dmi.value().interfacial, 3e-3 / (pressure * 4e-9));
  EXPECT_EQ(scene.field.slab_demag.value().strength, 0.8);
  EXPECT_EQ(scene.field.mu0, 1);
  expect_close(std::get<double>((*scene.field.applied)[1]), 0.1 / (mu0 * 8e5));
  expect_close(scene.integrator.dt, 1e-12 * second);
  expect_close(scene.integrator.max_dt, 1e-13 * second);
  EXPECT_EQ(scene.integrator.min_dt, 0);
  EXPECT_EQ(scene.integrator.steps, 50);
  expect_close(*scene.integrator.until_torque, 1e-6 / (mu0 * 8e5));
  expect_close(scene.integrator.sigma, 1e9 / second);
  ASSERT_TRUE(scene.material);
  EXPECT_FALSE(scene.material->atomistic);
  EXPECT_EQ(scene.material->moment, 8e5);
  EXPECT_EQ(scene.material->gamma, gamma);
  EXPECT_EQ(std::get<std::string>((*scene.applied_in_tesla)[0]), "0.025*sin(2*pi*1e9*t)");
}

TEST(SiScene, LandauLifshitzDampingLeavesTheUnitOfTime) {
  auto const text = replaced(si_film, "\"gilbert\"", "\"landau_lifshitz\"");
  expect_close(scene_of(text).units.time, 1 / (gamma * mu0 * 8e5));
  auto const slower = replaced(text, "Ms = 8e5", "Ms = 8e5\ngamma = 2e11");
  expect_close(scene_of(slower).units.time, 1 / (2e11 * mu0 * 8e5));
}

TEST(SiScene, AnExpressionTakesSeconds) {
  auto const scene = scene_of(si_film);
  EXPECT_TRUE(depends_on_time(scene.field));
  Expression const reduced(std::get<std::string>((*scene.field.applied)[0]), {"t"});
  for (double const seconds : {0.0, 1e-10, 3.3e-10}) {
    double const t = seconds / scene.units.time;
    double const tesla = 0.025 * std::sin(2 * std::acos(-1.0) * 1e9 * seconds);
    EXPECT_NEAR(reduced(&t) * mu0 * 8e5, tesla, 1e-17);
  }
}

TEST(SiScene, OnlyTheVariableOfAnExpressionIsScaled) {
  constexpr std::string_view typed = "tan(1e-3*t)+0.5e9*t*0+(t>1.e-10?1:2e+0)+.5*exp(-t/1E-9)";
  auto const text = replaced(si_film, "0.025*sin(2*pi*1e9*t)", typed);
  auto const scene = scene_of(text);
  Expression const reduced(std::get<std::string>((*scene.field.applied)[0]), {"t"});
  Expression const in_seconds(std::string(typed), {"t"});
  for (double const seconds : {0.0, 0.9e-10, 1.1e-10, 2e-9}) {
    double const t = seconds / scene.units.time;
    EXPECT_NEAR(reduced(&t) * scene.units.field, in_seconds(&seconds), 1e-14);
  }
}

TEST(SiScene, AtomisticSpinsComeToReducedUnits) {
  auto const scene = scene_of(si_chain);
  constexpr double moment = 2 * 9.2740100657e-24, bond = 10e-3 * 1.602176634e-19;
  expect_close(scene.units.energy, bond);
  expect_close(scene.units.field, bond / moment);
  expect_close(scene.units.time, moment / (gamma * bond));
  expect_close(scene.units.length, 2.5e-10);
  EXPECT_EQ(scene.lattice.spacing, (Triple{1, 1, 1}));
  EXPECT_EQ(scene.field.exchange.value().constant, 1);
  expect_close(scene.field.anisotropies.at(0).constant, 2e-22 / bond);
  expect_close(scene.field.dmi.value().interfacial, 0.1);
  expect_close(scene.field.slab_demag.value().strength,
               mu0 * moment * moment / (2.5e-10 * 2.5e-10 * 2.5e-10) / bond);
  expect_close(std::get<double>((*scene.field.applied)[2]), 2 * moment / bond);
  EXPECT_EQ(scene.system.damping, 0.5);
}

TEST(SiScene, TheUnitOfEnergyIsThatOfWhatThereIs) {
  auto const without_bonds = replaced(si_chain, "J = { meV = 10 }", "J = 0");
  expect_close(scene_of(without_bonds).units.energy, 1e-22);
  auto const antiferromagnet = scene_of(replaced(si_chain, "meV = 10", "mRy = -1"));
  expect_close(antiferromagnet.units.energy, 2.1798723611030e-21);
  EXPECT_EQ(antiferromagnet.field.exchange.value().constant, -1);
  auto const free = replaced(replaced(without_bonds, "K = 1e-22\naxis = [0, 0, 1]", ""),
                             "D = { meV = 1 }\nnormal = [0, 0, 1]", "");
  auto const scene = scene_of(free);
  EXPECT_EQ(scene.units.field, 1);
  expect_close(scene.units.time, 1 / gamma);
}

TEST(SiScene, ReducedIsAWordAsWell) {
  auto const scene = scene_of("units = \"reduced\"\n" + std::string(llg_scene));
  EXPECT_EQ(scene.units, Units{});
  EXPECT_EQ(scene.integrator.dt, 0.01);
  EXPECT_FALSE(scene.material);
}

TEST(SiScene, OverridesAreInSi) {
  auto const scene = scene_of(si_film, {"material.alpha=0.0", "integrator.dt=5e-13"});
  expect_close(scene.integrator.dt, 5e-13 * gamma * mu0 * 8e5);
  auto const again = with_overrides(scene, {"integrator.dt=2.5e-13"});
  expect_close(again.integrator.dt, 2.5e-13 * gamma * mu0 * 8e5);
  EXPECT_EQ(again.integrator.steps, 200);
}

// The reduced unit of a stored value may depend on how the scene gives it: as a number, per region
// or as an expression. The comparison must not depend on that.
TEST(SiScene, LatticesAreComparedInSi) {
  auto const changed = [](std::string const& before, std::string const& now) {
    std::string const regions = "lattice.regions='i<4'";
    return changed_lattice_key(scene_of(si_film, {regions, before}),
                               scene_of(si_film, {regions, now}));
  };
  EXPECT_EQ(changed("material.Ms=8e5", "material.Ms='8e5'"), "");
  EXPECT_EQ(changed("material.Ms={regions=[8e5,8e5]}", "material.Ms='8e5'"), "");
  EXPECT_EQ(changed("material.Ms=8e5", "material.Ms='7e5'"), "lattice.moments");
  EXPECT_EQ(changed("material.Ms={regions=[8e5,4e5]}", "material.Ms={regions=[4e5,2e5]}"),
            "lattice.moments");
  EXPECT_EQ(changed("material.gamma=2e11", "material.gamma='2e11'"), "");
  EXPECT_EQ(changed("material.gamma=2e11", "material.gamma='1.9e11'"), "lattice.gyromagnetic");
}

TEST(WrongSiScene, OfUnits) {
  expect_refused(si_film, R"(
units = 'si' | : "si" is not known | "reduced", "SI"
units = 1 | : 1 is an integer | "reduced", "SI"
units = 'reduced' | material: belongs to units = "SI" | no such table
system.damping = 0.1 | : belongs to reduced units | material.alpha
field.exchange = 1 | : belongs to reduced units | material.A
field.dmi = { interfacial = 1, normal = [0, 0, 1] } | : belongs to reduced units | material.D
field.mu0 = 1 | : belongs to reduced | applied is in T
lattice.spacing = | : is missing | one number, or three
lattice.spacing = [4e-9, 4e-9] | : has 2 entries | one number, or three
integrator.end = 1.5e-12 | : 1.5e-12 is 1.5 steps of dt = 1e-12 | dt = 1.5e-12 or 7.5e-13
integrator.end =; integrator.steps = 1; integrator.dt = 1e-320 | : comes to | a time in s
)");
}

TEST(WrongSiScene, OfMaterial) {
  expect_refused(si_film, R"(
material.Ms = | : is missing | mu_s (J/T)
material.mu_s = 1e-23 | : stands beside material.Ms | exactly one
material.Ms = -8e5 | : -800000 is not positive | > 0, or values per site
material.Ms = 8e-300 | material: a unit of the reduced
material.A =; material.J = 1.3e-11 | : does not go with material.Ms | material.A
material.A = { meV = 1 } | .meV: unknown key | file
material.axis = | : is missing | three numbers
material.Ku = | material.axis: stands without material.Ku | both or neither
material.D = | material.normal: stands without material.D | both or neither
material.alpha = | : is missing | >= 0
material.alpha = -0.5 | : -0.5 is negative | >= 0, or values per site
material.damping_form = | : is missing: the two forms | "gilbert", "landau_lifshitz"
material.damping_form = 'Gilbert' | : "Gilbert" is not known | did you mean
material.gamma = 0 | : 0 is not positive | > 0, or values per site
material.alpha =; material.alfa = 0.5 | : unknown key | did you mean "alpha"?
)");
}

TEST(WrongSiScene, OfAtoms) {
  expect_refused(si_chain, R"(
material.J =; material.A = { meV = 10 } | : does not go with material.mu_s | material.J
material.J = { meW = 10 } | .meW: unknown key | did you mean "meV"?
material.J = { meV = 10, eV = 1 } | : is not one number with its unit | { eV = number }
material.mu_s = { bohr_magnetons = 0 } | .bohr_magnetons: 0 is not positive | > 0
lattice.spacing = [2e-10, 2e-10, 3e-10] | : differs from axis to axis | one lattice constant
)");
}

TEST(SiScene, IsForSpinsAlone) {
  EXPECT_EQ(
      refusal_of("units = \"SI\"\n[material]\nMs = 8e5\nalpha = 0\n" + std::string(body_scene)),
      "scene.toml:1: units: \"SI\" has no meaning for kind = \"rigid_body\"; "
      "accepted: \"reduced\"");
}

TEST(SiScene, NeedsAMaterial) {
  auto const text = "units = \"SI\"\n" + replaced(plain_scene, "damping = 0.1\n", "");
  expect_holds(refusal_of(text, {"lattice.spacing=1e-9"}),
               ":1: material: is missing; accepted: a table [material] with Ms");
}

TEST(SiScene, UndampedMotionNeedsNoFormOfDamping) {
  auto const text =
      replaced(replaced(si_film, "alpha = 0.5", "alpha = 0"), "damping_form = \"gilbert\"", "");
  expect_close(scene_of(text).units.time, 1 / (gamma * mu0 * 8e5));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
