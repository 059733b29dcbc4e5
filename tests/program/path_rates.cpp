// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin path --rates: prefactors beside formulas, in both precisions, and rates that fail.
#include "path_command.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::program::test {
namespace {

TEST_F(PathCommand, KeepsThePathIfItsRatesFail) {
  write_ends(scene);
  auto const outcome = start(
      arguments({"--rates", "--set", "system.damping=0", "--set", "system.precession=false"}));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(
      outcome.errors.ends_with("scene.toml: path.h5 has the path, but no rates: a spin "
                               "without precession and damping does not move\n"))
      << outcome.errors;
  EXPECT_TRUE(contains(outcome.output, "barriers 0.934615"));
  EXPECT_FALSE(contains(outcome.output, "prefactors"));
  EXPECT_NEAR(attribute("barrier_forward"), 3 * 0.5 * 1.3 * std::pow(1 - 0.4 / 1.3, 2), 1e-11);
  EXPECT_THROW(attribute("prefactor_forward"), std::runtime_error);
}

// Three spins act as one, with the rate of Bessarab's formula for a biaxial particle.
TEST_F(PathCommand, GivesTheRateOfABiaxialParticle) {
  auto const text = scene + "[output]\nfile = \"path.h5\"\n";
  write_ends(text);
  auto const outcome =
      start(arguments({"--rates", "--torque", "1e-10", "--set", "field.applied=[0, 0, 0]", "--set",
                       "lattice.shape=[1]", "--overwrite"}));
  EXPECT_EQ(outcome.status, 2);  // the ends have three sites
  double const easy = 1.3, hard = 0.7;
  // At the saddle, too, the curvatures of the exchange modes are 20 and 60 above those of the
  // uniform modes.
  double rest = 1;
  for (double const stiff : {20.0, 60.0})
    rest *= (stiff + easy) * (stiff + easy + hard) / ((stiff - easy) * (stiff + hard));
  double const one = std::sqrt(easy * (easy + hard)) / (2 * std::numbers::pi);
  for (std::string const precision : {"double", "single"}) {
    expect_status(0, arguments({"--rates", "--quiet", "--overwrite", "--set",
                                "field.applied=[0, 0, 0]", "--precision", precision, "--torque",
                                precision == "double" ? "1e-6" : "1e-4"}));
    EXPECT_NEAR(attribute("prefactor_forward"), one * std::sqrt(rest), 1e-6 * one) << precision;
    EXPECT_NEAR(attribute("prefactor_backward"), one * std::sqrt(rest), 1e-6 * one) << precision;
  }
}

// The field of a cubic anisotropy is not affine: in single precision, its difference quotients are
// too coarse for soft modes beside stiff ones.
TEST_F(PathCommand, GivesRatesOfDoublePrecisionInSinglePrecision) {
  std::string const text = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [8]
[field]
exchange = 200.0
applied = [0.05, 0, 0.02]
anisotropy = [{ cubic = 0.3, axes = [[1, 0, 0], [0, 1, 0]] },
              { constant = 0.5, axis = [0, 0, 1], constant2 = 0.2 }]
[initial]
uniform = [0, 0, 1]
)toml";
  write_ends(text);
  auto const rates = [&](std::string const& precision, std::string const& torque) {
    expect_status(0, arguments({"--rates", "--quiet", "--overwrite", "--precision", precision,
                                "--torque", torque}));
    return std::array{attribute("prefactor_forward"), attribute("prefactor_backward"),
                      attribute("langer_forward"), attribute("langer_backward")};
  };
  auto const expected = rates("double", "1e-8"), single = rates("single", "1e-3");
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(single[i] / expected[i], 1, 1e-6) << i;
}

// With a loose bound on the torque, the ends of another field count as ends of the path in single
// precision. A search in double precision moves them, so their rates would not be those of the
// path.
TEST_F(PathCommand, RefusesRatesOfOtherStatesThanThoseOfThePath) {
  write_ends(scene);
  auto const more = Arguments{"--rates",
                              "--quiet",
                              "--precision",
                              "single",
                              "--overwrite",
                              "--set",
                              "field.applied=[0, 0, 0]"};
  auto const outcome = start(arguments(joined(more, {"--torque", "0.5"})));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(outcome.errors.ends_with(
      "scene.toml: path.h5 has the path, but no rates: in double precision, the search leads from "
      "the start to a state of another energy; accepted: a smaller bound on the torque, or a path "
      "in double precision\n"))
      << outcome.errors;
  EXPECT_NEAR(attribute("barrier_forward"), 3 * 0.5 * 1.3 * (1 - std::pow(0.4 / 1.3, 2)), 1e-3);
  EXPECT_THROW(attribute("prefactor_forward"), std::runtime_error);
  expect_status(0, arguments(joined(more, {"--torque", "1e-4"})));
  EXPECT_GT(attribute("prefactor_forward"), 0);
}

// A frozen neighbour along x acts as a field.
TEST_F(PathCommand, GivesTheRateBesideAFrozenSpin) {
  auto const ends = [&](std::string const& text, std::string const& up, std::string const& down) {
    auto const file = write("scene.toml", text);
    for (auto const& [start, end] : {std::pair{up, "a.h5"}, {down, "b.h5"}})
      expect_status(0, {"relax", file, "--output", end, "--quiet", "--overwrite", "--set",
                        "initial=" + start});
    expect_status(0, arguments({"--rates", "--quiet", "--overwrite"}));
    return std::array{attribute("barrier_forward"), attribute("prefactor_forward"),
                      attribute("langer_forward")};
  };
  auto const of = [](std::string const& lattice, std::string const& field) {
    return "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\n" + lattice +
           "\n[field]\nanisotropy = [{ constant = 1.3, axis = [0, 0, 1] }, "
           "{ constant = -0.7, axis = [0, 1, 0] }]\n" +
           field + "\n[initial]\nuniform = [0, 0, 1]\n";
  };
  auto const one = [&](std::string const& lattice) {
    return ends(of("shape = [1]" + lattice, "applied = [0.4, 0, 0]"), "{uniform=[0,0,1]}",
                "{uniform=[0,0,-1]}");
  };
  auto const in_field = one("");
  for (std::string const ratio : {"3.0", "\"3 + 0*x\""}) {
    auto const thrice = one("\ngyromagnetic = " + ratio);
    for (std::size_t i : {1, 2}) EXPECT_NEAR(thrice[i] / in_field[i], 3, 1e-6) << ratio;
  }
  auto const beside = ends(of("shape = [2]\nfrozen = \"i < 1\"", "exchange = 0.4"),
                           "{expression=[\"i<1\",\"0\",\"i<1 ? 0 : 1\"]}",
                           "{expression=[\"i<1\",\"0\",\"i<1 ? 0 : -1\"]}");
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(beside[i] / in_field[i], 1, 1e-6) << i;
}

}  // namespace
}  // namespace cayspin::program::test
