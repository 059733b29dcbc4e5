// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The files that runs of scenes in SI write.
#include "io/ovf.hpp"
#include "si_scene.hpp"

#include <array>
#include <fstream>

namespace cayspin::program::test {
namespace {

constexpr double mu0 = 1.25663706127e-6;

TEST_F(SiScene, TheFileSaysItsUnits) {
  auto const info = run(film("method = \"rkmk4\"\ndt = 1e-13\nsteps = 1", "[0, 0, 0.1]"),
                        set("initial={uniform=[0,0,1]}"));
  auto const u = units();
  EXPECT_EQ(info.header.units,
            (io::Units{true, u.time_unit(), u.length_unit(), u.field_unit(), u.energy_unit()}));
  EXPECT_NEAR(read_dataset("out.h5", "/time").values.back(), 1e-13, 1e-27);
  double const pressure = 0.9 * 0.5 * mu0 * 8e5 * 8e5 - 8e5 * 0.1 - 5e4;
  EXPECT_NEAR(read_dataset("out.h5", "/energy").values[0] / (60 * 60e-27 * pressure), 1, 1e-13);
  auto const said = output_of({"info", "out.h5"});
  EXPECT_TRUE(contains(said,
                       "units        SI; one reduced unit is 6.15746661e-12 s, 4e-09 m, "
                       "1.00530965 T, 4.82548632e-20 J\n"));
  EXPECT_TRUE(contains(said, "step 1, t = 1e-13 s: energy "));
  EXPECT_EQ(run(macrospin_scene(), {"--overwrite"}).header.units, io::Units{});
  EXPECT_TRUE(contains(output_of({"info", "out.h5"}), "units        reduced\n"));
}

TEST_F(SiScene, FilesOfOtherToolsAreInSi) {
  auto const info = run(film("method = \"rkmk4\"\ndt = 1e-13\nsteps = 10", "[0, 0, 0.1]"),
                        set("output.table=true", "output.xdmf=true"));
  output_of({"export", "out.h5", "--ovf", "."});
  auto const field = io::read_ovf(in_folder("out_000001.ovf"));
  EXPECT_EQ(field.mesh.unit, "m");
  std::array const cell{4e-9, 5e-9, 3e-9};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(field.mesh.step[axis] / cell[axis], 1, 1e-15);
    EXPECT_NEAR(field.mesh.base[axis] / cell[axis], 0.5, 1e-15);
  }
  std::string const before = "Total simulation time: ", time = field.description.at(0);
  EXPECT_EQ(time.substr(0, before.size()), before);
  EXPECT_EQ(std::stod(time.substr(before.size())), info.frame_times[1]);
  EXPECT_EQ(time.substr(time.size() - 2), " s");
  std::ifstream table(in_folder("out.txt"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "# t (s)\tmx ()\tmy ()\tmz ()\tE_total (J)\tnorm_defect ()");
  std::getline(table, line);
  std::getline(table, line);
  EXPECT_EQ(std::stod(line), info.frame_times[1]);
  EXPECT_TRUE(contains(text_of("out.xdmf"), "4e-09"));
}

}  // namespace
}  // namespace cayspin::program::test
