// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Cells, sites, bonds and starts of crystals in scenes.
#include "hdf5_file.hpp"
#include "io/ovf.hpp"
#include "scene_file.hpp"

#include <cayspin/shells.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string const crystal_scene =
    replaced(plain_scene, "shape = [4, 3, 2]", "shape = [4, 3, 2]\ncrystal = \"bcc\"") +
    "[field]\ncouplings = { shells = [1.0] }\n";

Scene crystal_with(std::vector<std::string> const& overrides) {
  return scene_of(crystal_scene, overrides);
}
Scene crystal_from(Folder const& folder, std::string const& file) {
  return read_text(folder, crystal_scene, {"initial={file='" + file + "'}"});
}

TEST(Crystals, EveryKeyArrives) {
  auto const scene = crystal_with(
      {"lattice={shape=[4,3],spacing=0.5,boundary='periodic',cell=[[1,0,0],[0.5,1,0],[0,0,2]],"
       "basis=[[0,0,0],[0.5,0.25,0]],moments=[1,0.5],gyromagnetic=1.5,occupied='i<2',frozen='s'}",
       "field={couplings=[{between=[0,1],J=2,D=[1,2,3]},{offset=[-1,0,0],"
       "tensor=[[1,2,3],[4,5,6],[7,8,9]]},{between=[1,1],offset=[0,1,0],biquadratic=0.5}],"
       "anisotropy=[{constant=1,axis=[0,0,2],site=1},{cubic=0.2,axes=[[1,1,0],[1,-1,0]]}]}",
       "torque={slonczewski={damping_like='0.1*t',polarization=[0,2,0]}}"});
  auto const& [lattice, field] = std::tie(scene.lattice, scene.field);
  EXPECT_EQ(lattice.shape, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(lattice.cell, (std::array<Triple, 3>{{{1, 0, 0}, {0.5, 1, 0}, {0, 0, 2}}}));
  EXPECT_EQ(lattice.basis, (std::vector<Triple>{{0, 0, 0}, {0.5, 0.25, 0}}));
  EXPECT_EQ(lattice.moments, (std::vector<double>{1, 0.5}));
  EXPECT_EQ(lattice.gyromagnetic, (std::vector<double>{1.5, 1.5}));
  EXPECT_EQ(lattice.occupied.expression, "i<2");
  EXPECT_EQ(lattice.frozen.expression, "s");
  EXPECT_EQ(sites(scene), 24);
  EXPECT_EQ(couplings(scene), (std::vector<Coupling>{
                                  {{0, 1}, {0, 0, 0}, {2, 3, -2, -3, 2, 1, 2, -1, 2}, 0},
                                  {{0, 0}, {-1, 0, 0}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, 0},
                                  {{1, 1}, {0, 1, 0}, {}, 0.5},
                              }));
  ASSERT_EQ(field.anisotropies.size(), 1U);
  EXPECT_EQ(field.anisotropies[0].axis, (Triple{0, 0, 1}));
  EXPECT_EQ(field.anisotropies[0].site, 1);
  ASSERT_EQ(field.crystal_anisotropies.size(), 1U);
  EXPECT_EQ(field.crystal_anisotropies[0].constant, 0.2);
  EXPECT_NEAR(field.crystal_anisotropies[0].axes[1][1], -std::sqrt(0.5), 1e-15);
  EXPECT_EQ(field.crystal_anisotropies[0].site, -1);
  ASSERT_TRUE(field.torque.slonczewski);
  EXPECT_EQ(std::get<std::string>(field.torque.slonczewski->damping_like), "0.1*t");
  EXPECT_EQ(std::get<double>(field.torque.slonczewski->field_like), 0);
  EXPECT_EQ(field.torque.slonczewski->polarization, (Triple{0, 1, 0}));
  EXPECT_TRUE(depends_on_time(field));
  EXPECT_TRUE(needs_pass(scene));
}

TEST(Crystals, TermsOfOneSiteArrive) {
  auto const scene =
      crystal_with({"lattice={shape=[4,3,2],spacing=0.5}", "field={exchange=1,dmi={bulk=0.3}}",
                    "torque={zhang_li={velocity=[1,'2*t',0],nonadiabaticity=-0.5}}"});
  EXPECT_EQ(scene.field.bulk_dmi.value().constant, 0.3);
  EXPECT_FALSE(scene.field.dmi);
  auto const& zhang_li = scene.field.torque.zhang_li.value();
  EXPECT_EQ(std::get<double>(zhang_li.velocity[0]), 1);
  EXPECT_EQ(std::get<std::string>(zhang_li.velocity[1]), "2*t");
  EXPECT_EQ(zhang_li.nonadiabaticity, -0.5);
  EXPECT_TRUE(depends_on_time(scene.field));
  EXPECT_TRUE(has_torque(scene.field));
}

TEST(Crystals, TorqueOfZerosIsNone) {
  std::string const all_zero = "zhang_li={velocity=[0,-0.0,0],nonadiabaticity=1}";
  std::string const across = "slonczewski={polarization=[0,0,1],damping_like=0,field_like=";
  auto const has = [](std::string const& torque) {
    return has_torque(
        crystal_with({"lattice={shape=[4]}", "field={exchange=1}", "torque={" + torque + "}"})
            .field);
  };
  EXPECT_FALSE(has(all_zero));
  EXPECT_FALSE(has(across + "0}"));
  EXPECT_FALSE(has(all_zero + "," + across + "0}"));
  EXPECT_TRUE(has(all_zero + "," + across + "1e-300}"));
  EXPECT_TRUE(has(across + "'0*t'}"));
  EXPECT_TRUE(has("zhang_li={velocity=[0,0,1e-300]}," + across + "0}"));
}

TEST(Crystals, AnyNewKeyNeedsAPass) {
  std::string const plain = "field={exchange=1,anisotropy={constant=1,axis=[0,0,1]}}";
  EXPECT_FALSE(needs_pass(crystal_with({"lattice={shape=[4]}", plain})));
  for (std::string const key : {"moments=2", "gyromagnetic=1", "occupied='1'", "frozen='0'"})
    EXPECT_TRUE(needs_pass(crystal_with({"lattice={shape=[4]," + key + "}", plain}))) << key;
  for (std::string const key :
       {"couplings=[{offset=[1,0,0],J=1}]", "anisotropy={constant=1,axis=[0,0,1],site=0}",
        "anisotropy={cubic=1,axes=[[1,0,0],[0,0,1]]}"})
    EXPECT_TRUE(needs_pass(crystal_with({"lattice={shape=[4]}", "field={" + key + "}"}))) << key;
  EXPECT_TRUE(needs_pass(
      crystal_with({"lattice={shape=[4]}", plain, "torque={zhang_li={velocity=[1,0,0]}}"})));
}

TEST(Crystals, WordsAreCells) {
  for (auto const& [word, made] : {std::pair{"bcc", Crystal::bcc()},
                                   {"fcc", Crystal::fcc()},
                                   {"hcp", Crystal::hcp()},
                                   {"honeycomb", Crystal::honeycomb()},
                                   {"kagome", Crystal::kagome()},
                                   {"pyrochlore", Crystal::pyrochlore()}}) {
    auto const scene = crystal_with({std::string("lattice.crystal='") + word + "'"});
    auto const read = crystal(scene.lattice);
    ASSERT_EQ(read.basis.size(), made.basis.size()) << word;
    EXPECT_EQ(scene.lattice.shape[2], 2 * static_cast<std::int64_t>(made.basis.size())) << word;
    for (std::size_t site = 0; site < made.basis.size(); ++site) {
      EXPECT_EQ(read.position({1, 2, 3}, site), made.position({1, 2, 3}, site)) << word;
    }
    EXPECT_NO_THROW(made.validate()) << word;
  }
}

// Expects each site to have as many neighbours at the first distances as textbooks say.
TEST(Crystals, ShellsHoldTheNeighboursOfTextbooks) {
  struct Case {
    Crystal crystal;
    std::vector<int> neighbours;
    std::array<bool, 3> repeats = {true, true, true};
  };
  std::array<bool, 3> const film{true, true, false};
  for (auto const& [crystal, neighbours, repeats] :
       {Case{Crystal::simple_cubic(), {6, 12, 8, 6, 24, 24, 12}},
        Case{Crystal::bcc(), {8, 6, 12, 24, 8}}, Case{Crystal::fcc(), {12, 6, 24, 12, 24}},
        Case{Crystal::hcp(), {12, 6, 2, 18, 12}}, Case{Crystal::pyrochlore(), {6, 12, 12}},
        Case{Crystal::honeycomb(), {3, 6, 3, 6, 6}, film}, Case{Crystal::kagome(), {4, 4, 6}, film},
        Case{Crystal::simple_cubic(), {2, 2, 2, 2, 2}, {false, true, false}},
        // A skew cell of the simple cubic crystal
        Case{{{{{1, 0, 0}, {3, 1, 0}, {-5, 2, 1}}}, {{0, 0, 0}}}, {6, 12, 8, 6}}}) {
    std::vector<double> exchange;
    for (std::size_t shell = 0; shell < neighbours.size(); ++shell)
      exchange.push_back(std::ldexp(1.0, static_cast<int>(shell)));
    std::vector<std::vector<int>> found(crystal.basis.size(), std::vector<int>(neighbours.size()));
    for (auto const& coupling : couplings_of_shells(crystal, exchange, repeats)) {
      auto const shell = static_cast<std::size_t>(std::ilogb(coupling.tensor[0]));
      for (int const site : coupling.between) ++found[static_cast<std::size_t>(site)][shell];
    }
    for (auto const& of_site : found) EXPECT_EQ(of_site, neighbours);
  }
}

TEST(Crystals, PairsMayStandFromBothEnds) {
  auto const of = [](std::string const& bonds) {
    return couplings(crystal_with(
        {"lattice={shape=[9,9],basis=[[0,0,0],[0.5,0.5,0]]}", "field={couplings=" + bonds + "}"}));
  };
  auto const once =
      of("[{between=[0,1],J=2,D=[1,2,3]},{offset=[0,1,0],tensor=[[1,2,3],[4,5,6],[7,8,9]],"
         "biquadratic=0.5}]");
  EXPECT_EQ(of("{both_directions=true,pairs=[{between=[0,1],J=2,D=[1,2,3]},{offset=[0,1,0],"
               "tensor=[[1,2,3],[4,5,6],[7,8,9]],biquadratic=0.5},{offset=[0,-1,0],"
               "tensor=[[1,4,7],[2,5,8],[3,6,9]],biquadratic=0.5},"
               "{between=[1,0],J=2,D=[-1,-2,-3]}]}"),
            once);
  EXPECT_EQ(of("{pairs=[{between=[0,1],J=2,D=[1,2,3]},{offset=[0,1,0],tensor=[[1,2,3],[4,5,6],"
               "[7,8,9]],biquadratic=0.5}]}"),
            once);
}

TEST(Crystals, PairsAddToShells) {
  auto const chain = crystal_with({"lattice={shape=[9]}",
                                   "field={couplings={shells=[1,2],pairs=[{offset=[-1,0,0],"
                                   "D=[0,0,3]},{offset=[4,0,0],J=5}]}}"});
  EXPECT_EQ(couplings(chain), (std::vector<Coupling>{Coupling::of({0, 0}, {1, 0, 0}, 1, {0, 0, -3}),
                                                     Coupling::of({0, 0}, {2, 0, 0}, 2),
                                                     Coupling::of({0, 0}, {4, 0, 0}, 5)}));
}

TEST(Crystals, ShellsKnowTheSpacingAndTheAxes) {
  auto const chain =
      crystal_with({"lattice={shape=[9],boundary='periodic'}", "field={couplings={shells=[1,2]}}"});
  EXPECT_EQ(couplings(chain), (std::vector<Coupling>{Coupling::of({0, 0}, {1, 0, 0}, 1),
                                                     Coupling::of({0, 0}, {2, 0, 0}, 2)}));
  auto const rows =
      crystal_with({"lattice={shape=[9,9],spacing=[1,0.25]}", "field={couplings={shells=[1]}}"});
  EXPECT_EQ(couplings(rows), (std::vector<Coupling>{Coupling::of({0, 0}, {0, 1, 0}, 1)}));
}

TEST(Crystals, BondsThatCannotBeListedAreRefused) {
  EXPECT_THROW(couplings_of_shells({{}, {{0, 0, 0}}}, {1}), std::invalid_argument);
  EXPECT_THROW(couplings_of_shells({Crystal{}.cell, {}}, {1}), std::invalid_argument);
  EXPECT_THROW(couplings_of_shells({Crystal{}.cell, {{0, 0, 0}, {1, 0, 0}}}, {1}),
               std::invalid_argument);
  for (double const fraction : {std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(couplings_of_shells({Crystal{}.cell, {{0, fraction, 0}}}, {1}),
                 std::invalid_argument);
  EXPECT_THROW(couplings_of_shells(Crystal::bcc(), {1, 2}, {false, false, false}),
               std::invalid_argument);
  EXPECT_EQ(couplings_of_shells(Crystal::bcc(), {1}, {false, false, false}).size(), 1U);
  Crystal const flat{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1e-9}}}, {{0, 0, 0}}};
  EXPECT_THROW(couplings_of_shells(flat, std::vector<double>(300, 1.0)), std::invalid_argument);
  Crystal const skew{{{{1, 0, 0}, {1e10, 1, 0}, {0, 0, 1}}}, {{0, 0, 0}}};
  EXPECT_THROW(couplings_of_shells(skew, {1}), std::invalid_argument);
}

TEST(Crystals, ShellsOfAThinCellThatDoesNotRepeat) {
  for (double const thickness : {1.0, 5e-4, 1e-8}) {
    Crystal const thin{{{{1, 0, 0}, {0, 1, 0}, {0, 0, thickness}}}, {{0, 0, 0}}};
    EXPECT_EQ(couplings_of_shells(thin, {1}, {true, true, false}).size(), 2U) << thickness;
  }
}

TEST(Crystals, CellsWhosePlanesOverflowAreRefused) {
  std::int64_t const cells = (std::int64_t{1} << 62) + 1;  // of 4 sites: 4 planes modulo 2^64
  EXPECT_THROW(Crystal::fcc().lattice({1, 1, cells}), std::invalid_argument);
}

TEST(Crystals, ExpressionsSeeTheSite) {
  auto const scene = crystal_with({"lattice.occupied='x+y+z<1.2'", "lattice.frozen='k==1 && s==1'",
                                   R"(initial={expression=["1+i+10*x","2+j+10*y","3+k+s+10*z"]})"});
  auto const there = occupied(scene, whole(scene)), still = frozen(scene, whole(scene));
  auto const spins = initial_spins(scene);
  ASSERT_EQ(there.size(), 48U);
  ASSERT_EQ(still.size(), 48U);
  std::size_t at = 0;
  for (int k = 0; k < 2; ++k)
    for (int s = 0; s < 2; ++s)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i, ++at) {
          double const x = (i + 0.5 * s) / 4, y = (j + 0.5 * s) / 3, z = (k + 0.5 * s) / 2;
          EXPECT_EQ(there[at], x + y + z < 1.2) << at;
          EXPECT_EQ(still[at], k == 1 && s == 1) << at;
          Triple const m{1 + i + 10 * x, 2 + j + 10 * y, 3 + k + s + 10 * z};
          double const norm = std::hypot(m[0], m[1], m[2]);
          for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(spins[3 * at + c], there[at] ? m[c] / norm : 0, 1e-15) << at;
        }
  SiteBox const part{{1, 0, 1}, {2, 3, 2}};
  EXPECT_EQ(occupied(scene, part), numbers_in(part, scene.lattice.shape, 1, there));
  EXPECT_EQ(frozen(scene, part), numbers_in(part, scene.lattice.shape, 1, still));
  EXPECT_EQ(initial_spins(scene, part), numbers_in(part, scene.lattice.shape, 3, spins));
  EXPECT_TRUE(occupied(crystal_with({}), whole(scene)).empty());
}

TEST(Crystals, ExpressionsThatFailAreNamed) {
  auto const later = [](std::vector<std::string> const& overrides) {
    auto const scene = crystal_with(overrides);
    return refusal([&] {
      check_files(scene);
      occupied(scene, whole(scene));
      frozen(scene, whole(scene));
      initial_spins(scene);
    });
  };
  expect_holds(later({"lattice.frozen='1/(s-1)'"}),
               ": lattice.frozen: expression \"1/(s-1)\" is not finite at x = ");
  expect_holds(later({"lattice.occupied='x>2'"}), ": lattice.occupied: leaves no spin; accepted: ");
  expect_holds(later({"lattice.occupied='1'", "lattice.moments='0'"}),
               ": lattice.moments: leaves no spin; accepted: ");
  expect_holds(later({"lattice.occupied='i==0'", "lattice.moments='i'"}),
               ": lattice.moments: leaves no spin; accepted: ");
  expect_holds(later({"lattice.occupied='0'", "lattice.moments='1'"}),
               ": lattice.occupied: leaves no spin; accepted: ");
  expect_holds(later({R"(initial={expression=["0","0","k-1+s"]})"}),
               "the spin of site 1 of cell (0, 0, 0) is (0, 0, 0)");
  // The expression may be zero on sites without a spin.
  EXPECT_EQ(later({"lattice.occupied='k==1'", R"(initial={expression=["0","0","k"]})"}),
            "accepted");
}

// Returns numbers for `frames` frames of 48 sites, which vary so that a value read from a wrong
// place shows.
std::vector<double> numbered(std::size_t frames) {
  std::vector<double> numbers(frames * 144);
  for (std::size_t n = 0; n < numbers.size(); ++n) numbers[n] = 1 + static_cast<double>(n * n % 89);
  return numbers;
}

TEST(Crystals, StartsFromFilesHaveSitesBeforePlanes) {
  Folder const folder;
  write_dataset(folder / "state.h5", "/spins", {2, 2, 3, 4, 3}, numbered(1));
  write_dataset(folder / "frames.h5", "/spins", {3, 2, 2, 3, 4, 3}, numbered(3));
  for (auto const& [file, frame] : {std::pair{"state.h5", 0}, {"frames.h5", 2}}) {
    auto const scene = crystal_from(folder, file);
    check_files(scene);
    auto const spins = initial_spins(scene);
    auto const numbers = numbered(3);
    for (std::size_t site = 0; site < 2; ++site)
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t n = 0; n < 12; ++n) {
          auto const* const m =
              numbers.data() +
              3 * (((static_cast<std::size_t>(frame) * 2 + site) * 2 + k) * 12 + n);
          double const norm = std::hypot(m[0], m[1], m[2]);
          for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(spins[3 * ((2 * k + site) * 12 + n) + c], m[c] / norm, 1e-15);
        }
    for (SiteBox const part : {SiteBox{{1, 1, 1}, {2, 2, 2}}, SiteBox{{0, 0, 3}, {4, 3, 1}},
                               SiteBox{{3, 0, 0}, {1, 1, 3}}, SiteBox{{0, 0, 2}, {4, 3, 0}}})
      EXPECT_EQ(initial_spins(scene, part), numbers_in(part, scene.lattice.shape, 3, spins));
  }
}

TEST(Crystals, StartsFromOtherFilesAreRefused) {
  Folder const folder;
  write_dataset(folder / "planes.h5", "/spins", {4, 3, 4, 3}, numbered(1));
  write_dataset(folder / "empty.h5", "/spins", {0, 2, 2, 3, 4, 3}, {});
  OvfField field;
  field.mesh.nodes = {4, 3, 4};
  field.values = numbered(1);
  write_ovf(folder / "state.ovf", field, OvfFormat::binary8, false);
  for (auto const& [file, what] :
       {std::pair{"planes.h5",
                  "its extents are (4, 3, 4, 3); accepted: (2, 2, 3, 4, 3) or (frame, "
                  "2, 2, 3, 4, 3)"},
        {"empty.h5", "it holds no frame"},
        {"state.ovf", "OVF has one spin per cell, and lattice.basis has 2; accepted: HDF5"}}) {
    auto const scene = crystal_from(folder, file);
    for (auto const& message :
         {refusal([&] { check_files(scene); }), refusal([&] { initial_spins(scene); })}) {
      expect_holds(message, ": initial.file: ");
      expect_holds(message, what);
    }
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
