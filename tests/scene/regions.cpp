// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Regions, and the values, vectors, moments, bonds, sources and temperatures that they determine.
#include "hdf5_file.hpp"
#include "scene_file.hpp"

#include <cayspin/units.hpp>

#include <variant>

namespace cayspin::inline v0_2::io::test {
namespace {

using Overrides = std::vector<std::string>;

constexpr std::string_view layers = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [4, 3, 2]
regions = "k == 0 ? 0 : i < 2 ? 1 : 2"
[field]
exchange = 1
[initial]
random = { seed = 1 }
[integrator]
method = "heun"
dt = 0.01
steps = 10
)toml";

Scene layers_with(Overrides const& overrides) {
  return parse_scene(std::string(layers), "scene.toml", overrides);
}

// Returns the error in reading a scene or its site-dependent values.
std::string refusal_of(Overrides const& overrides) {
  return refusal([&] {
    auto const scene = layers_with(overrides);
    auto const box = whole(scene);
    regions(scene, box);
    moments_of_sites(scene, box);
    gyromagnetic_of_sites(scene, box);
    check_files(scene);
    auto const& field = scene.field;
    if (auto const& torque = field.torque.slonczewski) {
      constexpr auto key = "torque.slonczewski";
      if (torque->field_like_of_sites.there())
        numbers_of_sites(scene, torque->field_like_of_sites, key, box);
      if (torque->polarizations.there())
        directions_of_sites(scene, torque->polarizations, "torque.slonczewski.polarization", box);
    }
    if (field.exchange_factors.there())
      numbers_of_sites(scene, field.exchange_factors, "field.exchange", box);
    for (auto const& term : field.anisotropies)
      if (term.axes.there()) directions_of_sites(scene, term.axes, "field.anisotropy", box);
    for (auto const& term : field.crystal_anisotropies) crystal_axes(scene, term, box);
    if (field.dmi_normals.there()) directions_of_sites(scene, field.dmi_normals, "field.dmi", box);
  });
}

std::size_t region_of(std::size_t site) { return site < 12 ? 0 : site % 4 < 2 ? 1 : 2; }

TEST(Regions, GiveNumbersToTheirSites) {
  auto const scene =
      layers_with({"lattice.moments={regions=[1,0.5,0]}", "field.exchange={regions=[3,4,5]}",
                   "system.damping={regions=[0,0.1,0.2]}",
                   "field.anisotropy={constant={regions=[7,8,9]},axis={regions=[[0,"
                   "0,2],[1,0,0],[0,3,4]]},constant2={regions=[-1,0,1]}}"});
  auto const box = whole(scene);
  auto const& term = scene.field.anisotropies.at(0);
  auto const moments = moments_of_sites(scene, box);
  auto const exchange =
      numbers_of_sites(scene, scene.field.exchange_factors, "field.exchange", box);
  auto const damping = numbers_of_sites(scene, scene.system.dampings, "system.damping", box);
  auto const second = numbers_of_sites(scene, term.factors2, "field.anisotropy", box);
  auto const axes = directions_of_sites(scene, term.axes, "field.anisotropy", box);
  auto const there = occupied(scene, box);
  EXPECT_TRUE(has_vacancies(scene));
  EXPECT_TRUE(needs_pass(scene));
  EXPECT_FALSE(has_linear_field(scene));
  constexpr double of_moments[] = {1, 0.5, 0}, of_damping[] = {0, 0.1, 0.2};
  constexpr Triple of_axes[] = {{0, 0, 1}, {1, 0, 0}, {0, 0.6, 0.8}};
  for (std::size_t site = 0; site < 24; ++site) {
    auto const region = region_of(site);
    EXPECT_EQ(moments[site], of_moments[region]) << site;
    EXPECT_EQ(exchange[site], 3. + static_cast<double>(region)) << site;
    EXPECT_EQ(damping[site], of_damping[region]) << site;
    EXPECT_EQ(second[site], static_cast<double>(region) - 1) << site;
    EXPECT_EQ(there[site], region != 2) << site;
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_DOUBLE_EQ(axes[3 * site + c], of_axes[region][c]) << site;
  }
  SiteBox const part{{1, 1, 1}, {3, 2, 1}};
  EXPECT_EQ(moments_of_sites(scene, part), numbers_in(part, {4, 3, 2}, 1, moments));
  EXPECT_EQ(directions_of_sites(scene, term.axes, "field.anisotropy", part),
            numbers_in(part, {4, 3, 2}, 3, axes));
}

TEST(Regions, HaveBondsBetweenThem) {
  auto const bonds = [](Scene const& scene, SiteBox const& box, std::size_t axis) {
    return regions_of_bonds(scene, box, axis);
  };
  using Pair = std::array<std::int64_t, 2>;
  auto const scene = layers_with({"lattice.boundary=['open','open','periodic']"});
  auto const along_x = bonds(scene, whole(scene), 0), along_z = bonds(scene, whole(scene), 2);
  EXPECT_EQ(along_x[12], (Pair{1, 1}));
  EXPECT_EQ(along_x[13], (Pair{1, 2}));
  EXPECT_EQ(along_x[15], (Pair{2, 2}));
  EXPECT_EQ(along_z[0], (Pair{0, 1}));
  EXPECT_EQ(along_z[14], (Pair{2, 0}));
  // The bond of the last site of a box leads out of the box.
  EXPECT_EQ(bonds(scene, {{1, 0, 1}, {1, 1, 1}}, 0), std::vector{(Pair{1, 2})});
  EXPECT_EQ(bonds(scene, {{0, 2, 0}, {4, 1, 1}}, 2),
            (std::vector<Pair>{{0, 1}, {0, 1}, {0, 2}, {0, 2}}));

  auto const typed = layers_with({"field.exchange_between=[{between=[0,1],factor=0.5}]",
                                  "field.interlayer=[{between=[2,0],J=-1,biquadratic=0.2}]"});
  EXPECT_EQ(typed.field.exchange->constant, 1);
  EXPECT_EQ(typed.field.exchange_factors.expression, "1");
  EXPECT_EQ(typed.field.exchange_factors.unit, 1);
  EXPECT_EQ(typed.field.interlayers.at(0).bilinear, -1);
  EXPECT_EQ(typed.field.interlayers.at(0).biquadratic, 0.2);
}

TEST(Regions, HaveBondsAcrossSitesWithoutASpin) {
  using Pair = std::array<std::int64_t, 2>;
  auto const scene = parse_scene(R"toml(
system = { kind = "llg", damping = 0.1 }
initial = { uniform = [0, 0, 1] }
integrator = { method = "heun", dt = 0.1, steps = 1 }
[lattice]
shape = [7, 2]
boundary = ["periodic", "open"]
regions = "i"
occupied = "i == 0 || i == 2 || i == 5 || j == 1"
)toml",
                                 "scene.toml");
  auto const box = whole(scene);
  constexpr Pair none{-1, -1};
  auto const two = regions_across(scene, box, 0, 2), back = regions_across(scene, box, 0, -2);
  std::vector<Pair> expected(14, none), expected_back = expected;
  expected[0] = {0, 2}, expected[5] = {5, 0};
  expected_back[2] = {2, 0}, expected_back[0] = {0, 5};
  EXPECT_EQ(two, expected);
  EXPECT_EQ(back, expected_back);
  auto const three = regions_across(scene, box, 0, 3);
  expected.assign(14, none);
  expected[2] = {2, 5};
  EXPECT_EQ(three, expected);
  EXPECT_EQ(regions_across(scene, box, 0, 7), std::vector<Pair>(14, none));
  EXPECT_EQ(regions_across(scene, box, 1, 2), std::vector<Pair>(14, none));
  EXPECT_EQ(regions_across(scene, {{5, 0, 0}, {2, 1, 1}}, 0, 2), (std::vector<Pair>{{5, 0}, none}));
  EXPECT_EQ(regions_across(scene, {{0, 0, 0}, {1, 1, 1}}, 0, -2), (std::vector<Pair>{{0, 5}}));
  EXPECT_EQ(
      numbers_across(scene, scene.lattice.regions, "lattice.regions", {{4, 0, 0}, {3, 1, 1}}, 0, 2),
      (std::vector<double>{6, 0, 1}));
  EXPECT_EQ(
      numbers_across(scene, scene.lattice.regions, "lattice.regions", {{3, 0, 0}, {1, 2, 1}}, 1, 1),
      (std::vector<double>{3, 0}));
}

TEST(Regions, OfAMaterialAreInSi) {
  auto const scene = parse_scene(R"toml(
units = "SI"
system = { kind = "llg" }
material = { Ms = { regions = [8e5, 4e5] }, A = 1e-11, Ku = { regions = [1e5, 0] }, Ku2 = 2e4, axis = { regions = [[0, 0, 1], [1, 0, 0]] }, alpha = 0.1, damping_form = "gilbert" }
lattice = { shape = [4], spacing = 2e-9, regions = "i % 2" }
initial = { uniform = [0, 0, 1] }
integrator = { method = "heun", dt = 1e-14, steps = 1 }
thermal = { temperature = { profile = "100*(i+1)", time = "exp(-t/1e-12)" } }
[field]
interlayer = [ { between = [0, 1], J = -1e-3 } ]
sources = [ { profile = [0, 0, "0.1*i"], time = "sin(1e9*t)" } ]
)toml",
                                 "scene.toml");
  auto const box = whole(scene);
  double const pressure = units::vacuum_permeability * 8e5 * 8e5, cell = 2e-9;
  EXPECT_EQ(moments_of_sites(scene, box), (std::vector{1.0, 0.5, 1.0, 0.5}));
  auto const& axis = scene.field.anisotropies.at(0);
  EXPECT_DOUBLE_EQ(numbers_of_sites(scene, axis.factors, "field.anisotropy", box)[0],
                   2e5 / pressure);
  EXPECT_DOUBLE_EQ(axis.constant2, 8e4 / pressure);
  double const spacing = scene.lattice.spacing[0];
  EXPECT_DOUBLE_EQ(scene.field.interlayers.at(0).bilinear / spacing, -1e-3 / (cell * pressure));
  auto const source = vectors_of_sites(scene, scene.field.sources.at(0).profile, "", box);
  EXPECT_NEAR(source[11], 0.3 / (units::vacuum_permeability * 8e5), 1e-15);
  double const energy = pressure * cell * cell * cell;
  EXPECT_NEAR(scene.thermal->temperature, units::boltzmann / energy,
              1e-12 * units::boltzmann / energy);
  EXPECT_EQ(noise_of_sites(scene, box), (std::vector{100.0, 400.0, 300.0, 800.0}));
}

TEST(Regions, ErrorsInVectorsOfAMaterialNameItsKeys) {
  for (auto const& [typed, says] :
       {std::pair{"Ku = 1e4\naxis = ['i', 0, 0]",
                  "material.axis: has no direction at site (0, 0, 0)"},
        {"Ku = 1e4\naxis = { file = 'none.h5' }", "material.axis: none.h5: cannot open the file"},
        {"D = 1e-3\nnormal = ['i', 0, 0]", "material.normal: has no direction at site (0, 0, 0)"},
        {"D = 1e-3\nnormal = ['1/i', 0, 0]",
         "material.normal: expression \"1/i\" is not finite"}}) {
    auto const text = std::string(R"toml(units = "SI"
system = { kind = "llg" }
lattice = { shape = [4], spacing = 2e-9 }
initial = { uniform = [0, 0, 1] }
integrator = { method = "heun", dt = 1e-14, steps = 1 }
[material]
Ms = 8e5
A = 1e-11
alpha = 0
)toml") + typed + '\n';
    auto const message = refusal([&] {
      auto const scene = scene_of(text);
      check_files(scene);
      require_directions(scene);
    });
    EXPECT_TRUE(message.starts_with("scene.toml:11: " + std::string(says))) << message;
  }
}

// Those of a later stage may be the first terms that depend on regions.
TEST(Regions, AreCheckedEvenIfNoTermDependsOnThem) {
  for (auto const& [typed, says] :
       {std::pair{"'k-1'", "lattice.regions: is -1 at site (0, 0, 0); accepted: whole numbers"},
        {"'k/2'", "lattice.regions: is 0.5 at site (0, 0, 1); accepted: whole numbers"},
        {"'65536*k'", "lattice.regions: is 65536 at site (0, 0, 1); accepted: whole numbers"},
        {"'1/(i-1)'", "lattice.regions: expression \"1/(i-1)\" is not finite at x = "}}) {
    auto const scene = layers_with({std::string("lattice.regions=") + typed});
    expect_holds(refusal([&] { check_files(scene); }), says);
  }
  EXPECT_EQ(refusal([] { check_files(layers_with({"lattice.regions='65535*k'"})); }), "accepted");
}

TEST(Regions, SayWhatIsWrongInOneLine) {
  struct Wrong {
    std::string key, value, says;
  };
  for (auto const& [key, value, says] : std::vector<Wrong>{
           {"lattice.regions", "'i-0.5'", "lattice.regions: is -0.5 at site (0, 0, 0); accepted: "},
           {"lattice.regions", "'0.5'", "accepted: whole numbers from 0"},
           {"lattice.regions", "3",
            "lattice.regions: 3 is an integer; accepted: an expression in x, y, z, i, j, k, "
            "{ file = \"NAME.h5\" } or { image = "},
           {"lattice.regions", "{regions=[0,1]}",
            "lattice.regions: says which region each site belongs to, and cannot depend on the "
            "region; accepted: an expression in x"},
           {"field.exchange", "{regions=[1,2]}",
            "field.exchange: has no number for region 2, to which"},
           {"field.exchange", "{regions=[]}", "has 0 entries"},
           {"field.exchange", "{regions=[1,2,'a']}", "field.exchange.regions[2]: "},
           {"field.exchange", "{regions=[1,2,3],file='x.h5'}", "stands beside file"},
           {"lattice.moments", "'k-0.5'", "lattice.moments: is -0.5 at site (0, 0, 0); accepted: "},
           {"lattice.moments", "{regions=[0,0,0]}", "lattice.moments: leaves no spin"},
           {"field.anisotropy", "{constant=1,axis={regions=[[0,0,1],[0,0,0]]}}",
            "has no direction"},
           {"field.anisotropy", "{constant=1,axis=['i',0,0]}",
            "field.anisotropy: has no direction at"},
           {"field.anisotropy", "{cubic=1,axes=[[1,0,0],[0,1,0]],constant=1}",
            "belongs to a uniaxial"},
           {"field.anisotropy", "{cubic=1,axes=[{regions=[[1,0,0],[0,1,0],[0,0,1]]},[0,1,1]]}",
            "the axes are not at right angles, by 0.707, at site (0, 0, 1); accepted: two vectors"},
           {"field.anisotropy", "{hexagonal=1,axis=['i',0,0],in_plane=[0,0,1]}",
            "field.anisotropy: has no direction at"},
           {"field.dmi", "{interfacial=1,normal={regions=[[0,0,1],[0,0,0],[1,0,0]]}}",
            "field.dmi.normal: the vector of region 1 has no direction"},
           {"field.dmi", "{interfacial=1,normal=['i',0,0]}", "field.dmi: has no direction at"},
           {"field.dmi", "{interfacial=1,normal=['i+1',0,0],free_boundary=true}",
            "does not go with normals that differ"},
           {"field.in_time", "{exchange='t+x'}", "field.in_time.exchange: "},
           {"field.in_time", "{anisotropy='t'}",
            "field.in_time.anisotropy: stands without anisotropy"},
           {"field.in_time", "{dmi=2}", "field.in_time.dmi: stands without DMI"},
           {"field.in_time", "{applied=2}", "field.in_time.applied: unknown key"},
           {"field.exchange_between", "[{between=[0,1]}]", "factor: is missing"},
           {"field.exchange_between", "[{between=[0,1,2],factor=1}]", "has 3 entries"},
           {"field.exchange_between", "[{between=[0,1],factor=1},{between=[1,0],factor=2}]",
            "repeats a pair of regions"},
           {"field.interlayer", "[{between=[0,1]}]", "has no constant"},
           {"field.interlayer", "[{between=[0,-1],J=1}]", "between[1]: "},
           {"field.interlayer", "{between=[0,1],J=1}", "field.interlayer: "},
           {"field.interlayer", "[{between=[0,1],J=1,range=-1}]", "interlayer[0].range: "},
           {"field.interlayer", "[{between=[0,1],J=1,range=0.5}]", "interlayer[0].range: "},
           {"field.interlayer", "[{between=[0,1],J=1,range=2},{between=[1,0],J=1,range=2}]",
            "repeats a pair of regions"},
           {"lattice.gyromagnetic", "'q'", "lattice.gyromagnetic: expression \"q\""},
           {"lattice.gyromagnetic", "{regions=[1,-1,1]}",
            "lattice.gyromagnetic: is -1 at site (0, 0, 1); accepted: "},
           {"torque", "{slonczewski={damping_like=1,polarization=[0,0,1],lambda=0.5}}",
            "torque.slonczewski.lambda: "},
           {"torque", "{slonczewski={damping_like=1,polarization=[0,0,1],epsilon_prime=1}}",
            "epsilon_prime: stands without current_density"},
           {"torque", "{slonczewski={damping_like='q',polarization=[0,0,1]}}",
            "torque.slonczewski.damping_like: expression \"q\""},
           {"torque", "{slonczewski={damping_like={profile=1},polarization=[0,0,1]}}",
            "damping_like.time: is missing"},
           {"torque", "{slonczewski={field_like={regions=[1]},polarization=[0,0,1]}}",
            "torque.slonczewski.field_like: has no number for region"},
           {"torque", "{slonczewski={damping_like=1,polarization=['i',0,0]}}",
            "torque.slonczewski.polarization: has no direction at site (0, 0, 0)"},
           {"torque", "{slonczewski={damping_like=1,polarization={regions=[[0,0,0]]}}}",
            "the vector of region 0 has no direction"},
           {"field.sources", "[{time='t'}]", "profile: is missing"},
           {"field.sources", "[{profile=[1,2]}]", "has 2 entries"},
           {"field.sources", "[{profile=[1,2,'q']}]", "profile[2]: "},
           {"field.sources", "[{profile={file='a.h5',regions=[[1,0,0]]}}]",
            "profile: has 2 keys; accepted: three components"},
           {"thermal.temperature", "-1", "thermal.temperature: "},
           {"thermal.temperature", "{profile=-1,time='t'}", "is negative"},
           {"thermal.temperature", "{profile=1}", "time: is missing"}}) {
    SCOPED_TRACE(key + " = " + value);
    auto const text = refusal_of({key + "=" + value});
    expect_holds(text, says);
    EXPECT_EQ(text.find('\n'), text.npos) << text;
  }
  auto const layered =
      refusal_of({"field.interlayer=[{between=[0,1],J=1}]", "field.in_time={exchange='1+t'}"});
  expect_holds(layered, "field.in_time.exchange: does not go with interlayer");
  auto const sides = refusal_of({"field.dmi={d2d=1,free_boundary=true}", "field.in_time={dmi=2}"});
  expect_holds(sides, "field.in_time: does not go with free_boundary");
  auto const bare = refusal([] {
    parse_scene(R"toml(
system = { kind = "llg", damping = { regions = [1] } }
lattice = { shape = [4] }
initial = { uniform = [0, 0, 1] }
integrator = { method = "heun", dt = 0.1, steps = 1 }
)toml",
                "scene.toml");
  });
  expect_holds(bare, "system.damping.regions: stands without lattice.regions");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
