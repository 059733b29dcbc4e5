// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Notes on keys of a scene that have no effect or contradict another key.
#include "io/notes.hpp"

#include "io/ovf.hpp"
#include "scene_file.hpp"

#include <cayspin/demagnetization/images.hpp>

#include <algorithm>
#include <array>
#include <random>

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr int all = infinitely_many_images;

std::string const film_with_notes = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [6, 5]
[field]
[initial]
uniform = [0, 0, 1]
[integrator]
method = "heun"
dt = 0.1
steps = 1
)toml";

std::vector<std::string> notes_with(std::vector<std::string> const& overrides) {
  return notes(scene_of(film_with_notes, overrides));
}

std::string refusal_with(std::vector<std::string> const& overrides) {
  return refusal([&] { scene_of(film_with_notes, overrides); });
}

struct Case {
  std::vector<std::string> overrides;
  std::string note;  // part of the only note; empty: no note
};

TEST(Notes, SayWhatActsNowhere) {
  std::string const chain = "lattice.shape=[8]", single = "lattice.shape=[1]";
  std::string const site = "lattice={shape=[4,4,2],crystal='bcc',occupied='s==0'}",
                    moment = "lattice={shape=[4,4,2],crystal='bcc',moments=[2,0]}";
  for (
      auto const& [overrides, expected] : std::vector<Case>{
          {{"field.exchange=1"}, ""},
          {{single, "field.exchange=1"}, "field.exchange: acts nowhere: no cell has a neighbour"},
          {{single, "lattice.boundary='periodic'", "field.exchange=1"}, "field.exchange: acts"},
          {{single, "field.exchange=0"}, ""},
          {{chain, "field.dmi={interfacial=1,normal=[0,0,1]}"}, ""},
          {{chain, "field.dmi={interfacial=1,normal=[-2,0,0]}"}, "only along the normal"},
          {{"field.dmi={interfacial=1,normal=[1,0,0]}"}, ""},
          {{single, "field.dmi={bulk=1}"}, "field.dmi: acts nowhere"},
          {{"field.mu0=2"}, "field.mu0: acts nowhere"},
          {{"field.mu0=2", "field.applied=[0,0,1]"}, ""},
          {{"field.mu0=2", "field.sources=[{profile=[0,0,1]}]"}, ""},
          {{chain, "field.exchange=1", "lattice.regions='i>3'",
            "field.exchange_between=[{between=[0,1],factor=2}]"},
           ""},
          {{chain, "field.exchange=1", "lattice.regions='i>3'",
            "field.exchange_between=[{between=[0,5],factor=2}]"},
           "field.exchange_between: acts nowhere: no spins of regions 0 and 5 are neighbours"},
          {{chain, "lattice.regions='i>3'", "field.interlayer=[{between=[1,2],J=1}]"},
           "field.interlayer: acts nowhere: no spins of regions 1 and 2 are neighbours"},
          {{chain, "lattice.regions='i>3'", "field.interlayer=[{between=[0,1],J=1,range=1}]"},
           "field.interlayer: acts nowhere: no spins of regions 0 and 1 have 1 cell without a spin "
           "between them"},
          {{chain, "torque.zhang_li={velocity=[0,1,2]}"}, "torque.zhang_li: acts nowhere"},
          {{chain, "torque.zhang_li={velocity=['sin(t)',1,2]}"}, ""},
          {{"system.damping=0", "system.precession=false"}, "no spin moves"},
          {{"lattice.occupied='1+i'"}, "lattice.occupied: is 0 nowhere"},
          {{"lattice.occupied='i'"}, ""},
          {{"lattice.frozen='0*i'"}, "lattice.frozen: holds no spin"},
          {{"lattice.frozen='1'"}, "lattice.frozen: holds every spin"},
          {{"lattice.frozen='i==0'", "lattice.occupied='i>0'"}, "lattice.frozen: holds no spin"},
          {{site, "field.anisotropy={constant=1,axis=[0,0,1],site=1}"},
           "no cell has a spin on site 1"},
          {{site, "field.anisotropy={constant=1,axis=[0,0,1],site=0}"}, ""},
          {{site, "field.couplings=[{between=[0,1],J=1}]"}, "field.couplings[0]: acts nowhere"},
          {{moment, "field.couplings=[{between=[0,1],J=1}]"}, "field.couplings[0]: acts nowhere"},
          {{moment, "field.couplings={pairs=[{between=[0,1],J=1}]}"},
           "field.couplings.pairs: acts nowhere"},
          {{moment, "field.couplings={shells=[1]}"}, ""},
          {{chain, "field.couplings={shells=[1,1,1,1,1,1,1]}"}, ""},
          {{chain, "field.couplings={shells=[1,1,1,1,1,1,1,1]}"}, "entry 7, for pairs 8 apart"},
          {{chain, "lattice.boundary='periodic'", "field.couplings=[{offset=[8,0,0],J=1}]"},
           "field.couplings[0]: couples each site to itself"},
          {{chain, "lattice.boundary='periodic'", "field.couplings={pairs=[{offset=[8,0,0],J=1}]}"},
           "field.couplings.pairs: couples each site to itself"},
          {{chain, "lattice.boundary='periodic'",
            "field.couplings={shells=[1],pairs=[{offset=[8,0,0],J=1}]}"},
           "field.couplings.pairs: couples each site to itself"},
          {{chain, "field.couplings={shells=[1,0,0,0,0,0,0,1],pairs=[{offset=[7,0,0],J=1}]}"},
           "field.couplings.shells: entry 7, for pairs 8 apart"},
          {{"units='SI'", "system={kind='llg'}", "integrator.dt=1e-15",
            "material={mu_s={bohr_magnetons=1},alpha=0.1,damping_form='gilbert'}",
            "lattice={shape=[8],spacing=3e-10}",
            "field={couplings={shells={meV=[1,1,1,1,1,1,1,1]}}}"},
           "field.couplings.shells: entry 7, for pairs 2.4e-09 m apart"},
      }) {
    auto const found = notes_with(overrides);
    SCOPED_TRACE(testing::PrintToString(overrides) + testing::PrintToString(found));
    ASSERT_EQ(found.size(), expected.empty() ? 0U : 1U);
    if (!expected.empty()) {
      EXPECT_NE(found[0].find(expected), found[0].npos);
    }
  }
}

// Values typed in other units are far from those of any magnet.
TEST(Notes, NameMagnitudesOfOtherUnits) {
  auto const notes_of = [](std::string const& material, std::string const& more = "") {
    return notes(scene_of(
        "units = 'SI'\nsystem = { kind = 'llg' }\nmaterial = { damping_form = 'gilbert', " +
            material +
            " }\nlattice = { shape = [4, 4], spacing = " + (more.empty() ? "5e-9" : more) +
            " }\ninitial = { uniform = [0, 0, 1] }\nintegrator = { method = 'heun', dt "
            "= 1e-14, steps = 1 }\n",
        {}));
  };
  EXPECT_TRUE(notes_of("Ms = 8e5, A = 1.3e-11, alpha = 0.1").empty());
  EXPECT_TRUE(notes_of("mu_s = 2.2e-23, J = 1e-21, alpha = 0.1").empty());
  EXPECT_TRUE(notes_of("Ms = '8e5 + i', A = '1e-11 + i * 1e-13', alpha = 0.1").empty());
  EXPECT_TRUE(notes_of("mu_s = 2.2e-23, J = '1e-21 * (1 + i)', alpha = 0.1").empty());
  for (auto const& [material, key] :
       {std::pair{"Ms = 1.0, A = 1.3e-11, alpha = 0.1", "material.Ms"},
        std::pair{"Ms = 8e5, A = 13, alpha = 0.1", "material.A"},
        std::pair{"Ms = 8e5, A = 1.3e-11, alpha = 0.1, gamma = 2.211e5", "material.gamma"},
        std::pair{"mu_s = 2.2, J = 1e-21, alpha = 0.1", "material.mu_s"},
        std::pair{"mu_s = 2.2e-23, J = 10, alpha = 0.1", "material.J"}}) {
    auto const found = notes_of(material);
    ASSERT_EQ(found.size(), 1U) << material;
    EXPECT_NE(found[0].find(key), std::string::npos) << found[0];
  }
  auto const large = notes_of("Ms = 8e5, A = 1.3e-11, alpha = 0.1", "5");
  ASSERT_EQ(large.size(), 1U);
  EXPECT_NE(large[0].find("lattice.spacing"), std::string::npos) << large[0];
}

TEST(Notes, SayWhereImagesAndBoundariesDiffer) {
  std::string const periodic = "lattice.boundary='periodic'",
                    images = "field.demag.periodic_images=";
  for (auto const& [overrides, expected] : std::vector<Case>{
           {{"field.demag=true"}, ""},
           {{periodic, "field.demag=true"}, ""},
           {{periodic, images + "[2,1,0]"}, ""},
           {{periodic, images + "[0,1,0]"},
            "no images along x, where lattice.boundary is periodic"},
           {{images + "[0,0,0]"}, ""},
           {{images + "[0,2,0]"}, "images along y, where lattice.boundary is open"},
           {{images + "[0,0,2]"}, ""},  // one cell along z: no other term sees this boundary
       }) {
    auto const found = notes_with(overrides);
    SCOPED_TRACE(testing::PrintToString(overrides) + testing::PrintToString(found));
    ASSERT_EQ(found.size(), expected.empty() ? 0U : 1U);
    if (!expected.empty()) {
      EXPECT_NE(found[0].find(expected), found[0].npos);
    }
  }
}

// There are infinitely many images along periodic axes of more than one cell, even along all three.
TEST(Dipoles, GoOnForEverAlongPeriodicVectors) {
  auto const images = [](std::string const& lattice) {
    return scene_of(film_with_notes, {"lattice=" + lattice, "field={dipoles=true}"})
        .field.demag->periodic_images;
  };
  EXPECT_EQ(images("{shape=[4,4,1],crystal='bcc'}"), (std::array{0, 0, 0}));
  EXPECT_EQ(images("{shape=[4,4,1],crystal='bcc',boundary='periodic'}"), (std::array{all, all, 0}));
  EXPECT_EQ(images("{shape=[4,4,2],boundary='periodic'}"), (std::array{all, all, all}));
  EXPECT_FALSE(scene_of(film_with_notes, {"field.dipoles=false"}).field.demag);
  auto const cell =
      std::string("{shape=[2,4],cell=[[1,0,0],[0,9000,0],[0,0,1]],boundary='periodic'}");
  EXPECT_NE(refusal_with({"lattice=" + cell, "field={dipoles=true}"}).find("up to 1e4 : 1"),
            std::string::npos);
  EXPECT_NE(refusal_with({"field.demag=true", "field.dipoles=true"})
                .find("field.dipoles: stands beside field.demag"),
            std::string::npos);
  EXPECT_EQ(notes_with({"field.dipoles.periodic_images=[0,2,0]"}).size(), 1U);
}

TEST(Demagnetization, GoesOnForEverAlongPeriodicAxes) {
  auto const images = [](std::vector<std::string> overrides) {
    overrides.emplace_back("field.demag=true");
    return scene_of(film_with_notes, overrides).field.demag->periodic_images;
  };
  EXPECT_EQ(images({}), (std::array{0, 0, 0}));
  EXPECT_EQ(images({"lattice.boundary='periodic'"}), (std::array{all, all, 0}));
  EXPECT_EQ(images({"lattice.boundary=['open','periodic']"}), (std::array{0, all, 0}));
  EXPECT_EQ(images({"lattice={shape=[1,1,4],boundary='periodic'}"}), (std::array{0, 0, all}));
  EXPECT_EQ(scene_of(film_with_notes, {"lattice.boundary='periodic'", "field.demag={strength=2}"})
                .field.demag->periodic_images,
            (std::array{all, all, 0}));
  for (auto const* const demag : {"field.demag=true", "field.demag={strength=1}"}) {
    auto const said = refusal_with({"lattice={shape=[4,4,4],boundary='periodic'}", demag});
    EXPECT_NE(said.find("field.demag: "), said.npos) << said;
    EXPECT_NE(said.find("periodic_images = [nx, ny, nz]"), said.npos) << said;
  }
  EXPECT_EQ(refusal_with({"lattice={shape=[4,4,4],boundary='periodic'}",
                          "field.demag.periodic_images=[1,1,1]"}),
            "accepted");
  EXPECT_NE(refusal_with({"lattice={shape=[2,30000],boundary='periodic'}", "field.demag=true"})
                .find("up to 1e4 : 1"),
            std::string::npos);
}

TEST(Demagnetization, OfCellsOfAnyShapeUpToALimit) {
  EXPECT_EQ(refusal_with({"lattice={shape=[4,4,1],spacing=[1,1,1e-9]}", "field.demag=true"}),
            "accepted");
  for (auto const* const demag : {"field.demag=true", "field.demag={multirate=false}"})
    EXPECT_NE(
        refusal_with({"lattice={shape=[4,4,1],spacing=[1,1,1e-10]}", demag}).find("1e+10 : 1"),
        std::string::npos);
}

// A coupling is refused if no two cells of the lattice are its offset apart.
TEST(Couplings, ThatLeaveTheLatticeEverywhereAreRefused) {
  std::mt19937_64 random(3);
  auto const draw = [&](int least, int most) {
    return std::uniform_int_distribution(least, most)(random);
  };
  int refused = 0;
  for (int round = 0; round < 300; ++round) {
    std::array<int, 3> shape{}, offset{};
    std::array<bool, 3> periodic{};
    std::string boundary;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      shape[axis] = draw(1, 4);
      offset[axis] = draw(-4, 4);
      periodic[axis] = draw(0, 1) == 1;
      boundary += periodic[axis] ? "'periodic'," : "'open',";
    }
    if (offset == std::array<int, 3>{}) continue;
    int pairs = 0;
    for (int k = 0; k < shape[2]; ++k)
      for (int j = 0; j < shape[1]; ++j)
        for (int i = 0; i < shape[0]; ++i) {
          std::array const there{i + offset[0], j + offset[1], k + offset[2]};
          bool inside = true;
          for (std::size_t axis = 0; axis < 3; ++axis)
            inside = inside && (periodic[axis] || (there[axis] >= 0 && there[axis] < shape[axis]));
          pairs += inside;
        }
    auto const said = refusal_with(
        {"lattice={shape=[" + std::to_string(shape[0]) + "," + std::to_string(shape[1]) + "," +
             std::to_string(shape[2]) + "],boundary=[" + boundary + "]" +
             (draw(0, 1) == 1 ? "" : ",crystal='bcc'") + "}",
         "field.couplings=[{offset=[" + std::to_string(offset[0]) + "," +
             std::to_string(offset[1]) + "," + std::to_string(offset[2]) + "],J=1}]"});
    EXPECT_EQ(said == "accepted", pairs > 0) << said;
    if (said != "accepted") {
      EXPECT_NE(said.find("field.couplings[0]: leaves the lattice"), said.npos) << said;
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
