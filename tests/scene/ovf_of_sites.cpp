// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Site-dependent values from OVF files of one component.
#include "io/ovf.hpp"
#include "scene_file.hpp"

#include <cmath>
#include <sstream>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string const film_scene = std::string(plain_scene) + "[field]\nexchange = 1\n";

// Writes one value for each node.
void write_scalar_ovf(std::filesystem::path const& path, std::string const& nodes,
                      std::vector<double> const& values) {
  std::istringstream counts(nodes);
  std::ofstream file(path);
  file << "# OOMMF OVF 2.0\n# meshtype: rectangular\n# valuedim: 1\n";
  for (std::string const axis : {"x", "y", "z"}) {
    int count = 0;
    counts >> count;
    file << "# " << axis << "nodes: " << count << '\n';
  }
  file << "# Begin: Data Text\n";
  for (double const value : values) file << value << '\n';
  file << "# End: Data Text\n";
}

std::string refusal_of_files(Folder const& folder, std::string const& text) {
  return refusal([&] {
    auto const scene = read_text(folder, text);
    check_files(scene);
    numbers_of_sites(scene, scene.field.exchange_factors, "field.exchange", whole(scene));
  });
}

TEST(OvfOfSites, HoldsNumbersAndSaysWhereSpinsAre) {
  Folder const folder;
  std::vector<double> stored, mask;
  for (int n = 0; n < 24; ++n) {
    stored.push_back(1 + n * n % 17);
    mask.push_back(n % 5 == 0 ? 0 : 2);
  }
  write_scalar_ovf(folder / "film.ovf", "4 3 2", stored);
  write_scalar_ovf(folder / "mask.ohf", "4 3 2", mask);
  OvfField spins;
  spins.mesh.nodes = {4, 3, 2};
  for (double const value : mask) spins.values.insert(spins.values.end(), {0, value, 0});
  write_ovf(folder / "spins.omf", spins, OvfFormat::binary4, false);

  auto const film =
      read_text(folder, replaced(film_scene, "exchange = 1", "exchange = { file = 'film.ovf' }"));
  check_files(film);
  auto const& numbers = film.field.exchange_factors;
  EXPECT_EQ(numbers_of_sites(film, numbers, "field.exchange", whole(film)), stored);
  SiteBox const part{{1, 0, 1}, {3, 2, 1}};
  EXPECT_EQ(numbers_of_sites(film, numbers, "field.exchange", part),
            numbers_in(part, {4, 3, 2}, 1, stored));
  for (std::string const file : {"mask.ohf", "spins.omf"}) {
    auto const scene =
        read_text(folder, replaced(film_scene, "shape = [4, 3, 2]",
                                   "shape = [4, 3, 2]\noccupied = { file = '" + file + "' }"));
    check_files(scene);
    auto const there = occupied(scene, whole(scene));
    for (std::size_t site = 0; site < 24; ++site) EXPECT_EQ(there[site], site % 5 != 0) << file;
  }
}

TEST(OvfOfSites, ThatIsWrongIsRefusedInOneLine) {
  Folder const folder;
  write_scalar_ovf(folder / "film.ovf", "4 3 2", std::vector<double>(24, 1));
  write_scalar_ovf(folder / "shape.ovf", "3 4 2", std::vector<double>(24, 1));
  write_scalar_ovf(folder / "short.ovf", "4 3 2", std::vector<double>(23, 1));
  write_scalar_ovf(folder / "nan.ovf", "4 3 2", std::vector<double>(24, std::nan("")));
  OvfField spins;
  spins.mesh.nodes = {4, 3, 2};
  spins.values.assign(72, 1);
  write_ovf(folder / "spins.ovf", spins, OvfFormat::text, false);
  folder.write(
      "# OOMMF: rectangular mesh v1.0\n# meshtype: rectangular\n# xnodes: 4\n"
      "# ynodes: 3\n# znodes: 2\n# Begin: Data Text\n",
      "old.ovf");
  for (auto const& [file, what] :
       {std::pair{"none.ovf", "cannot open the file: No such file or directory"},
        {"shape.ovf", "its mesh has 3 x 4 x 2 nodes; accepted: 4 x 3 x 2, the lattice's"},
        {"short.ovf", "it is truncated: its header says 4 x 3 x 2 nodes of one value"},
        {"nan.ovf", "a value is not finite; accepted: finite numbers"},
        {"spins.ovf", "valuedim is \"3\"; accepted: 1"},
        {"old.ovf", "OVF 1.0 has three values in a node; accepted: OVF 2.0 with valuedim 1"}}) {
    SCOPED_TRACE(file);
    auto const message = refusal_of_files(
        folder,
        replaced(film_scene, "exchange = 1", "exchange = { file = '" + std::string(file) + "' }"));
    expect_holds(message, what);
    expect_holds(message, ": field.exchange: ");
  }
  auto const bcc = replaced(film_scene, "shape = [4, 3, 2]", "shape = [4, 3, 2]\ncrystal = 'bcc'");
  expect_holds(refusal_of_files(folder, replaced(bcc, "exchange = 1",
                                                 "anisotropy = { constant = { file = 'film.ovf' }, "
                                                 "axis = [0, 0, 1] }")),
               "OVF has one value per cell, and lattice.basis has 2; accepted: HDF5");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
