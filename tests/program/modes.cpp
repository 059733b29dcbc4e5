// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin modes: the standard problem of ferromagnetic resonance, a ferrimagnet, the file, and
// refusals.
#include "modes_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cayspin::program::test {
namespace {

// Problem of Baker et al. 2017. Expects the seven lowest eigenvalues of the dense matrix, computed
// in NumPy with Newell's tensors. A matrix pencil applied to OOMMF's run in time finds four of
// them, to 4e-4 GHz.
TEST_F(Modes, OfTheStandardProblemOfResonance) {
  auto const outcome = modes(R"toml(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0.008
damping_form = "gilbert"
gamma = 1.75879979019e11
[system]
kind = "llg"
[lattice]
shape = [24, 24, 2]
spacing = [5e-9, 5e-9, 5e-9]
[field]
demag = true
applied = [0.0823581754, 0.0576507224, 0]
[initial]
uniform = [0.81923192, 0.57346234, 0]
[integrator]
method = "heun"
dt = 1e-13
steps = 1
)toml",
                             {"--count", "7", "--torque", "1e-10"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(contains(outcome.output, "frequency, GHz"));
  auto const frequency = numbers("frequency"), decay = numbers("decay");
  ASSERT_EQ(frequency.size(), 7U);
  double const exact[][2] = {{8.266939671, 0.645341109},  {9.398580466, 0.609799940},
                             {10.834825816, 0.695422545}, {11.228656316, 0.688463462},
                             {11.987788617, 0.713256195}, {13.039868687, 0.743033178},
                             {13.810589437, 0.773852679}};
  for (std::size_t mode = 0; mode < 7; ++mode) {
    EXPECT_NEAR(1e-9 * frequency[mode], exact[mode][0], 1e-7) << mode;
    EXPECT_NEAR(1e-9 * decay[mode], exact[mode][1], 1e-7) << mode;
  }
  for (auto const& [mode, oommf] : {std::pair{0, 8.2669}, {3, 11.2286}, {4, 11.9881}, {6, 13.8105}})
    EXPECT_NEAR(1e-9 * frequency[mode], oommf, 4e-4) << mode;
  EXPECT_EQ(read_dataset("modes.h5", "mode").extents,
            (std::vector<std::int64_t>{7, 2, 24, 24, 3, 2}));
  EXPECT_EQ(read_dataset("modes.h5", "spins").extents, (std::vector<std::int64_t>{2, 24, 24, 3}));
}

std::string const ferrimagnet = R"toml([system]
kind = "llg"
damping = 0
[lattice]
shape = [1, 1, 1]
basis = [[0, 0, 0], [0.5, 0, 0]]
moments = [1.0, 0.6]
gyromagnetic = [1.0, 1.3]
[field]
couplings = [ { between = [0, 1], offset = [0, 0, 0], J = -0.8 } ]
anisotropy = { constant = 0.1, axis = [0, 0, 1] }
applied = [0, 0, 0.05]
[initial]
expression = ["0.1", "0.2", "1 - 2*s"]
[integrator]
method = "heun"
dt = 0.01
steps = 1
)toml";

// Frequencies w of the two sublattices: w^2 + w * (a2 * b2 - a1 * b1) = a1 * a2 * (b1 * b2 - J^2),
// where a is the gyromagnetic ratio / the moment, and b = J + K +- moment * H.
TEST_F(Modes, OfAFerrimagnet) {
  auto const outcome = modes(ferrimagnet, {"--torque", "1e-11", "--hessian"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  double const j = 0.8, k = 0.1, h = 0.05, a1 = 1, a2 = 1.3 / 0.6;
  auto const spins = numbers("spins");
  double const up = spins[2] > 0 ? 1 : -1;
  double const b1 = j + k + up * h, b2 = j + k - up * 0.6 * h;
  double const half = (a1 * b1 - a2 * b2) / 2;
  double const root = std::sqrt(half * half + a1 * a2 * (b1 * b2 - j * j));
  std::vector<double> exact{std::abs(half - root), std::abs(half + root)};
  std::ranges::sort(exact);
  auto const frequency = numbers("frequency"), decay = numbers("decay");
  ASSERT_EQ(frequency.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(frequency[i], exact[i], 1e-9 * exact[i]) << i;
    EXPECT_EQ(decay[i], 0) << i;
  }
  EXPECT_EQ(read_dataset("modes.h5", "mode").extents,
            (std::vector<std::int64_t>{2, 2, 1, 1, 1, 3, 2}));
  auto const curvature = numbers("curvature");
  double const mean = (b1 + b2) / 2, split = std::hypot((b1 - b2) / 2, j);
  ASSERT_EQ(curvature.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(curvature[i], i < 2 ? mean - split : mean + split, 1e-9) << i;
  for (double const residual : numbers("curvature_residual")) EXPECT_LT(residual, 1e-7);
  EXPECT_FALSE(contains(outcome.output, "saddle"));
}

// Spins along x, with E = -K * m_z^2 / 2 - h * m_x each, have the lowest curvatures h - K and h. A
// turn in an easy plane costs no energy: its curvature is 0 up to its error, which is no saddle.
TEST_F(Modes, CountNegativeCurvaturesBeyondTheirErrors) {
  auto const at = [&](std::string const& field, Arguments const& more) {
    auto const scene =
        "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\nshape = [3]\n[field]\n"
        "exchange = 5.0\n" +
        field + "\n[initial]\nuniform = [1, 0, 0]\n";
    auto const outcome = modes(scene, joined({"--hessian", "--at-rest", "--overwrite"}, more));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return outcome.output;
  };
  std::string const axis = "anisotropy = { constant = 1.0, axis = [0, 0, 1] }\n";
  std::string const saddle = "the state is a saddle: 1 of these curvatures is negative\n";
  EXPECT_TRUE(contains(at(axis + "applied = [0.2, 0, 0]", {"--count", "2"}), saddle));
  auto const curvature = numbers("curvature"), error = numbers("curvature_error");
  ASSERT_EQ(error.size(), 2U);
  EXPECT_NEAR(curvature[0], 0.2 - 1.0, 1e-12);
  EXPECT_NEAR(curvature[1], 0.2, 1e-12);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(error[i], 0) << i;
    EXPECT_LT(error[i], 1e-8) << i;
  }
  EXPECT_TRUE(contains(output_of({"info", "modes.h5"}), "\n" + saddle));
  EXPECT_TRUE(contains(at(axis + "applied = [0.2, 0, 0]", {"--count", "1"}),
                       "the state is a saddle or a maximum: this curvature is negative\n"));
  // The error of curvatures of a state that is not at rest includes its torque.
  EXPECT_FALSE(contains(at(axis + "applied = [0.2, 0, 0.1]", {}), "saddle"));
  EXPECT_GE(numbers("curvature_error").at(0), 10 * 0.1);
  std::string const plane = "anisotropy = { constant = -1.0, axis = [0, 0, 1] }";
  for (std::string const precision : {"double", "single"}) {
    EXPECT_FALSE(contains(at(plane, {"--precision", precision}), "saddle")) << precision;
    EXPECT_LE(std::abs(numbers("curvature").at(0)), numbers("curvature_error").at(0)) << precision;
  }
}

// Modes that start from the last frame of a file written by relax equal those of the scene. At a
// saddle, here with the spins along the in-plane hard axis, one mode grows.
TEST_F(Modes, StartFromFilesAndSaddles) {
  auto const scene = write("scene.toml", film);
  EXPECT_EQ(output_of({"modes", scene, "--count", "2", "--quiet"}), "");
  auto const frequency = numbers("frequency");
  EXPECT_EQ(start({"relax", scene, "--output", "rest.h5"}).status, 0);
  expect_refused({"modes", "rest.h5"}, "modes.h5");
  auto const other_shape = start({"modes", "rest.h5", "--overwrite", "--set", "lattice.shape=[2]"});
  EXPECT_EQ(other_shape.status, 2);
  EXPECT_TRUE(other_shape.errors.starts_with("rest.h5: cannot read dataset")) << other_shape.errors;
  EXPECT_EQ(start({"modes", "rest.h5", "--count", "2", "--overwrite", "--at-rest"}).status, 0);
  EXPECT_NEAR(numbers("frequency")[0], frequency[0], 1e-6);
  EXPECT_EQ(start({"modes", scene, "--count", "2", "--overwrite", "--at-rest", "--set",
                   "initial.uniform=[0, 1, 0]"})
                .status,
            0);
  auto const decay = numbers("decay");
  EXPECT_LT(*std::ranges::min_element(decay), -0.1);
}

// Along the easy axis x of a film, in the field h, the curvatures are h + 0.1 and h + 1.1.
TEST_F(Modes, StartFromAnyFrame) {
  expect_status(0, {"relax", write("scene.toml", film), "--output", "rest.h5", "--quiet", "--set",
                    "field.applied=[[0.5, 0, 0], [1, 0, 0]]"});
  for (auto const& [frame, h] : {std::pair{"0", 0.5}, {"-2", 0.5}, {"1", 1.0}, {"last", 1.0}}) {
    output_of({"modes", "rest.h5", "--overwrite", "--count", "1", "--frame", frame});
    double const a = h + 0.1, b = h + 1.1, decay = 0.1 * (a + b) / 2;
    EXPECT_NEAR(numbers("decay").at(0), decay, 1e-8) << frame;
    EXPECT_NEAR(numbers("frequency").at(0), std::sqrt(1.01 * a * b - decay * decay), 1e-8) << frame;
  }
  expect_refused({"modes", "rest.h5", "--overwrite", "--frame", "2"},
                 "--frame 2: accepted for rest.h5: 0 to 1, -1 to -2 from the end, last");
}

// Errors in the spins of a file name it as it was typed, and not the key or option that reads it.
TEST_F(Modes, RefuseStatesWithOtherVacanciesThanTheScene) {
  expect_status(0, {"relax", write("scene.toml", film), "--output", "rest.h5", "--quiet", "--set",
                    "lattice.occupied=\"i > 0\""});
  Arguments const filled{"modes", "rest.h5", "--set", "lattice.occupied=\"i < 7\""};
  auto const expect_error = [&](Arguments const& more, std::string const& begin) {
    auto const outcome = start(joined(filled, more));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(is_one_line(outcome.errors));
    EXPECT_TRUE(outcome.errors.starts_with(begin)) << outcome.errors;
    EXPECT_FALSE(exists("modes.h5"));
  };
  expect_error({}, "rest.h5: is zero on 6 of the 42 sites that lattice.occupied fills; accepted: ");
  expect_error({"--frame", "0"}, "rest.h5: the spin of site (0, 0, 0) is (0, 0, 0); accepted: ");
}

TEST_F(Modes, InfoHasTheSpectrum) {
  auto const scene = write("scene.toml", film);
  EXPECT_EQ(start({"modes", scene, "--count", "2", "--hessian", "--quiet"}).status, 0);
  auto const text = output_of({"info", "modes.h5"});
  EXPECT_TRUE(contains_all(text, {"modes.h5, modes of an equilibrium\n", "converged    yes\n",
                                  "8 x 6", "max |m x H| = ", "mode         frequency", "\n     1  ",
                                  "curvatures   0.1\n", "scene:\n[system]\n"}))
      << text;
  EXPECT_EQ(
      start({"modes", scene, "--quiet", "--overwrite", "--set", "lattice.boundary=\"periodic\"",
             "--wave-vector", "0,0,0", "--wave-vector", "0.5,0,0", "--points", "4"})
          .status,
      0);
  EXPECT_TRUE(contains_all(
      output_of({"info", "modes.h5"}),
      {"modes.h5, waves of an equilibrium\n", "wave vectors 5\n", "band 0       frequencies 0.3"}));
}

TEST_F(Modes, OfSpinsThatAreFrozenOrMissing) {
  auto const outcome = modes(film, {"--count", "3", "--set", "lattice.occupied=\"i < 6\"", "--set",
                                    "lattice.frozen=\"j < 1\""});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  auto const mode = numbers("mode");
  ASSERT_EQ(mode.size(), 3U * 48 * 6);
  for (std::size_t i = 0; i < 3 * 48; ++i) {
    std::size_t const site = i % 48;
    double size = 0;
    for (std::size_t c = 0; c < 6; ++c) size += std::abs(mode[6 * i + c]);
    if (site % 8 >= 6 || site / 8 < 1) {
      EXPECT_EQ(size, 0) << i;
    } else {
      EXPECT_GT(size, 1e-6) << i;
    }
  }
}

// The Hessian of the hexagonal anisotropy is not constant, so products with it are finite
// differences. At rest, E = K * sin(theta)^6 * cos(6 * phi) has curvatures 6 * K and 36 * K.
TEST_F(Modes, OfASpinWithAHexagonalAxis) {
  auto const outcome = modes(
      "[system]\nkind = \"llg\"\ndamping = 0.9\n[lattice]\nshape = [1]\n[field]\n"
      "anisotropy = { hexagonal = 0.2, axis = [0.1, 0.3, 1], in_plane = [3, -1, 0] }\n"
      "[initial]\nrandom = { seed = 3 }\n");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  double const a = 1.2, b = 7.2, damping = 0.9, decay = damping * (a + b) / 2;
  EXPECT_NEAR(numbers("decay").at(0), decay, 1e-7);
  EXPECT_NEAR(numbers("frequency").at(0),
              std::sqrt((1 + damping * damping) * a * b - decay * decay), 1e-7);
}

TEST_F(Modes, WarnOfAStartThatIsNotAtRest) {
  Arguments const start_of_film{"--at-rest", "--count", "2", "--set", "initial={random={seed=4}}"};
  auto const outcome = modes(film, start_of_film);
  EXPECT_TRUE(contains_all(outcome.errors, {"warning: ", "scene.toml: max |m x H| is ",
                                            "above --torque 1e-06: these are modes of a state"}))
      << outcome.errors;
  auto const none = modes(film, joined(start_of_film, {"--overwrite", "--torque", "1e3"}));
  EXPECT_FALSE(contains(none.errors, "warning")) << none.errors;
}

TEST_F(Modes, RefuseWhatHasNone) {
  auto const refused = [&](Arguments const& more, std::string const& part) {
    expect_refused(joined({"modes", write("scene.toml", film)}, more), part);
    EXPECT_FALSE(exists("modes.h5"));
  };
  refused({"--count", "0"}, "--count");
  refused({"--torque", "0"}, "--torque");
  refused({"--tolerance", "2"}, "--tolerance");
  refused({"--set", "field.applied=[[0,0,1],[0,0,2]]"}, "a list of fields");
  refused({"--set", "thermal.temperature=0.1"}, "no temperature");
  refused({"--set", "system.damping=0", "--set", "system.precession=false"}, "do not move");
  Arguments const torque{"--set",
                         "torque.slonczewski={ damping_like = 0.1, polarization = [0, 1, 0] }"};
  refused(joined(torque, {"--hessian"}), "torque: does not go with --hessian");
  refused(joined(torque, {"--wave-vector", "0,0,0"}), "torque: does not go with --wave-vector");
  refused(joined(torque, {"--set", "lattice.shape=[1025]"}), "lattice.shape: has 1025 sites; ");
  // before the search, which fails with so few evaluations
  refused({"--evaluations", "3", "--output", "none/modes.h5"}, "the folder none does not exist");
  auto const few = start({"modes", write("scene.toml", film), "--evaluations", "3"});
  EXPECT_EQ(few.status, 3);
  EXPECT_FALSE(exists("modes.h5"));
}

// The eighth and the ninth mode have equal frequencies, so the eight modes sought contain only part
// of that multiplet.
TEST_F(Modes, ConvergeWhereALastMultipletIsCut) {
  for (int const seed : {3, 8, 13, 38}) {
    auto const outcome = modes(fmt::format(R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [20, 12]
boundary = "periodic"
[field]
exchange = 1.0
anisotropy = {{ constant = 0.3, axis = [0, 0, 1] }}
applied = [0, 0.1, 0.5]
[initial]
random = {{ seed = {} }}
)toml",
                                           seed),
                               {"--quiet", "--overwrite"});
    EXPECT_EQ(outcome.status, 0) << seed << ": " << outcome.errors;
    EXPECT_EQ(numbers("frequency").size(), 8U);
  }
}

}  // namespace
}  // namespace cayspin::program::test
