// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Zero vectors in the file of initial spins: other programs write them for empty sites.
#include "hdf5_file.hpp"
#include "io/notes.hpp"
#include "io/ovf.hpp"
#include "scene_file.hpp"

#include <random>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string const film_from_file = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [4, 3, 2]
[field]
exchange = 1
[initial]
file = "FILE"
[integrator]
method = "heun"
dt = 0.1
steps = 1
)toml";

/// Returns vectors for 24 sites, zero where `there` is 0.
std::vector<double> disc(std::vector<unsigned char> const& there) {
  std::vector<double> values(72);
  for (std::size_t site = 0; site < 24; ++site)
    if (there[site]) {
      values[3 * site] = 3 + static_cast<double>(site);
      values[3 * site + 2] = -4;
    }
  return values;
}

void write(Folder const& folder, std::string const& name, std::vector<double> const& values) {
  if (name.ends_with(".ovf")) {
    OvfField field;
    field.mesh.nodes = {4, 3, 2};
    field.values = values;
    write_ovf(folder / name, field, OvfFormat::text, true);
  } else {
    write_dataset(folder / name, "/spins", {2, 3, 4, 3}, values);
  }
}

Scene read(Folder const& folder, std::string const& file,
           std::vector<std::string> const& overrides = {}) {
  return with_shape_of_start(read_text(folder, replaced(film_from_file, "FILE", file), overrides));
}

TEST(StartShape, IsWhereTheFileHasSpins) {
  std::mt19937_64 random(5);
  for (std::string const name : {"disc.ovf", "disc.h5"})
    for (int round = 0; round < 10; ++round) {
      Folder const folder;
      std::vector<unsigned char> there(24);
      for (auto& each : there) each = random() % 3 > 0;
      there[0] = 0;
      there[1] = 1;
      auto const values = disc(there);
      write(folder, name, values);
      auto const scene = read(folder, name);
      check_files(scene);
      EXPECT_TRUE(needs_pass(scene));
      EXPECT_EQ(occupied(scene, whole(scene)), there) << name;
      auto const spins = initial_spins(scene);
      for (std::size_t site = 0; site < 24; ++site)
        EXPECT_NEAR(spins[3 * site] * spins[3 * site] + spins[3 * site + 2] * spins[3 * site + 2],
                    there[site], 1e-15);
      auto const said = notes(scene);
      ASSERT_EQ(said.size(), 1U);
      auto const vacant = std::to_string(std::count(there.begin(), there.end(), 0));
      expect_holds(said[0],
                   "initial.file: zero vectors are sites without a spin, " + vacant + " of 24");
      // The scene's text contains the shape, so reading the text again gives an equal scene.
      auto const again = parse_scene(scene.text, scene.path);
      EXPECT_EQ(occupied(again, whole(again)), there);
      EXPECT_EQ(initial_spins(again), spins);
    }
}

TEST(StartShape, IsWholeWithoutZeros) {
  Folder const folder;
  write(folder, "full.ovf", disc(std::vector<unsigned char>(24, 1)));
  auto const scene = read(folder, "full.ovf");
  EXPECT_FALSE(scene.lattice.occupied.there());
  EXPECT_FALSE(needs_pass(scene));
  EXPECT_EQ(scene.text, replaced(film_from_file, "FILE", "full.ovf"));
  auto const typed = notes(read(folder, "full.ovf", {"lattice.occupied={file='full.ovf'}"}));
  ASSERT_EQ(typed.size(), 1U);
  expect_holds(typed[0], "lattice.occupied: is 0 nowhere");
}

TEST(StartShape, HasTheZerosOfTheFileAlone) {
  Folder const folder;
  std::vector<unsigned char> there(24, 1);
  there[3] = 0;
  write(folder, "disc.ovf", disc(there));
  auto const said = notes(read(folder, "disc.ovf", {"lattice.moments='i'"}));
  ASSERT_EQ(said.size(), 1U);
  expect_holds(said[0], "initial.file: zero vectors are sites without a spin, 1 of 24");
}

TEST(StartShape, HasToBeThatOfTheScene) {
  Folder const folder;
  std::vector<unsigned char> there(24, 1);
  there[0] = there[7] = there[13] = 0;
  write(folder, "disc.ovf", disc(there));
  auto const start_of = [&](std::string const& occupied) {
    return refusal([&] {
      auto const scene = read(folder, "disc.ovf", {"lattice.occupied=" + occupied});
      check_files(scene);
      initial_spins(scene);
    });
  };
  EXPECT_EQ(start_of("'i+4*j+12*k == 0 || i+4*j+12*k == 7 || i+4*j+12*k == 13 ? 0 : 1'"),
            "accepted");
  EXPECT_EQ(start_of("'i == 2'"), "accepted");  // the file has more spins
  auto const said = start_of("'i < 2'");
  expect_holds(said, "initial.file: is zero on 2 of the 12 sites that lattice.occupied fills");
  expect_holds(said, "lattice.occupied = { file = \"disc.ovf\" }");
  EXPECT_EQ(start_of("{file='disc.ovf'}"), "accepted");
}

TEST(StartShape, MayBeThatOfAnotherFileOfSpins) {
  Folder const folder;
  std::vector<unsigned char> there(24, 1);
  there[3] = there[20] = 0;
  for (std::string const name : {"disc.ovf", "disc.h5"}) {
    write(folder, name, disc(there));
    auto const scene =
        read_text(folder, replaced(film_from_file, "file = \"FILE\"", "uniform = [0, 0, 1]"),
                  {"lattice.occupied={file='" + name + "'}"});
    check_files(scene);
    EXPECT_EQ(occupied(scene, whole(scene)), there);
  }
}

TEST(StartShape, IsRefusedWithoutASpinOrWithANumberThatIsNotFinite) {
  Folder const folder;
  write(folder, "nothing.ovf", std::vector<double>(72));
  expect_holds(refusal([&] { initial_spins(read(folder, "nothing.ovf")); }), "(0, 0, 0)");
  auto values = disc(std::vector<unsigned char>(24, 1));
  values[5] = std::numeric_limits<double>::quiet_NaN();
  write_dataset(folder / "nan.h5", "/spins", {2, 3, 4, 3}, values);
  expect_holds(refusal([&] { initial_spins(read(folder, "nan.h5")); }), "nan");
}

TEST(StartShape, NeedsAMethodThatKnowsVacancies) {
  Folder const folder;
  std::vector<unsigned char> there(24, 1);
  there[5] = 0;
  write(folder, "disc.h5", disc(there));
  expect_holds(refusal([&] { read(folder, "disc.h5", {"integrator.method='red_black2'"}); }),
               "integrator.method");
}

// The dataset of a crystal has the extents (site, nz, ny, nx, 3).
TEST(StartShape, OfACrystalIsThatOfItsSites) {
  Folder const folder;
  std::vector<double> values(3 * 2 * 24, 1.0);
  for (std::size_t c = 0; c < 3; ++c) values[3 * 24 + c] = 0;  // site 1 of the first cell
  write_dataset(folder / "bcc.h5", "/spins", {2, 2, 3, 4, 3}, values);
  auto const scene = read(folder, "bcc.h5", {"lattice.crystal='bcc'", "field={}"});
  auto const there = occupied(scene, whole(scene));
  ASSERT_EQ(there.size(), 48U);
  for (std::size_t site = 0; site < 48; ++site) EXPECT_EQ(there[site], site == 12 ? 0 : 1);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
