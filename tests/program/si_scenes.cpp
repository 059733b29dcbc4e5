// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes in SI from end to end: the motion of the reduced scene to the bit, and numbers in SI.
#include "io/ovf.hpp"
#include "si_scene.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

namespace cayspin::program::test {
namespace {

TEST_F(SiScene, MovesAsTheReducedSceneToTheBit) {
  auto const u = units();
  struct Case {
    std::string si, reduced;
  };
  auto const method = [&](std::string const& keys, double dt) {
    return Case{keys + text("\ndt = ", dt, "\nsteps = 25"),
                keys + text("\ndt = ", u.time(dt), "\nsteps = 25")};
  };
  auto adaptive = method("method = \"tsit5\"\ntolerance = 1e-5", 2e-13);
  adaptive.si += "\nmax_dt = 5e-14";
  adaptive.reduced += text("\nmax_dt = ", u.time(5e-14));
  auto sigma = method("method = \"rkmk4\"", 1e-13);
  sigma.si += "\nisotropy = { constant = 3e11 }";
  sigma.reduced += text("\nisotropy = { constant = ", u.rate(3e11), " }");
  for (auto const& [si, reduced] :
       {method("method = \"rkmk4\"", 1e-13), method("method = \"ab2\"", 1e-13), adaptive, sigma})
    for (std::string const precision : {"double", "single"}) {
      Arguments const arguments{"--precision", precision, "--overwrite"};
      auto const h = text("[", u.applied(0.02), ", ", u.applied(-0.3), ", ", u.applied(0.1), "]");
      auto const expected = run(reduced_film(reduced, h), arguments);
      auto const spins = read_dataset("out.h5", "/spins").values;
      auto const info = run(film(si, "[0.02, -0.3, 0.1]"), arguments);
      EXPECT_EQ(read_dataset("out.h5", "/spins").values, spins) << si << ", " << precision;
      ASSERT_EQ(info.frames, 4);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(info.frame_times[i], expected.frame_times[i] * u.time_unit());
        EXPECT_EQ(info.frame_scalars[i].energy, expected.frame_scalars[i].energy * u.energy_unit());
        EXPECT_EQ(info.frame_scalars[i].magnetization, expected.frame_scalars[i].magnetization);
      }
    }
}

TEST_F(SiScene, AnExpressionInSecondsMovesAsTheOneInReducedTime) {
  auto const u = units();
  run(film("method = \"rkmk4\"\ndt = 1e-13\nsteps = 100",
           "[\"0.3*sin(2*pi*2e11*t)\", \"0.1+1e10*t\", 0]"));
  auto const in_seconds = last_spins("out.h5");
  run(reduced_film(
          text("method = \"rkmk4\"\ndt = ", u.time(1e-13), "\nsteps = 100"),
          text("[\"", u.applied(0.3), "*sin(", u.rate(2 * std::numbers::pi * 2e11), "*t)\", \"",
               u.applied(0.1), "+", u.applied(1e10 * u.time_unit()), "*t\", 0]")),
      {"--overwrite"});
  EXPECT_LT(distance(last_spins("out.h5"), in_seconds), 1e-12);
}

TEST_F(SiScene, AMomentTurnsByGammaTimesFieldTimesSeconds) {
  for (std::string const precision : {"double", "single"}) {
    run(atom(), {"--precision", precision, "--overwrite"});
    auto const m = last_spins("out.h5");
    double const tolerance = precision == "double" ? 1e-8 : 1e-4;
    EXPECT_NEAR(std::atan2(m[1], m[0]), gamma_e * 1e-11 / 1.01, tolerance);
    double const theta =
        2 * std::atan(std::tan(0.5 * std::acos(0.8)) * std::exp(-0.1 * gamma_e * 1e-11 / 1.01));
    EXPECT_NEAR(m[2], std::cos(theta), tolerance);
    auto const energy = read_dataset("out.h5", "/energy").values;
    EXPECT_NEAR(energy.back() / (-2 * 9.2740100657e-24), m[2], tolerance);
    EXPECT_NEAR(read_dataset("out.h5", "/time").values.back(), 1e-11, 1e-24);
  }
}

TEST_F(SiScene, TheFileSaysItsUnits) {
  auto const info = run(film("method = \"rkmk4\"\ndt = 1e-13\nsteps = 1", "[0, 0, 0.1]"));
  auto const u = units();
  EXPECT_EQ(info.header.units,
            (io::Units{true, u.time_unit(), u.length_unit(), u.field_unit(), u.energy_unit()}));
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
