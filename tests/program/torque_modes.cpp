// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin modes in the field of a file's last frame, and with the torques of currents, compared
// with closed forms and with a run in time.
#include "modes_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace cayspin::program::test {
namespace {

// An interrupted `relax` leaves a file with fewer frames than fields. A list of more fields has the
// same effect here.
TEST_F(Modes, AreThoseInTheFieldOfTheLastFrame) {
  auto const scene = write(
      "scene.toml",
      "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\nshape = [4]\n[field]\nexchange = 1.0\n"
      "anisotropy = { constant = 0.1, axis = [1, 0, 0] }\n[initial]\nuniform = [1, 0.1, 0.1]\n");
  auto const in = [](std::string const& fields) { return set("field.applied=[" + fields + "]"); };
  std::string const two = "[0.1,0,0],[0.2,0,0]";
  EXPECT_EQ(start(joined({"relax", scene, "--output", "rest.h5"}, in(two))).status, 0);
  Arguments const of_file{"modes", "rest.h5", "--count", "2", "--quiet", "--overwrite"};
  output_of(of_file);
  auto const frequency = numbers("frequency");
  output_of(joined(of_file, in(two + ",[3,0,0]")));
  EXPECT_EQ(numbers("frequency"), frequency);
}

struct TorqueModes : Modes {
  static std::string scene(std::string const& lattice_and_field, std::string const& torque) {
    return "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\n" + lattice_and_field +
           "\n[torque]\n" + torque +
           "\n[initial]\nuniform = [0, 0, 1]\n[integrator]\nmethod = \"rkmk4\"\ndt = 0.01\n"
           "steps = 300\n[output]\nevery = 100\n";
  }
  std::string const particle =
      "shape = [1]\n[field]\nanisotropy = { constant = 1.0, axis = [0, 0, 1] }\n"
      "applied = [0, 0, 0.3]";
};

// With the polarization along the axis, a small deviation d of a spin from the axis z obeys
//   d' = -(H + b - damping * a) * d x z - (damping * (H + b) + a) * d.
// H is the sum of the anisotropy and the applied field; a and b are damping_like and field_like.
TEST_F(TorqueModes, OfAParticleWithAPolarizationAlongItsAxis) {
  double const damping = 0.1, b = 0.05, field = 1.3 + b;
  for (double const a : {0.4, 0.0, -0.9999 * damping * field, -1.0001 * damping * field, -0.5})
    for (std::string const precision : {"double", "single"}) {
      auto const text = scene(particle, "slonczewski = { damping_like = " + std::to_string(a) +
                                            ", field_like = 0.05, polarization = [0, 0, 1] }");
      double const typed = std::stod(std::to_string(a));
      auto const outcome = modes(text, {"--overwrite", "--precision", precision});
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      ASSERT_EQ(numbers("frequency").size(), 1U);
      double const bound = precision == "double" ? 1e-11 : 1e-5;
      double const decay = damping * field + typed;
      EXPECT_NEAR(numbers("frequency")[0], field - damping * typed, bound) << a;
      EXPECT_NEAR(numbers("decay")[0], decay, bound) << a;
      EXPECT_EQ(contains(outcome.output, "1 of these modes grows"), numbers("decay")[0] < 0);
    }
}

TEST_F(TorqueModes, CountGrowingModesThatAreNotListed) {
  auto const text = scene(
      "shape = [4]\n[field]\nanisotropy = { constant = 1.0, axis = [0, 0, 1] }\n"
      "applied = [0, 0, 0.3]",
      "slonczewski = { damping_like = -0.5, polarization = [0, 0, 1] }");
  EXPECT_TRUE(contains(modes(text, {"--count", "1"}).output,
                       "1 of these modes grows: the decay is negative\n"
                       "growing in all: 4 modes; a larger --count lists them\n"));
  EXPECT_FALSE(contains(modes(text, {"--overwrite"}).output, "growing in all"));
}

// In a ring with the spins along z, m_x + i * m_y = e^(i * k * j) at site j is a mode, with the
// eigenvalue
//   (i - damping) * W - i * u * sin(k) * (1 + damping * xi) + (damping - xi) * u * sin(k),
//   W = H + 2 * A * (1 - cos(k)).
// H is the sum of the anisotropy and the applied field, A the exchange, u the velocity and xi the
// nonadiabaticity.
TEST_F(TorqueModes, AreWavesWithADopplerShiftInACurrent) {
  double const damping = 0.1, u = 0.4, xi = 0.25;
  int const sites = 12;
  auto const outcome =
      modes(scene("shape = [12]\nboundary = \"periodic\"\n[field]\nexchange = 2.0\n"
                  "anisotropy = { constant = 1.0, axis = [0, 0, 1] }\napplied = [0, 0, 0.3]",
                  "zhang_li = { velocity = [0.4, 0, 0], nonadiabaticity = 0.25 }"),
            {"--count", "100"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  std::vector<std::pair<double, double>> exact, found;
  for (int n = 0; n < sites; ++n) {
    double const k = 2 * std::numbers::pi * n / sites, shift = u * std::sin(k);
    double const held = 1.3 + 4 * (1 - std::cos(k));
    exact.emplace_back(std::abs(held - shift * (1 + damping * xi)),
                       damping * held - (damping - xi) * shift);
  }
  auto const frequency = numbers("frequency"), decay = numbers("decay");
  for (std::size_t i = 0; i < frequency.size(); ++i) found.emplace_back(frequency[i], decay[i]);
  std::ranges::sort(exact);
  std::ranges::sort(found);
  ASSERT_EQ(found.size(), exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(found[i].first, exact[i].first, 1e-10) << i;
    EXPECT_NEAR(found[i].second, exact[i].second, 1e-10) << i;
  }
}

// A mode decays by e^(-d) and turns by w between two frames. Its deviations x, x' and x'' in three
// successive frames obey x'' = 2 * e^(-d) * cos(w) * x' - e^(-2 * d) * x.
TEST_F(TorqueModes, MoveAsInARun) {
  auto const text = scene(
      "shape = [3]\n[field]\nexchange = 2.0\nanisotropy = { constant = 1.0, axis = [0, 0, 1] }"
      "\napplied = [0.3, -0.1, 0.2]",
      "slonczewski = { damping_like = -0.07, field_like = 0.1, polarization = [0.6, 0, 0.8], "
      "lambda = 1.5 }");
  auto const file = write("scene.toml", text);
  auto const outcome = modes(text, {"--torque", "1e-11", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  auto const rest = numbers("spins");
  ASSERT_EQ(start({"run", file, "--output", "run.h5", "--quiet", "--set",
                   fmt::format("initial.uniform=[{},{},{}]", rest[0] + 1e-6, rest[1], rest[2])})
                .status,
            0);
  auto const spins = read_dataset("run.h5", "/spins").values;
  ASSERT_EQ(spins.size(), 4U * 9);
  double const w = numbers("frequency")[0], d = numbers("decay")[0];
  EXPECT_GT(std::abs(rest[0]), 0.1);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t frame : {0, 1}) {
      auto const x = [&](std::size_t later) { return spins[9 * (frame + later) + c] - rest[c]; };
      EXPECT_NEAR(x(2), 2 * std::exp(-d) * std::cos(w) * x(1) - std::exp(-2 * d) * x(0), 1e-10);
    }
}

// The H in the message is the field per moment, as it is without torques.
TEST_F(TorqueModes, AreRefusedByTheFieldPerMoment) {
  auto const outcome =
      modes(scene("shape = [2]\nmoments = [2.5]\n[field]\nanisotropy = { constant = 1.0, axis = "
                  "[0, 0, 1] }\napplied = [0.3, 0, 0.3]",
                  "slonczewski = { damping_like = 1e-14, polarization = [0, 0, 1] }"),
            {"--at-rest"});
  EXPECT_TRUE(contains(outcome.errors, "max |m x H| is 0.3, ")) << outcome.errors;
}

TEST_F(TorqueModes, OfFrozenSpinsAreNone) {
  auto const outcome =
      modes(scene("shape = [2]\nfrozen = \"1\"\n[field]\napplied = [0, 0, 1]",
                  "slonczewski = { damping_like = 0.1, polarization = [0, 0, 1] }"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(numbers("frequency").empty());
}

TEST_F(TorqueModes, RelaxAndPathRefuseATorque) {
  auto const file =
      write("scene.toml",
            scene(particle, "slonczewski = { damping_like = 0.1, polarization = [0, 0, 1] }"));
  auto const message =
      "torque: moves spins for ever, and an equilibrium needs an energy that falls; accepted: no "
      "such table";
  expect_refused({"relax", file}, message);
  expect_status(0, {"run", file, "--output", "a.h5", "--quiet"});
  expect_refused({"path", file, "--from", "a.h5", "--to", "a.h5", "--output", "path.h5"}, message);
}

TEST_F(TorqueModes, NeedAStateOfRest) {
  auto const spinning = modes(
      scene(
          "shape = [2]\n[field]\nexchange = 1.0\nanisotropy = { constant = -1.0, axis = [0, 0, 1] "
          "}\napplied = [0.1, 0, 0]",
          "slonczewski = { damping_like = 0.5, polarization = [0, 0, 1] }"),
      {"--at-rest", "--set", "initial.uniform=[1, 0, 0]"});
  EXPECT_EQ(spinning.status, 3);
  EXPECT_TRUE(contains(spinning.errors, "the start is not at rest: max |m x H| is 0.5,"))
      << spinning.errors;
  EXPECT_FALSE(exists("modes.h5"));
  auto const few = modes(scene(particle,
                               "slonczewski = { damping_like = 0.1, polarization = [1, 0, "
                               "0] }"),
                         {"--evaluations", "5"});
  EXPECT_EQ(few.status, 3);
  EXPECT_FALSE(exists("modes.h5"));
}

}  // namespace
}  // namespace cayspin::program::test
