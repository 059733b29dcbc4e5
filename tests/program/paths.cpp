// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin path: the file, barriers and rates in reduced units and in SI, refusals, and searches
// that fail.
#include "path_command.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace cayspin::program::test {
namespace {

// From +x to -x the path passes a minimum, with a saddle on either side. Both saddles have the same
// energy.
TEST_F(PathCommand, PlacesEachSaddleAtItsImage) {
  std::string const cubic = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [1]
[field]
anisotropy = [{ cubic = 1.0, axes = [[1, 0, 0], [0, 1, 0]] }, { constant = -3.0, axis = [0, 0, 1] }]
[initial]
uniform = [1, 0, 0]
)toml";
  write_ends(cubic);
  expect_status(0, {"relax", in_folder("scene.toml"), "--output", "b.h5", "--quiet", "--overwrite",
                    "--set", "initial={ uniform = [-1, 0, 0] }"});
  expect_status(0, arguments({"--images", "17", "--quiet"}));
  auto const image = read_dataset("path.h5", "/saddles/image").values,
             energy = read_dataset("path.h5", "/energy").values,
             of_saddles = read_dataset("path.h5", "/saddles/energy").values;
  ASSERT_EQ(image.size(), 2U);
  EXPECT_NE(image[0], image[1]);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(energy.at(static_cast<std::size_t>(image[i])), of_saddles[i]);
}

// If moments and constants are divided by a thousand, H and the path stay the same, and energies
// are divided by a thousand.
TEST_F(PathCommand, BoundsTheTorqueOfSmallMoments) {
  auto const chain = [](std::string const& moments, std::string const& scale) {
    return "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\nshape = [12]\n" + moments +
           "[field]\napplied = [0.1, 0, 0]\ncouplings = [{ offset = [1, 0, 0], J = 2" + scale +
           " }]\nanisotropy = { constant = 1" + scale +
           ", axis = [0, 0, 1] }\n[initial]\nuniform = [0, 0, 1]\n";
  };
  std::vector<double> barriers;
  for (auto const& scene : {chain("", ""), chain("moments = 0.001\n", "e-3")}) {
    auto const file = write("scene.toml", scene);
    for (std::string const z : {"1", "-1"})
      expect_status(0, {"relax", file, "--output", z == "1" ? "a.h5" : "b.h5", "--quiet",
                        "--overwrite", "--set", "initial={ uniform = [0, 0, " + z + "] }"});
    expect_status(0, arguments({"--torque", "1e-6", "--quiet", "--overwrite"}));
    EXPECT_LE(attribute("torque"), 1e-6);
    barriers.push_back(attribute("barrier_forward"));
  }
  EXPECT_NEAR(1e3 * barriers[1] / barriers[0], 1, 1e-9);
}

TEST_F(PathCommand, RefusesEndsWithOtherVacancies) {
  write_ends(scene);
  expect_status(0, {"relax", in_folder("scene.toml"), "--output", "b.h5", "--quiet", "--overwrite",
                    "--set", "lattice.occupied='i!=1'"});
  expect_refused(arguments(),
                 "--to b.h5: has no spin on site 1 (counted from 0, x fastest), where "
                 "--from a.h5 has one");
  EXPECT_FALSE(exists("path.h5"));
}

TEST_F(PathCommand, FindsTheBarrierOfAMacrospin) {
  write_ends(scene);
  auto const outcome = start(arguments({"--images", "12", "--rates"}));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  EXPECT_TRUE(
      contains_all(outcome.output, {"converged after ", "barriers 0.934615", "prefactors "}));
  double const barrier = 3 * 0.5 * 1.3 * std::pow(1 - 0.4 / 1.3, 2);
  EXPECT_NEAR(attribute("barrier_forward"), barrier, 1e-11);
  EXPECT_NEAR(attribute("barrier_backward"), barrier, 1e-11);
  EXPECT_NEAR(attribute("saddle_energy"), -3 * 0.4, 1e-11);
  EXPECT_NEAR(attribute("saddle_curvature"), 0.4 - 1.3, 1e-5);
  auto const spins = read_dataset("path.h5", "/spins");
  EXPECT_EQ(spins.extents, (std::vector<std::int64_t>{12, 1, 1, 3, 3}));
  auto const energy = read_dataset("path.h5", "/energy"),
             distance = read_dataset("path.h5", "/distance");
  ASSERT_EQ(energy.extents, std::vector<std::int64_t>{12});
  EXPECT_EQ(distance.values[0], 0);
  for (std::size_t k = 1; k < 12; ++k) EXPECT_GT(distance.values[k], distance.values[k - 1]);
  auto const image =
      static_cast<std::size_t>(read_dataset("path.h5", "/saddles/image").values.at(0));
  EXPECT_NEAR(energy.values[image], attribute("saddle_energy"), 1e-12);
  EXPECT_NEAR(read_dataset("path.h5", "/saddle").values.at(0), 1, 1e-6);
  EXPECT_EQ(read_dataset("path.h5", "/zero_modes").values, (std::vector<double>{0, 0, 0}));
}

// In SI: the barrier of a particle of one cell is K * V, and its prefactor is
//   gamma * sqrt(H_K * (H_K + H_hard)) / (2 * pi).
TEST_F(PathCommand, InSi) {
  std::string const text = R"toml(units = "SI"
[material]
Ms = 8e5
Ku = 5e4
axis = [0, 0, 1]
alpha = 0.1
damping_form = "gilbert"
gamma = 1.76e11
[system]
kind = "llg"
[lattice]
shape = [1]
spacing = 5e-9
[field]
anisotropy = { constant = -2e4, axis = [0, 1, 0] }
[initial]
uniform = [0, 0, 1]
)toml";
  write_ends(text);
  auto const outcome = start(arguments({"--rates", "--torque", "1e-8"}));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(contains_all(outcome.output,
                           {" J, curvature -", " J\nprefactors ", " 1/s forward, ",
                            " 1/s backward; zero modes 0, 0, 0\nwith damping ", " 1/s backward\n"}))
      << outcome.output;
  EXPECT_TRUE(contains_all(output_of({"info", "path.h5"}),
                           {" J, curvature -", " J\nprefactors   ", " 1/s forward, "}));
  double const volume = 125e-27;
  EXPECT_NEAR(attribute("barrier_forward") / (5e4 * volume), 1, 1e-11);
  double const easy = 2 * 5e4 / 8e5, hard = 2 * 2e4 / 8e5;  // T
  EXPECT_NEAR(attribute("prefactor_forward") /
                  (1.76e11 * std::sqrt(easy * (easy + hard)) / (2 * std::numbers::pi)),
              1, 1e-6);
}

TEST_F(PathCommand, InfoHasItsBarriersAndImages) {
  write_ends(scene);
  expect_status(0, arguments({"--images", "5", "--rates", "--quiet"}));
  auto const text = output_of({"info", "path.h5"});
  EXPECT_TRUE(contains_all(
      text,
      {"path.h5, a path of 5 images\n", "converged    yes\n", "from         a.h5\n",
       "to           b.h5\n", "3 x 1 x 1 sites", "barriers     0.934615385 forward, 0.934615385 ",
       "saddle       image 2: energy -1.2, curvature -0.9", "prefactors ", "with damping ",
       "zero modes   0, 0, 0\n", "\n     0             0 ", "scene:\n"}))
      << text;
  expect_status(3, arguments({"--evaluations", "70", "--overwrite"}));
  EXPECT_TRUE(
      contains_all(output_of({"info", "path.h5"}), {"converged    no: evaluation limit\n"}));
  expect_refused({"export", "path.h5", "--ovf", "ovf"}, "path.h5: it is the file of a path; ");
}

TEST_F(PathCommand, Refuses) {
  write_ends(scene);
  expect_refused(arguments({"--images", "2"}),
                 "--images 2; accepted: a whole number from 3 to 1000");
  expect_refused(arguments({"--torque", "0"}), "--torque 0; accepted: ");
  expect_refused(
      {"path", in_folder("scene.toml"), "--from", "none.h5", "--to", "b.h5", "--output", "path.h5"},
      "--from none.h5: cannot open the file: ");
  expect_refused(
      {"path", in_folder("scene.toml"), "--from", "a.h5", "--to", "none.h5", "--output", "path.h5"},
      "--to none.h5: cannot open the file: ");
  expect_refused(arguments({"--set", "lattice.shape=[2]"}), "--from a.h5: cannot read dataset ");
  expect_refused(arguments({"--set", "field.applied=[[0, 0, 0], [0, 0, 1]]"}), "field.applied: ");
  expect_refused(arguments({"--set", "thermal={ temperature = 1.0, seed = 1 }"}),
                 "thermal.temperature: ");
  for (std::string const end : {"a.h5", "b.h5"}) {
    auto const before = text_of(end);
    expect_refused({"path", in_folder("scene.toml"), "--from", "a.h5", "--to", "b.h5", "--output",
                    end, "--overwrite"},
                   end + ": the command reads it, and would replace it");
    EXPECT_EQ(text_of(end), before);
  }
  EXPECT_FALSE(exists("path.h5"));
  expect_status(0, arguments({"--quiet"}));
  auto const before = text_of("path.h5");
  expect_refused(arguments(), "it exists");
  EXPECT_EQ(text_of("path.h5"), before);
  expect_status(0, arguments({"--quiet", "--overwrite"}));
}

TEST_F(PathCommand, WritesPathH5ByDefault) {
  write_ends(scene);
  expect_status(0, {"path", in_folder("scene.toml"), "--from", "a.h5", "--to", "b.h5", "--quiet"});
  EXPECT_NEAR(attribute("barrier_forward"), 3 * 0.5 * 1.3 * std::pow(1 - 0.4 / 1.3, 2), 1e-11);
}

TEST_F(PathCommand, SaysWhyThereIsNoPath) {
  write_ends(scene);
  auto const same = start(
      {"path", in_folder("scene.toml"), "--from", "a.h5", "--to", "a.h5", "--output", "path.h5"});
  EXPECT_EQ(same.status, 3);
  EXPECT_TRUE(is_one_line(same.errors));
  EXPECT_TRUE(contains(same.errors, "both ends relaxed to the same state"));
  EXPECT_FALSE(exists("path.h5"));
  auto const limited = start(arguments({"--evaluations", "70"}));
  EXPECT_EQ(limited.status, 3);
  EXPECT_TRUE(contains(limited.errors, ": no converged path: evaluation limit, after "))
      << limited.errors;
  EXPECT_TRUE(limited.errors.ends_with("; path.h5 has the images as they are\n")) << limited.errors;
}

// Three spins turn together. With E = -1.3 * m_z^2 / 2 + 0.7 * m_y^2 / 2 - 0.4 * m_x each, the
// curvatures at the saddle +x are 0.4 - 1.3 and 0.4 + 0.7.
TEST_F(PathCommand, GivesItsStatesToModes) {
  write_ends(scene);
  expect_status(0, arguments({"--images", "7", "--quiet"}));
  ASSERT_EQ(read_dataset("path.h5", "/saddles/image").values, std::vector<double>{3});
  Arguments const modes{"modes", "path.h5", "--hessian", "--count", "2", "--overwrite"};
  auto const values = [&](char const* dataset) { return read_dataset("modes.h5", dataset).values; };
  for (std::string const frame : {"saddle", "3", "-4"}) {
    auto const printed = output_of(joined(modes, {"--frame", frame}));
    EXPECT_TRUE(contains(printed, "the state is a saddle: 1 of these curvatures is negative\n"))
        << frame << printed;
    EXPECT_NEAR(values("curvature").at(0), 0.4 - 1.3, 1e-5);
    EXPECT_NEAR(values("curvature").at(1), 0.4 + 0.7, 1e-5);
    EXPECT_LT(distance(values("spins"), read_dataset("path.h5", "saddle").values), 1e-14);
  }
  // The other images are relaxed to the end on their side of the saddle.
  for (auto const& [frame, z] : {std::pair{"0", 1}, {"1", 1}, {"5", -1}, {"last", -1}}) {
    EXPECT_FALSE(contains(output_of(joined(modes, {"--frame", frame})), "saddle")) << frame;
    EXPECT_NEAR(values("spins").at(2), z * std::sqrt(1 - std::pow(0.4 / 1.3, 2)), 1e-5) << frame;
  }
  expect_refused(modes,
                 "path.h5: it is the file of a path; accepted: --frame with an image, 0 to 6, or "
                 "saddle");
  for (std::string const frame : {"7", "-8", "first"})
    expect_refused(
        joined(modes, {"--frame", frame}),
        "--frame " + frame + ": accepted for path.h5: 0 to 6, -1 to -7 from the end, last, saddle");
  expect_refused(joined(modes, {"--frame", "saddle", "--set", "initial={ uniform = [0, 0, 1] }"}),
                 "--frame: --set changes the start; accepted: one of them");
  expect_refused(joined(modes, {"--frame", "saddle", "--set", "lattice.shape=[2]"}),
                 "path.h5: its lattice is 3 x 1 x 1 sites, that of the scene is 2 x 1 x 1 sites; ");
  expect_refused({"modes", "path.h5", "--frame", "saddle", "--output", "path.h5", "--overwrite"},
                 "path.h5: the command reads it, and would replace it");
  expect_refused({"modes", "a.h5", "--frame", "1"}, "--frame 1: accepted for a.h5: 0, last");
  expect_refused({"modes", "scene.toml", "--frame", "0"}, "--frame: scene.toml is a scene; ");
  expect_refused({"modes", "none.h5", "--frame", "0"}, "none.h5: cannot be read: No such file");
  // As the start of a scene, the file is its last image.
  expect_status(0, {"relax", "scene.toml", "--output", "c.h5", "--quiet", "--set",
                    "initial={ file = \"path.h5\" }"});
  EXPECT_LT(last_spins("c.h5").at(2), -0.9);
}

// With five images a path of a chain of twenty spins misses the highest saddle and does not settle.
// With sixteen the path finds that saddle.
TEST_F(PathCommand, PrintsTheSaddlesOfAPathThatDoesNotSettle) {
  write_ends(R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [20]
[field]
exchange = 0.5
anisotropy = [{ constant = 1.0, axis = [0, 0, 1] }, { constant = -0.7, axis = [0, 1, 0] }]
applied = [0.1, 0, 0]
[initial]
uniform = [0, 0, 1]
)toml");
  auto const outcome = start(arguments({"--images", "5"}));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains_all(
      outcome.errors,
      {": the saddles are found, but the path between them does not settle within ",
       " evaluations; path.h5 has the saddles and the path as it is; accepted: more --images\n"}));
  EXPECT_TRUE(contains(outcome.output, "\nbarriers 2.08801"));
  EXPECT_NEAR(attribute("barrier_forward"), 2.08801527, 1e-6);
  EXPECT_EQ(start(arguments({"--images", "16", "--overwrite"})).status, 0);
  EXPECT_NEAR(attribute("barrier_forward"), 2.09028197, 1e-6);
}

// Kernels over few sites run on one thread, so the film is large. Its search ends early, when the
// path has been relaxed and has begun to climb.
TEST_F(PathCommand, HasTheSameBitsForAnyNumberOfThreads) {
  auto film = scene;
  film.replace(film.find("[3]"), 3, "[80, 60]");
  write_ends(film);
  auto const path_with = [&](std::string const& threads) {
    auto const outcome = expect_status(3, arguments({"--images", "8", "--evaluations", "180",
                                                     "--overwrite", "--threads", threads}));
    EXPECT_TRUE(contains(outcome.errors, "no converged path: evaluation limit, after "));
    return std::array{read_dataset("path.h5", "/spins").values,
                      read_dataset("path.h5", "/energy").values};
  };
  auto const one = path_with("1"), two = path_with("2");
  EXPECT_EQ(one[0].size(), 8U * 3 * 80 * 60);
  EXPECT_EQ(two, one);
}

}  // namespace
}  // namespace cayspin::program::test
