// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Positions of a crystal's sites in files.
#include "io/relax.hpp"
#include "simulation/run_files.hpp"
#include "simulation/scene_minimizer.hpp"
#include "simulation/text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

TEST(Positions, AreOfCrystalsAlone) {
  io::Scene scene;
  scene.lattice.shape = {3, 2, 2};
  EXPECT_TRUE(run_output_options(scene, false).positions.empty());
  scene.lattice.cell[0] = {2, 0, 0};
  EXPECT_EQ(run_output_options(scene, false).positions.size(), 36u);
}

TEST(Positions, AreThoseOfCellsAndBasisInTheUnitsOfTheScene) {
  io::Scene scene;
  scene.units.length = 0.5;
  scene.lattice.shape = {2, 3, 4};  // two planes of cells
  scene.lattice.spacing = {2, 4, 8};
  scene.lattice.cell = {{{1, 0, 0}, {0.5, 1, 0}, {0, 0.25, 1}}};
  scene.lattice.basis = {{0, 0, 0}, {0.5, 0.25, 0.75}};
  auto const options = run_output_options(scene, false);
  EXPECT_EQ(run_header(scene, Precision::double_precision, "", 1, "").cell_sites, 2);
  std::vector<double> expected;
  for (double const site : {0, 1})
    for (double const k : {0, 1})
      for (double const j : {0, 1, 2})
        for (double const i : {0, 1}) {
          double const a = i + 0.5 * site, b = j + 0.25 * site, c = k + 0.75 * site;
          expected.insert(expected.end(), {a + 0.5 * b, 2 * (b + 0.25 * c), 4 * c});
        }
  EXPECT_EQ(options.positions, expected);
}

TEST(Positions, StandOnceInTheFileOfSeveralEquilibria) {
  auto const bytes_of = [](std::string const& crystal, std::string const& applied) {
    auto const text = "[system]\nkind = 'llg'\ndamping = 0.1\n[lattice]\nshape = [6, 5, 4]\n" +
                      crystal + "\n[field]\ncouplings = { shells = [1] }\napplied = " + applied +
                      "\n[initial]\nuniform = [0, 0, 1]\n[integrator]\nmethod = 'rkmk4'\n"
                      "dt = 0.01\nsteps = 1\n";
    auto const scene = io::parse_scene_to_run_or_relax(text, "scene.toml");
    return make_plan_to_relax(scene, Precision::double_precision).file_bytes;
  };
  std::string const one = "[0, 0, 1]", three = "[[0, 0, 1], [0, 0, 2], [0, 0, 3]]";
  EXPECT_EQ(3 * bytes_of("", one) - bytes_of("", three), 0);
  EXPECT_EQ(3 * bytes_of("crystal = 'bcc'", one) - bytes_of("crystal = 'bcc'", three),
            2 * 240 * 3 * 8);
}

TEST(Positions, CellsAreCountedByTheirSites) {
  EXPECT_EQ(sites_text({4, 3, 2}, 1), "4 x 3 x 2 sites");
  EXPECT_EQ(cells_text({4, 3, 2}, 1), "4 x 3 x 2");
  EXPECT_EQ(sites_text({4, 3, 6}, 3), "4 x 3 x 2 cells of 3 sites");
}

}  // namespace
}  // namespace cayspin::simulation::test
