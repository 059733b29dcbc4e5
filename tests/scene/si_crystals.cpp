// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// units = "SI": crystals, sublattices, currents and site-dependent constants.
#include "hdf5_file.hpp"
#include "io/expression.hpp"
#include "si_constants.hpp"
#include "wrong_scenes.hpp"

#include <cmath>
#include <numeric>

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr std::string_view iron = R"toml(units = "SI"
[material]
mu_s = { bohr_magnetons = 2.22 }
alpha = 0
[system]
kind = "llg"
[lattice]
shape = [4, 3, 2]
crystal = "bcc"
spacing = 2.866e-10
[field]
couplings = { shells = [7.05e-21] }
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 1e-16
steps = 10
)toml";

constexpr std::string_view permalloy = R"toml(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0.5
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [4, 3, 2]
spacing = [4e-9, 4e-9, 3e-9]
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 1e-14
steps = 10
)toml";

Scene iron_with(std::vector<std::string> const& overrides) { return scene_of(iron, overrides); }
Scene permalloy_with(std::vector<std::string> const& overrides) {
  return scene_of(permalloy, overrides);
}

void expect_near(double value, double expected) {
  EXPECT_NEAR(value, expected, 8e-16 * std::abs(expected));
}
void expect_near(std::vector<double> const& values, std::vector<double> const& expected) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) expect_near(values[i], expected[i]);
}

TEST(SiCrystals, IronHasItsUnits) {
  auto const scene = iron_with({"thermal={temperature=300}", "material.alpha=0.1",
                                "material.damping_form='landau_lifshitz'"});
  // By hand:
  //   unit of the field = 7.05e-21 J / (2.22 mu_B), temperature = k_B * 300 K / 7.05e-21 J.
  EXPECT_NEAR(scene.units.field, 342.427, 1e-3);
  EXPECT_NEAR(scene.units.time, 1.65846e-14, 1e-19);
  EXPECT_NEAR(scene.thermal->temperature, 0.587510, 1e-6);
  expect_near(scene.units.energy, 7.05e-21);
  expect_near(scene.units.length, 2.866e-10);
  EXPECT_TRUE(scene.lattice.moments.empty());
  EXPECT_EQ(scene.lattice.spacing, (Triple{1, 1, 1}));
}

TEST(SiCrystals, VampiresFileIsInJoules) {
  auto const scene = iron_with({"field.couplings={file='" CAYSPIN_TEST_DATA "/bcc_iron.ucf'}"});
  expect_near(scene.units.energy, 2.22 * mu_B);  // energy of a moment in 1 T
  auto const bonds = couplings(scene);
  ASSERT_EQ(bonds.size(), 8U);
  for (auto const& bond : bonds) expect_near(bond.tensor[4], 7.05e-21 / (2.22 * mu_B));
  auto const scaled =
      iron_with({"field.couplings={file='" CAYSPIN_TEST_DATA "/bcc_iron.ucf',scale=-2}",
                 "material.K=1e-24", "material.axis=[0,0,1]"});
  for (auto const& bond : couplings(scaled)) expect_near(bond.tensor[8], -2 * 7050);
}

TEST(SiCrystals, MomentsAreRelativeToTheFirst) {
  for (std::string const typed :
       {"[{bohr_magnetons=2}, {bohr_magnetons=0.5}]", "{bohr_magnetons=[2,0.5]}",
        "[18.5480201314e-24,4.63700503285e-24]"}) {
    auto const scene = iron_with({"material.mu_s=" + typed});
    expect_near(scene.lattice.moments, {1, 0.25});
    expect_near(scene.material->moments, {2 * mu_B, 0.5 * mu_B});
    expect_near(scene.units.field, 7.05e-21 / (2 * mu_B));
  }
  EXPECT_TRUE(iron_with({"material.mu_s=[1e-23,1e-23]"}).lattice.moments.empty());
  expect_near(iron_with({"lattice.gyromagnetic=[1,1.1]"}).lattice.gyromagnetic, {1, 1.1});
}

TEST(SiCrystals, CouplingsAreEnergiesOfABond) {
  auto const scene =
      iron_with({"field.couplings=[{between=[0,1],J={meV=10},D=[0,1e-22,0]},"
                 "{offset=[1,0,0],tensor={meV=[[1,2,3],[4,5,6],[7,8,-20]]}},"
                 "{between=[1,1],offset=[1,0,0],biquadratic={eV=0.001}},"
                 "{between=[1,1],offset=[0,1,0],D={mRy=[0,0,1]},biquadratic=-1e-22}]"});
  double const unit = 20 * meV;
  expect_near(scene.units.energy, unit);
  auto const bonds = couplings(scene);
  ASSERT_EQ(bonds.size(), 4U);
  expect_near(bonds[0].tensor[0], 0.5);
  expect_near(bonds[0].tensor[2], -1e-22 / unit);
  expect_near(bonds[0].tensor[6], 1e-22 / unit);
  for (std::size_t i = 0; i < 8; ++i)
    expect_near(bonds[1].tensor[i], static_cast<double>(i + 1) / 20);
  expect_near(bonds[1].tensor[8], -1);
  expect_near(bonds[2].biquadratic, 0.05);
  expect_near(bonds[3].tensor[1], 2.1798723611030e-21 / unit);
  expect_near(bonds[3].biquadratic, -1e-22 / unit);
  auto const shells = iron_with({"field.couplings={shells={meV=[10,-4]}}"});
  expect_near(shells.units.energy, 10 * meV);
  double least = 0;
  for (auto const& bond : couplings(shells)) least = std::min(least, bond.tensor[0]);
  expect_near(least, -0.4);
}

TEST(SiCrystals, AnisotropiesAreEnergies) {
  auto const scene =
      iron_with({"field.anisotropy=[{constant=1e-23,axis=[0,0,1],site=1},{cubic={meV=0.1},axes=[[1,"
                 "0,0],[0,1,0]],site=0},{constant={meV=1},axis=[1,0,0]}]",
                 "material.K=2e-23", "material.axis=[0,3,0]"});
  auto const& [uniaxial, cubic] =
      std::tie(scene.field.anisotropies, scene.field.crystal_anisotropies);
  ASSERT_EQ(uniaxial.size(), 3U);
  expect_near(uniaxial[0].constant, 4e-23 / 7.05e-21);
  EXPECT_EQ(uniaxial[0].axis, (Triple{0, 1, 0}));
  EXPECT_EQ(uniaxial[0].site, -1);
  expect_near(uniaxial[1].constant, 2e-23 / 7.05e-21);
  EXPECT_EQ(uniaxial[1].site, 1);
  expect_near(uniaxial[2].constant, 2 * meV / 7.05e-21);
  ASSERT_EQ(cubic.size(), 1U);
  expect_near(cubic[0].constant, 0.1 * meV / 7.05e-21);
  EXPECT_EQ(cubic[0].site, 0);
  auto const film =
      permalloy_with({"field.anisotropy=[{cubic=4.8e4,axes=[[1,0,0],[0,1,0]]},"
                      "{constant=500,axis=[0,1,0]}]"});
  double const pressure = mu0 * 8e5 * 8e5;
  expect_near(film.field.crystal_anisotropies.at(0).constant, 4.8e4 / pressure);
  auto const hexagonal = permalloy_with(
      {"field.anisotropy=[{hexagonal=1e3,axis=[0,0,1],in_plane=[1,0,0]},{cubic=1e3,constant2='2e3*("
       "1+i)',axes=[[1,0,0],[0,1,0]]}]"});
  auto const& terms = hexagonal.field.crystal_anisotropies;
  expect_near(terms.at(0).constant, 1e3 / pressure);
  expect_near(
      numbers_of_sites(hexagonal, terms.at(1).factors2, "field.anisotropy", whole(hexagonal))[1],
      4e3 / pressure);
  expect_near(film.field.anisotropies.at(0).constant, 1000 / pressure);
}

// The typed strength is multiplied by mu0 * mu^2 / (a^3 * J), where mu is the moment of the first
// site, a the lattice constant and J the exchange.
TEST(SiCrystals, DipolesAreOfTheMoments) {
  auto const scene =
      iron_with({"field.dipoles={strength=0.5}", "material.mu_s={bohr_magnetons=[2.22,1.11]}"});
  double const moment = 2.22 * mu_B;
  expect_near(scene.field.demag.value().strength,
              0.5 * mu0 * moment * moment / std::pow(2.866e-10, 3) / 7.05e-21);
  expect_near(scene.lattice.moments, {1, 0.5});
}

TEST(SiCrystals, ASlabHasTheMagnetizationOfTheCrystal) {
  auto const strength = [](std::string const& lattice) {
    return iron_with({lattice, "field.slab_demag={normal=[0,0,1],strength=0.5}"})
        .field.slab_demag->strength;
  };
  double const moment = 2.22 * mu_B,
               cube = 0.5 * mu0 * moment * moment / std::pow(2.866e-10, 3) / 7.05e-21;
  expect_near(strength("lattice.crystal='bcc'"), 2 * cube);
  expect_near(strength("lattice.crystal='fcc'"), 4 * cube);
  EXPECT_NEAR(strength("lattice.crystal='honeycomb'"), 2 * cube / std::sqrt(0.75), 1e-15);
  auto const slab = "field.slab_demag={normal=[0,0,1]}";
  EXPECT_NO_THROW(
      iron_with({"lattice.regions='s'", "material.mu_s={regions=[1e-23,1e-23]}", slab}));
}

TEST(SiScenes, BulkDmiIsThatOfAnInterfaceWithoutItsNormal) {
  auto const film = permalloy_with({"material.D_bulk=3e-3"});
  ASSERT_TRUE(film.field.bulk_dmi);
  EXPECT_FALSE(film.field.dmi);
  expect_near(film.field.bulk_dmi->constant, 3e-3 / (mu0 * 8e5 * 8e5 * 4e-9));
  auto const d2d = permalloy_with({"material.D2d=3e-3"});
  ASSERT_TRUE(d2d.field.d2d_dmi);
  for (double const each : numbers_of_sites(d2d, d2d.field.dmi_factors, "field.dmi", whole(d2d)))
    expect_near(each, 3e-3 / (mu0 * 8e5 * 8e5 * 4e-9));
  auto const atoms = iron_with({"material.D_bulk={meV=1}", "lattice.crystal='bcc'",
                                "lattice={shape=[4],spacing=3e-10}", "field={}"});
  EXPECT_EQ(atoms.field.bulk_dmi->constant, 1);
  expect_near(atoms.units.energy, meV);
}

TEST(SiScenes, ConstantsOfSitesAreInSi) {
  Folder const folder;
  std::vector<double> stored(24);
  std::iota(stored.begin(), stored.end(), 500);
  write_dataset(folder / "film.h5", "/values", {2, 3, 4}, stored);
  auto const text = replaced(permalloy, "A = 1.3e-11\nalpha = 0.5",
                             "A = '1.3e-11*(1+i)'\nKu = { file = 'film.h5' }\naxis = [0, 0, 1]\n"
                             "D = '1e-3*j'\nnormal = [0, 0, 1]\nalpha = '0.1*(1+k)'");
  auto const scene = read_text(folder, text);
  check_files(scene);
  auto const& field = scene.field;
  double const pressure = mu0 * 8e5 * 8e5;
  auto const values = [&](SiteNumbers const& numbers, std::string_view key) {
    return numbers_of_sites(scene, numbers, key, whole(scene));
  };
  auto const A = values(field.exchange_factors, "field.exchange"),
             K = values(field.anisotropies.at(0).factors, "field.anisotropy"),
             D = values(field.dmi_factors, "field.dmi"),
             alpha = values(scene.system.dampings, "system.damping");
  for (std::size_t site = 0; site < 24; ++site) {
    auto const i = static_cast<double>(site % 4), j = static_cast<double>(site / 4 % 3),
               k = static_cast<double>(site / 12);
    expect_near(A[site], 2 * 1.3e-11 * (1 + i) / (pressure * 16e-18));
    expect_near(K[site], 2 * (500 + static_cast<double>(site)) / pressure);
    expect_near(D[site], 1e-3 * j / (pressure * 4e-9));
    expect_near(alpha[site], 0.1 * (1 + k));
  }
  EXPECT_EQ(field.exchange->constant, 1);
  EXPECT_EQ(field.dmi->interfacial, 1);
  EXPECT_EQ(field.anisotropies[0].constant, 1);
  EXPECT_EQ(scene.system.damping, 0);
  EXPECT_TRUE(scene.system.gilbert_of_sites);
  // The unit has no factor 1 + alpha^2, because that differs from site to site.
  expect_near(scene.units.time, 1 / (gamma * mu0 * 8e5));
  auto const landau_lifshitz =
      read_text(folder, replaced(text, "\"gilbert\"", "'landau_lifshitz'"));
  EXPECT_FALSE(landau_lifshitz.system.gilbert_of_sites);
}

TEST(SiTorques, VelocitiesAreInMetresPerSecond) {
  auto const scene =
      permalloy_with({"torque={zhang_li={velocity=[100,'50*sin(1e9*t)',0],nonadiabaticity=0.04}}"});
  auto const& of = scene.field.torque.zhang_li.value();
  // The unit of velocity is one cell per 1 / (gamma * mu0 * Ms), for either form of the damping.
  double const unit = 4e-9 * gamma * mu0 * 8e5;
  expect_near(std::get<double>(of.velocity[0]), 100 / unit);
  double const t = 1e-9 / scene.units.time;
  expect_near(Expression(std::get<std::string>(of.velocity[1]), {"t"})(&t),
              50 * std::sin(1.0) / unit);
  EXPECT_EQ(of.nonadiabaticity, 0.04);
  EXPECT_EQ(std::get<double>(scene.torque_in_si.zhang_li->velocity[0]), 100);
  auto const current =
      permalloy_with({"torque={zhang_li={current_density=[1e12,'-1e12*t',0],polarization=0.4}}"});
  double const seconds = 2;
  // By hand: u = -g * mu_B * P * j / (2 * e * Ms), where P is the polarization.
  EXPECT_NEAR(Expression(std::get<std::string>(current.torque_in_si.zhang_li->velocity[1]),
                         {"t"})(&seconds),
              57.9510, 2e-4);
}

TEST(SiTorques, StrengthsAreFields) {
  auto const scene = permalloy_with(
      {"torque={slonczewski={damping_like='0.1*t',field_like=0.02,polarization=[0,2,0]}}"});
  auto const& of = scene.field.torque.slonczewski.value();
  expect_near(std::get<double>(of.field_like), 0.02 / (mu0 * 8e5));
  double const t = 3 / scene.units.time;
  expect_near(Expression(std::get<std::string>(of.damping_like), {"t"})(&t), 0.3 / (mu0 * 8e5));
  EXPECT_EQ(of.polarization, (Triple{0, 1, 0}));
  auto const current = permalloy_with(
      {"torque={slonczewski={current_density=1e12,efficiency=0.4,thickness=3e-9,field_like=0.01,"
       "polarization=[0,1,0]}}"});
  expect_near(std::get<double>(current.field.torque.slonczewski->damping_like),
              hbar * 0.4 * 1e12 / (2 * e * 8e5 * 3e-9) / (mu0 * 8e5));
  expect_near(std::get<double>(current.field.torque.slonczewski->field_like), 0.01 / (mu0 * 8e5));
  auto const both = permalloy_with(
      {"torque={slonczewski={current_density={profile='1e12*i',time='cos(t)'},efficiency=0.4,"
       "lambda=2,epsilon_prime=0.1,thickness=3e-9,polarization=[0,1,0]}}"});
  auto const& of_sites = both.field.torque.slonczewski.value();
  EXPECT_EQ(of_sites.lambda, 2);
  double const beta = hbar / (e * 8e5 * 3e-9) / (mu0 * 8e5);
  expect_near(of_sites.damping_like_of_sites.unit, beta * 0.4 / 2);
  expect_near(of_sites.field_like_of_sites.unit, beta * 0.1);
  expect_near(Expression(std::get<std::string>(of_sites.field_like), {"t"})(&t), std::cos(3));
  auto const atoms = iron_with({"torque={slonczewski={damping_like=2,polarization=[0,1,0]}}"});
  expect_near(std::get<double>(atoms.field.torque.slonczewski->damping_like),
              2 * 2.22 * mu_B / 7.05e-21);
}

TEST(SiScenes, ShapesAreOfEitherMaterial) {
  for (auto const& scene :
       {iron_with({"lattice.occupied='x<0.5'", "lattice.frozen='i==0'"}),
        permalloy_with({"lattice.occupied='x<0.5'", "lattice.frozen='i==0'"})}) {
    EXPECT_EQ(scene.lattice.occupied.expression, "x<0.5");
    EXPECT_EQ(scene.lattice.frozen.expression, "i==0");
  }
}

TEST(WrongSiCrystal, IsRefusedInOneLine) {
  expect_refused(iron, R"(
lattice.moments = 1 | : belongs to reduced units | material.mu_s
material.mu_s = [1e-23] | : has 1 entries | 2 of these, one for each
material.mu_s = [1e-23,0] | [1]: 0 is not positive | > 0
material.mu_s = [1e-23,'x'] | [1]: 'x' is a string | J/T
material.mu_s = {bohr_magnetons=[1,{bohr_magnetons=1}]} | .bohr_magnetons[1]: is a table | J/T
material.mu_s = {bohr_magneton=1} | .bohr_magneton: unknown key | bohr_magnetons
material.J = 1e-21 | : needs one site in a cell | field.couplings with J
material.D_bulk = 1e-21 | : needs one site in a cell | field.couplings with D
material = {mu_s=1e-23,D=1e-21,normal=[0,0,1],alpha=0} | .D: needs one site in a cell
  | field.couplings with D
field.exchange = 1 | : belongs to reduced units | material.A
field.dmi = {bulk=1} | : belongs to reduced units | material.D_bulk
field.couplings = {shells={meW=[1]}} | .shells.meW: unknown key | meV, eV, mRy
field.couplings = {shells={meV=1}} | .shells.meV: 1 is an integer | the J of pairs
field.couplings = [{between=[0,1],J={meV=1,eV=1}}] | [0].J: is not one number with its unit
  | { eV = number }
field.anisotropy = {constant={K=1},axis=[0,0,1]} | .constant.K: unknown key | meV, eV, mRy
field.anisotropy = {constant=true,axis=[0,0,1]} | .constant: true is a boolean | an expression
field.anisotropy = {cubic=true,axes=[[1,0,0],[0,1,0]]} | .cubic: true is a boolean | an expression
torque = {slonczewski={current_density=1e12,efficiency=0.4,thickness=1e-9,polarization=[0,0,1]}}
  | .slonczewski.current_density: needs the magnetization of a continuum
  | damping_like, or material.Ms
material.mu_s = { bohr_magnetons = [1, 2] }; field.slab_demag = { normal = [0, 0, 1] }
  | : needs moments that are all alike | one number in material.mu_s, or field.dipoles
material.mu_s = '1e-23*(1+s)'; field.slab_demag = { normal = [0, 0, 1] }
  | : needs moments that are all alike | one number
lattice.regions = 's'; material.mu_s = { regions = [1e-23, 2e-23] };
 field.slab_demag = { normal = [0, 0, 1] } | : needs moments that are all alike | one number
)");
}

TEST(WrongSiContinuum, IsRefusedInOneLine) {
  expect_refused(permalloy, R"(
lattice.moments = 1 | : belongs to reduced units | material.Ms
lattice.crystal = 'bcc' | : is of atoms | material.mu_s
lattice.cell = [[1,0,0],[0,1,0],[0,0,1]] | : is of atoms | mu_s
lattice.basis = [[0,0,0]] | : is of atoms | material.mu_s
field.couplings = [{offset=[1,0,0],J=1e-21}] | : is of atoms | material.mu_s, or no such key
material.A = 'q' | : expression "q"
material.A = {meV=1} | .meV: unknown key | file
material.alpha = 'q' | : expression "q"
torque = {zhang_li={current_density=[1e12,0,0]}} | .zhang_li.polarization: is missing | a number
torque = {zhang_li={current_density=1e12,polarization=0.4}}
  | .zhang_li.current_density: 1000000000000.0 is a number | three numbers
torque = {zhang_li={current_density=[1e12,0,0],velocity=[1,0,0],polarization=0.4}}
  | .zhang_li.current_density: stands beside velocity | one of the two
torque = {zhang_li={velocity=[1,0,0],polarization=0.4}}
  | .zhang_li.polarization: stands without current_density | both or neither
torque = {slonczewski={current_density=1e12,thickness=1e-9,polarization=[0,0,1]}}
  | .slonczewski.efficiency: is missing | a number
torque = {slonczewski={current_density=1e12,efficiency=0.4,polarization=[0,0,1]}}
  | .slonczewski.thickness: is missing | in m
torque = {slonczewski={current_density=1e12,efficiency=0.4,thickness=0,polarization=[0,0,1]}}
  | .slonczewski.thickness: 0 is not positive | > 0
torque = {slonczewski={current_density=1e12,damping_like=1,efficiency=0.4,thickness=1e-9,
 polarization=[0,0,1]}}
  | .slonczewski.current_density: stands beside damping_like | one of the two
torque = {slonczewski={field_like=1,efficiency=0.4,polarization=[0,0,1]}}
  | .slonczewski.efficiency: stands without current_density | both or neither
torque = {slonczewski={current_density=1e12,field_like=1,epsilon_prime=0.1,efficiency=0.4,
 thickness=1e-9,polarization=[0,0,1]}}
  | .slonczewski.field_like: stands beside epsilon_prime | one of the two
material.gamma = '1.7e11'; torque = {slonczewski={current_density=1e12,efficiency=0.4,
 thickness=1e-9,polarization=[0,0,1]}}
  | .slonczewski.current_density: needs one gamma for all sites | damping_like, or one gamma
lattice.gyromagnetic = 2; material.gamma = '1.7e11' | : stands beside lattice.gyromagnetic
  | one number
material.A =; material.D = 1e-3; material.normal = [0, 0, 1]; material.D_bulk = 1e-3
  | : stands beside material.D | D with normal, of an interface, D_bulk, or D2d
material.A =; material.D_bulk = 1e-3; material.D2d = 1e-3
  | : stands beside material.D_bulk | D with normal, of an interface, D_bulk, or D2d
material.alpha = '0.5'; material.damping_form = 1 | : 1 is an integer | gilbert
material.alpha = '0.5'; material.damping_form = | : is missing | gilbert
)");
}

TEST(WrongReducedScene, HasNoCurrentInSi) {
  expect_refused(llg_scene, R"(
torque.zhang_li = { current_density = [1e12, 0, 0], polarization = 0.4 }
  | .current_density: is in A/m^2 | velocity, or units = "SI"
)");
}

TEST(WrongSiContinuum, MessagesOfSitesNameTheMaterial) {
  auto const scene = permalloy_with({"material.A={file='/none.h5'}"});
  expect_holds(refusal([&] { check_files(scene); }), ": material.A: /none.h5");
  auto const pole = permalloy_with({"material.alpha='1/(i-2)'"});
  expect_holds(
      refusal([&] { numbers_of_sites(pole, pole.system.dampings, "system.damping", whole(pole)); }),
      ": material.alpha: ");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
