// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Unit-cell files of Vampire: iron as in Vampire's examples, and a honeycomb with tensors as other
// programs write it.
#include "scene_file.hpp"

#include <cmath>
#include <random>
#include <sstream>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string text_of(std::string const& name) {
  std::ostringstream text;
  text << std::ifstream(std::string(CAYSPIN_TEST_DATA "/") + name).rdbuf();
  return text.str();
}

std::string scene_with(std::string const& lattice, std::string const& couplings) {
  return replaced(plain_scene, "[4, 3, 2]", "[4, 3, 2]\n" + lattice) + "[field]\ncouplings = { " +
         couplings + " }\n";
}

Scene read_with(Folder const& folder, std::string const& unit_cell, std::string const& lattice = {},
                std::string const& more = {}) {
  folder.write(unit_cell, "cell.ucf");
  return read_text(folder, scene_with(lattice, "file = \"cell.ucf\"" + more));
}

TEST(UnitCellFile, IronHasEightNeighbours) {
  Folder const folder;
  for (std::string const lattice :
       {"", "crystal = \"bcc\"", "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]"}) {
    auto const scene = read_with(folder, text_of("bcc_iron.ucf"), lattice, ", scale = 1e21");
    EXPECT_EQ(scene.lattice.shape, (std::array<std::int64_t, 3>{4, 3, 4})) << lattice;
    EXPECT_EQ(scene.lattice.basis, (std::vector<Triple>{{0, 0, 0}, {0.5, 0.5, 0.5}})) << lattice;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        EXPECT_NEAR(scene.lattice.cell[i][j], i == j ? 1 : 0, 1e-15) << lattice;
    auto const bonds = couplings(scene);
    ASSERT_EQ(bonds.size(), 8U) << lattice;
    for (auto const& bond : bonds) {
      EXPECT_EQ(bond.between, (std::array<int, 2>{0, 1}));
      for (int const cells : bond.offset) EXPECT_TRUE(cells == 0 || cells == -1);
      for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(bond.tensor[i], i % 4 == 0 ? 7.05 : 0, 1e-14);
      EXPECT_EQ(bond.biquadratic, 0);
    }
    EXPECT_NO_THROW(check_files(scene));
  }
}

TEST(UnitCellFile, TensorsKeepTheirSense) {
  Folder const folder;
  auto const scene = read_with(folder, text_of("honeycomb_with_dmi.ucf"));
  auto const& cell = scene.lattice.cell;
  EXPECT_NEAR(cell[1][0], -0.5, 1e-6);
  EXPECT_NEAR(cell[1][1], std::sqrt(0.75), 1e-6);
  EXPECT_NEAR(cell[2][2], 20 / 6.867, 1e-6);
  auto const bonds = couplings(scene);
  ASSERT_EQ(bonds.size(), 9U);
  int chiral = 0;
  for (auto const& bond : bonds) {
    double const J = bond.between[0] == bond.between[1] ? 1e-22 : 4.5e-22;
    EXPECT_NEAR(bond.tensor[0], J, 1e-30);
    EXPECT_NEAR(bond.tensor[8], 1.03 * J, 1e-30);
    if (bond.between[0] != bond.between[1]) continue;
    // D is positive along (1, 0), (0, 1) and (-1, -1) for site 0, and has the opposite sign for
    // site 1.
    auto const& [i, j, k] = bond.offset;
    bool const forward = (i == 1 && j == 0) || (i == 0 && j == 1) || (i == -1 && j == -1);
    double const sign = (forward ? 1 : -1) * (bond.between[0] == 0 ? 1 : -1);
    EXPECT_NEAR(bond.tensor[1], sign * 2.5e-23, 1e-31);
    EXPECT_NEAR(bond.tensor[3], -sign * 2.5e-23, 1e-31);
    ++chiral;
  }
  EXPECT_EQ(chiral, 6);
}

constexpr std::string_view chain_cell =
    "# a chain\n"
    "1 1 1\n"
    "1 0 0\n0 1 0\n0 0 1\n"
    "1 1\n"
    "0 0 0 0 0\n"
    "2 isotropic\n"
    "0 0 0 1 0 0 2.5\n"
    "1 0 0 -1 0 0 2.5\n";

TEST(UnitCellFile, MayBeWrittenInOtherWays) {
  Folder const folder;
  auto const expected = couplings(read_with(folder, std::string(chain_cell)));
  ASSERT_EQ(expected, (std::vector<Coupling>{Coupling::of({0, 0}, {-1, 0, 0}, 2.5)}));
  for (auto const& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"# a chain\n", ""},
           {"# a chain\n", "\n   # other\n\n"},
           {"2 isotropic", "2 isotropic # bonds"},
           {"2 isotropic", "2 0"},
           {"2 isotropic", "\t2 ,isotropic\r"},
           {"0 0 0 1 0 0 2.5", "17 0 0 +1 0.0 0 2.5e0"},
           {"0 0 0 0 0\n", "1 0 0 0\n"},
           {"0 0 0 0 0\n", "1 0 0 0 0 0 0\n"},
           {"-1 0 0 2.5\n", "-1 0 0 2.5"},
           {"2 isotropic\n0 0 0 1 0 0 2.5\n1 0 0 -1 0 0 2.5",
            "2 vectorial\n0 0 0 1 0 0 2.5 2.5 2.5\n1 0 0 -1 0 0 2.5 2.5 2.5"},
           {"2 isotropic\n0 0 0 1 0 0 2.5\n1 0 0 -1 0 0 2.5",
            "2 2\n0 0 0 1 0 0 2.5 0 0 0 2.5 0 0 0 2.5\n1 0 0 -1 0 0 2.5 0 0 0 2.5 0 0 0 2.5"}})
    EXPECT_EQ(couplings(read_with(folder, replaced(chain_cell, from, to))), expected) << to;
}

TEST(UnitCellFile, MayHaveBiquadraticBonds) {
  Folder const folder;
  auto const scene = read_with(folder,
                               std::string(chain_cell) +
                                   "# biquadratic\n4 isotropic\n0 0 0 1 0 0 0.5\n"
                                   "1 0 0 -1 0 0 0.5\n2 0 0 0 1 0 0.25\n"
                                   "3 0 0 0 -1 0 0.25\n",
                               "", ", scale = 2");
  auto expected = std::vector<Coupling>{Coupling::of({0, 0}, {-1, 0, 0}, 5),
                                        Coupling::of({0, 0}, {0, -1, 0}, 0)};
  expected[0].biquadratic = 1;
  expected[1].biquadratic = 0.5;
  EXPECT_EQ(couplings(scene), expected);
}

/// Returns the part of a refusal that follows the place in the scene and the name of the file;
/// "accepted" if there is none.
std::string refusal_of_cell(Folder const& folder, std::string const& unit_cell,
                            std::string const& lattice = {}, std::string const& more = {}) {
  auto const message = refusal([&] { check_files(read_with(folder, unit_cell, lattice, more)); });
  if (message == "accepted") return message;
  auto const begin = (folder / "scene.toml").string() +
                     ":14: field.couplings.file: " + (folder / "cell.ucf").string() + ':';
  EXPECT_TRUE(message.starts_with(begin)) << message;
  return message.substr(std::min(begin.size(), message.size()));
}

constexpr std::string_view biquadratic_bonds = "0 0 0 1 0 0 0.5\n1 0 0 -1 0 0 0.5\n";

TEST(UnitCellFile, NormalisedNumbersAreMultipliedByTheScale) {
  Folder const folder;
  auto const isotropic = replaced(chain_cell, "2 isotropic", "2 normalised-isotropic");
  auto const vectorial =
      replaced(replaced(replaced(chain_cell, "2 isotropic", "2 normalised-vectorial"), "1 0 0 2.5",
                        "1 0 0 2.5 2.5 2.5"),
               "-1 0 0 2.5", "-1 0 0 2.5 2.5 2.5");
  auto const tensorial =
      replaced(replaced(replaced(chain_cell, "2 isotropic", "2 normalised-tensorial"), "-1 0 0 2.5",
                        "-1 0 0 2.5 0 0 0 2.5 0 0 0 2.5"),
               "1 0 0 2.5\n", "1 0 0 2.5 0 0 0 2.5 0 0 0 2.5\n");
  for (auto const& cell : {isotropic, vectorial, tensorial, isotropic + "0 normalised-isotropic\n"})
    EXPECT_EQ(couplings(read_with(folder, cell, "", ", scale = 2")),
              (std::vector<Coupling>{Coupling::of({0, 0}, {-1, 0, 0}, 5)}))
        << cell;
  EXPECT_EQ(refusal_of_cell(folder, isotropic),
            "8: numbers of \"normalised-isotropic\" are relative to exchange-matrix of the .mat "
            "file; accepted: field.couplings.scale = that energy, or energies in J");
  EXPECT_NE(refusal_of_cell(folder, vectorial), "accepted");
  EXPECT_NE(refusal_of_cell(folder, tensorial), "accepted");
}

// In Vampire, exchange-matrix has an energy for each pair of materials, and does not multiply
// numbers off the diagonal; biquadratic numbers have an energy of their own.
TEST(UnitCellFile, NormalisedNumbersOfSeveralEnergiesAreRefused) {
  Folder const folder;
  std::string const scale = ", scale = 2";
  auto const isotropic = replaced(chain_cell, "2 isotropic", "2 normalised-isotropic");
  for (auto const& more : {"2 isotropic\n", "2 normalised-isotropic\n"})
    EXPECT_TRUE(
        refusal_of_cell(folder, isotropic + more + std::string(biquadratic_bonds), "", scale)
            .starts_with("11: has biquadratic interactions in a file with normalised"));
  EXPECT_TRUE(refusal_of_cell(folder,
                              std::string(chain_cell) + "2 normalised-isotropic\n" +
                                  std::string(biquadratic_bonds),
                              "", scale)
                  .starts_with("11: has biquadratic interactions in a file with normalised"));
  auto const tensorial = replaced(
      replaced(text_of("honeycomb_with_dmi.ucf"), "18 tensorial", "18 normalised-tensorial"),
      "0 0.3333333333333333 0.6666666666666667 0.5 0",
      "0 0.3333333333333333 0.6666666666666667 0.5");
  EXPECT_TRUE(
      refusal_of_cell(folder, tensorial, "", scale)
          .starts_with("19: has normalised numbers off the diagonal, which Vampire ignores"));
  auto const of_two = replaced(text_of("bcc_iron.ucf"), "0.5\t0\t0\t1", "0.5\t1\t0\t1");
  EXPECT_EQ(refusal_of_cell(folder, of_two, "", scale), "accepted");
  EXPECT_EQ(
      refusal_of_cell(folder, replaced(of_two, "isotropic", "normalised-isotropic"), "", scale),
      "12: numbers of \"normalised-isotropic\" are relative to exchange-matrix of the .mat "
      "file, which may differ between pairs of the 2 materials; accepted: one material, or "
      "energies in J");
}

// The scene's text contains the cell: a trajectory stores the text, and may be moved away from the
// file of the cell.
TEST(UnitCellFile, TextOfTheSceneHasTheCell) {
  Folder const folder;
  auto const scene = read_with(folder, text_of("honeycomb_with_dmi.ucf"));
  auto const bonds = couplings(scene);
  std::filesystem::remove(folder / "cell.ucf");
  auto const again = parse_scene(scene.text, folder / "run.h5");
  EXPECT_EQ(again.lattice.cell, scene.lattice.cell);
  EXPECT_EQ(again.lattice.basis, scene.lattice.basis);
  EXPECT_EQ(again.lattice.shape, scene.lattice.shape);
  EXPECT_EQ(again.text, scene.text);
  EXPECT_THROW(couplings(again), SceneError);
  folder.write(text_of("honeycomb_with_dmi.ucf"), "cell.ucf");
  EXPECT_EQ(couplings(again), bonds);
  EXPECT_EQ(couplings(with_overrides(scene, {"integrator.dt=0.02"})), bonds);
}

TEST(UnitCellFile, WrongLinesAreNamed) {
  Folder const folder;
  struct Case {
    std::string from, to, message;
  };
  for (auto const& [from, to, message] : std::vector<Case>{
           {"1 1 1\n", "1 1\n", "2: has 2 words; accepted: the three lengths of a cell"},
           {"1 1 1\n", "1 one 1\n", "2: \"one\" is not a finite number"},
           {"1 1 1\n", "1 1 nan\n", "2: \"nan\" is not a finite number"},
           {"1 1 1\n", "1 1 1e999\n", "2: \"1e999\" is not a finite number"},
           {"1 1 1\n", "1 0 1\n", "5: the cell has no volume"},
           {"0 1 0\n", "1 0 0\n", "5: the cell has no volume"},
           {"1 1\n0 0", "0 1\n0 0", "6: 0 is not a whole number from 1 to 32767"},
           {"1 1\n0 0", "1.5 1\n0 0", "6: 1.5 is not a whole number"},
           {"1 1\n0 0", "2 1\n0 0 0 0\n0 0", "8: atoms 0 and 1 are at one place"},
           {"1 1\n0 0", "99999999999 1\n0 0", "6: 99999999999 is not a whole number"},
           {"0 0 0 0 0\n", "0 0 0\n",
            "7: has 3 words; accepted: \"number x y z ..\" for each of 1 atom"},
           {"2 isotropic", "2 isotropisch",
            "8: \"isotropisch\" is no kind of exchange; accepted: "
            "isotropic, vectorial, tensorial"},
           {"2 isotropic", "2 3", "8: \"3\" is no kind of exchange"},
           {"2 isotropic", "2",
            "8: has no kind of exchange after the number of interactions; accepted: isotropic, "
            "vectorial or tensorial for numbers in J, normalised-.. for"},
           {"2 isotropic", "-2 isotropic", "8: -2 is not a whole number from 0"},
           {"2 isotropic", "1 isotropic",
            "9: the bond from atom 0 to atom 0 of the cell (1, 0, 0) "
            "away is not given from its other end"},
           {"2 isotropic", "3 isotropic", "10: ends before the last of 3 interactions"},
           {"2 isotropic", "2 tensorial",
            "9: has 7 words; accepted: \"number i j dx dy dz\" and 9 numbers of J for each of 2 "
            "interactions"},
           {"1 0 0 2.5\n1", "1 0 0 2.5 0 0\n1",
            "9: has 9 words; accepted: \"number i j dx dy dz\" and 1 number of J "},
           {"0 0 0 1 0 0 2.5", "0 0 1 1 0 0 2.5", "9: 1 is not a whole number from 0 to 0"},
           {"0 0 0 1 0 0 2.5", "0 -1 0 1 0 0 2.5", "9: -1 is not a whole number from 0 to 0"},
           {"0 0 0 1 0 0 2.5", "0 0 0 0 0 0 2.5", "9: couples atom 0 to itself"},
           {"0 0 0 1 0 0 2.5", "0 0 0 0.5 0 0 2.5", "9: 0.5 is not a whole number"},
           {"0 0 0 1 0 0 2.5", "0 0 0 1e9 0 0 2.5", "9: 1e9 is not a whole number from -1000000"},
           {"0 0 0 1 0 0 2.5", "0 0 0 1 0 0 2.5x", "9: \"2.5x\" is not a finite number"},
           {"-1 0 0 2.5", "1 0 0 2.5",
            "10: the bond from atom 0 to atom 0 of the cell (1, 0, 0) "
            "away occurs twice"},
           {"-1 0 0 2.5", "-1 0 0 2.4",
            "10: the bond from atom 0 to atom 0 of the cell (-1, 0, 0) "
            "away is 2.4 there and 2.5 from its other end"},
           {"-1 0 0 2.5", "-1 0 0 2.5\n2 0 0 0 1 0 1",
            "11: comes after the last of 2 interactions"},
           {"-1 0 0 2.5", "-1 0 0 2.5\n2 tensorial", "11: biquadratic interactions that are not "},
           {"-1 0 0 2.5", "-1 0 0 2.5\n0 isotropic\nmore",
            "12: comes after the last of 0 interactions"},
           {"# a chain", std::string(5000, 'x'), "1: is longer than 4096 characters"}}) {
    auto const refused = refusal_of_cell(folder, replaced(chain_cell, from, to));
    EXPECT_TRUE(refused.starts_with(message)) << to << '\n' << refused << '\n' << message;
  }
  EXPECT_TRUE(refusal_of_cell(folder, "").starts_with(" ends before the three lengths"));
}

TEST(UnitCellFile, SitesAreThoseOfTheScene) {
  Folder const folder;
  auto const iron = text_of("bcc_iron.ucf");
  EXPECT_EQ(refusal_of_cell(folder, iron, "crystal = \"fcc\""),
            "10: has 2 atoms in a cell; accepted: 4, as lattice.basis");
  EXPECT_EQ(refusal_of_cell(folder, iron, "basis = [[0, 0, 0], [0.5, 0.5, 0.5002]]"),
            "10: atom 1 is at (0.5, 0.5, 0.5); accepted: (0.5, 0.5, 0.5002), as in lattice.basis");
  EXPECT_EQ(refusal_of_cell(folder, iron, "basis = [[0, 0, 0], [0.5, 0.5, 0.50009]]"), "accepted");
  // In another cell of the same crystal, bonds have other offsets.
  EXPECT_NE(refusal_of_cell(folder, iron, "basis = [[0, 0, 0], [0.5, 0.5, -0.5]]"), "accepted");
}

TEST(UnitCellFile, ThatIsNotThereIsNamed) {
  Folder const folder;
  for (std::string const name : {"none.ucf", "."}) {
    auto const file = "file = \"" + name + "\"";
    auto const message = refusal([&] { read_text(folder, scene_with("", file)); });
    EXPECT_TRUE(message.ends_with(": field.couplings.file: " + (folder / name).string() +
                                  ": cannot be read"))
        << message;
    auto const scene = read_text(folder, scene_with("crystal = \"bcc\"", file));
    EXPECT_THROW(check_files(scene), SceneError);
    EXPECT_THROW(couplings(scene), SceneError);
  }
}

// A damaged file is read or refused in one line.
TEST(UnitCellFile, DamagedFilesAreReadOrRefused) {
  Folder const folder;
  std::mt19937 random(1);
  auto const below = [&](std::size_t end) { return random() % end; };
  int refused = 0;
  for (auto const& original :
       {text_of("bcc_iron.ucf"), text_of("honeycomb_with_dmi.ucf"), std::string(chain_cell)})
    for (int trial = 0; trial < 100; ++trial) {
      auto text = original;
      for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
        auto const at = below(text.size());
        switch (below(5)) {
          case 0:
            text[at] = static_cast<char>(below(256));
            break;
          case 1:
            text.erase(at, 1 + below(20));
            break;
          case 2:
            text.insert(at, text.substr(below(text.size()), below(30)));
            break;
          case 3:
            text.resize(at + 1);
            break;
          default:
            text[at] = "0123456789.-+e \n#"[below(17)];
        }
      }
      refused += refusal_of_cell(folder, text) != "accepted";
    }
  EXPECT_GT(refused, 150);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
