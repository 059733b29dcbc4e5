// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin modes --wave-vector: bands of crystals with known frequencies, and refusals.
#include "modes_test.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program::test {
namespace {

using Branches = std::vector<double>;

struct Bands : Modes {
  /// Expects the branches at each wave vector of a path, for spins along z. `exact` returns the
  /// branches for the phases 2 * pi * q along the vectors of the cell, where q is the wave vector
  /// in cycles per cell.
  template <class Exact>
  void expect_bands(std::string const& lattice_and_field, Exact const& exact) const {
    auto const scene = "[system]\nkind = \"llg\"\ndamping = 0\n" + lattice_and_field +
                       "\n[integrator]\nmethod = \"heun\"\ndt = 0.01\nsteps = 1\n";
    auto const outcome =
        modes(scene, {"--overwrite", "--quiet", "--torque", "1e-11", "--points", "7",
                      "--wave-vector", "0,0,0", "--wave-vector", "0.5,0.1,0", "--wave-vector",
                      "0.3333333333333333,"
                      "-0.3333333333333333,0.2"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    auto const waves = numbers("wave_vector"), found = numbers("frequency");
    ASSERT_EQ(waves.size(), 3U * 15);
    for (std::size_t i = 0; i < 15; ++i) {
      constexpr double turn = 6.283185307179586;
      Branches branches =
          exact(turn * waves[3 * i], turn * waves[3 * i + 1], turn * waves[3 * i + 2]);
      std::ranges::sort(branches);
      ASSERT_EQ(found.size(), 15 * branches.size());
      for (std::size_t b = 0; b < branches.size(); ++b)
        EXPECT_NEAR(found[i * branches.size() + b], branches[b], 1e-10 * branches.back())
            << i << " " << b;
    }
  }
};

constexpr char const* held = R"toml(
anisotropy = { constant = 0.1, axis = [0, 0, 1] }
applied = [0, 0, 0.05]
[initial]
uniform = [0, 0, 1]
)toml";

TEST_F(Bands, OfAHoneycombWithAGapByDmi) {
  double const d = 0.07;
  std::string bonds;
  for (std::string const offset : {"[0,0,0]", "[-1,0,0]", "[0,-1,0]"})
    bonds += "{ between = [0, 1], offset = " + offset + ", J = 1.0 }, ";
  for (std::string const offset : {"[1,0,0]", "[-1,1,0]", "[0,-1,0]"})
    for (int site : {0, 1}) {
      auto const s = std::to_string(site);
      bonds += "{ between = [" + s + ", " + s + "], offset = " + offset + ", D = [0, 0, " +
               std::to_string(site == 0 ? d : -d) + "] }, ";
    }
  expect_bands(
      "[lattice]\nshape = [4, 4]\ncrystal = \"honeycomb\"\nboundary = \"periodic\"\n"
      "[field]\ncouplings = [" +
          bonds + "]" + held,
      [&](double x, double y, double) -> Branches {
        double const real = 1 + std::cos(x) + std::cos(y), imaginary = std::sin(x) + std::sin(y);
        double const gap = 2 * d * (std::sin(x) + std::sin(y - x) - std::sin(y));
        double const split = std::hypot(std::hypot(real, imaginary), gap);
        return {3.15 - split, 3.15 + split};
      });
}

TEST_F(Bands, OfKagomeAndBccAndAFerrimagnet) {
  std::string const shells = "boundary = \"periodic\"\n[field]\ncouplings = { shells = [1.0] }";
  expect_bands("[lattice]\nshape = [3, 3]\ncrystal = \"kagome\"\n" + shells + held,
               [](double x, double y, double) -> Branches {
                 double const squares = std::pow(std::cos(x / 2), 2) +
                                        std::pow(std::cos(y / 2), 2) +
                                        std::pow(std::cos((x - y) / 2), 2);
                 double const root = std::sqrt(std::max(0.0, 4 * squares - 3));
                 return {3.15 - root, 3.15 + root, 6.15};
               });
  expect_bands("[lattice]\nshape = [3, 3, 3]\ncrystal = \"bcc\"\n" + shells + held,
               [](double x, double y, double z) -> Branches {
                 double const c = 8 * std::cos(x / 2) * std::cos(y / 2) * std::cos(z / 2);
                 return {8.15 - c, 8.15 + c};
               });
  expect_bands(
      "[lattice]\nshape = [3, 3]\ncrystal = \"honeycomb\"\nmoments = [1.0, 0.6]\n"
      "boundary = \"periodic\"\n[field]\ncouplings = { shells = [-1.0] }\n"
      "anisotropy = { constant = 0.1, axis = [0, 0, 1] }\napplied = [0, 0, 0.05]\n"
      "[initial]\nexpression = [\"0\", \"0\", \"s == 0 ? 1 : -1\"]\n",
      [](double x, double y, double) -> Branches {
        double const square =
            std::pow(1 + std::cos(x) + std::cos(y), 2) + std::pow(std::sin(x) + std::sin(y), 2);
        double const up = 3.1 + 0.05, down = (3.1 - 0.6 * 0.05) / 0.6;
        double const root = std::sqrt(std::pow((up + down) / 2, 2) - square / 0.6);
        return {root + (up - down) / 2, root - (up - down) / 2};
      });
}

// With one cell along an axis, a bond along it would join a spin to itself, which is refused;
// without such bonds one cell is enough.
TEST_F(Bands, NeedCellsOnlyWhereBondsReach) {
  std::string const
      head = "[system]\nkind = \"llg\"\ndamping = 0\n[lattice]\nboundary = \"periodic\"\n",
      tail = "\napplied = [0, 0, 0.5]\n[initial]\nuniform = [0, 0, 1]\n";
  std::string const along_y = "couplings = [{ offset = [0, 1, 0], J = 1.0 }]",
                    both =
                        "couplings = [{ offset = [0, 1, 0], J = 1.0 }, { offset = [1, 0, 0], J = "
                        "1.0 }]";
  Arguments const wave{"--quiet", "--overwrite", "--wave-vector", "0.5,0.25,0"};
  auto const lowest = [&](std::string const& shape, std::string const& bonds) {
    auto const outcome = modes(head + "shape = " + shape + "\n[field]\n" + bonds + tail, wave);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return numbers("frequency").at(0);
  };
  EXPECT_NEAR(lowest("[1, 8]", along_y), 0.5 + 2, 1e-12);
  EXPECT_NEAR(lowest("[3, 8]", both), 0.5 + 2 + 4, 1e-12);
  expect_refused(
      joined({"modes", write("scene.toml", head + "shape = [1, 8]\n[field]\n" + both + tail)},
             wave),
      "1 cell along x, and bonds reach over 1 cell");
}

// The field of dipoles reaches around the lattice, whether the number of cells is odd or even.
// Waves that fit the lattice are modes of the lattice.
TEST_F(Bands, FitTheLatticeWithDipoles) {
  auto const dipoles = [](int cells) {
    return "[system]\nkind = \"llg\"\ndamping = 0\n[lattice]\nboundary = \"periodic\"\nshape = [" +
           std::to_string(cells) +
           "]\n[field]\ndipoles = true\napplied = [0, 0, 5]\n[initial]\nuniform = [0, 0, 1]\n";
  };
  for (int const cells : {3, 4, 5}) {
    auto const scene = write("scene.toml", dipoles(cells));
    auto const count = std::to_string(cells);
    for (Arguments const& waves : {Arguments{"--wave-vector", "0.1,0,0"},
                                   {"--wave-vector", "0,0,0", "--wave-vector", "0.5,0,0"}})
      expect_refused(joined({"modes", scene, "--overwrite"}, waves),
                     " along x, and the field of dipoles reaches around the lattice; accepted: "
                     "multiples of 1/" +
                         count + " there, also between corners (--points)");
    EXPECT_EQ(start({"modes", scene, "--overwrite", "--quiet", "--count", count}).status, 0);
    auto const all = numbers("frequency");
    EXPECT_EQ(start({"modes", scene, "--overwrite", "--quiet", "--wave-vector", "0,0,0",
                     "--wave-vector", "1,0,0", "--points", count})
                  .status,
              0);
    auto waves = numbers("frequency");
    ASSERT_EQ(waves.size(), static_cast<std::size_t>(cells) + 1);
    EXPECT_NEAR(waves.front(), waves.back(), 1e-10);
    waves.pop_back();
    std::ranges::sort(waves);
    ASSERT_EQ(all.size(), waves.size());
    for (std::size_t i = 0; i < waves.size(); ++i) EXPECT_NEAR(waves[i], all[i], 1e-9) << i;
  }
}

// With the curvatures 0.1 and 1.1, the rates without precession are -0.1 and -1.1. With precession
// and a damping of 1, rate^2 + 1.2 * rate + 2 * 0.11 = 0.
TEST_F(Bands, KeepTheRealRateThatDecaysLeast) {
  for (auto const& [precession, decay] :
       {std::pair{"false", 0.1}, {"true", 0.6 - std::sqrt(0.36 - 0.22)}})
    for (std::string const precision : {"double", "single"}) {
      auto const outcome = modes(
          film, {"--wave-vector", "0,0,0", "--at-rest", "--quiet", "--overwrite", "--precision",
                 precision, "--set",
                 "system={kind=\"llg\", damping=1.0, precession=" + std::string(precession) + "}",
                 "--set", "lattice.boundary=\"periodic\"", "--set", "initial={uniform=[1, 0, 0]}"});
      EXPECT_EQ(outcome.status, 0) << outcome.errors;
      // Exchange is 400 times as strong as the anisotropy.
      EXPECT_NEAR(numbers("decay").at(0), decay, precision == "double" ? 1e-10 : 1e-4);
      EXPECT_NEAR(numbers("frequency").at(0), 0, 1e-11);
    }
}

// The demagnetising field of a film is a sum of many small parts, beside strong exchange.
TEST_F(Bands, HaveTheWholeDipolarFieldInSinglePrecision) {
  std::string const large =
      "[system]\nkind = \"llg\"\ndamping = 0\n[lattice]\nshape = [32, 32]\n"
      "boundary = \"periodic\"\n[field]\nexchange = 2.0\ndemag = true\n"
      "applied = [0.05, 0, 0]\n[initial]\nuniform = [1, 0, 0]\n"
      "[integrator]\nmethod = \"heun\"\ndt = 0.01\nsteps = 1\n";
  std::vector<double> lowest;
  for (std::string const precision : {"double", "single"}) {
    auto const outcome = modes(large, {"--wave-vector", "0,0,0", "--torque", "1e-5", "--quiet",
                                       "--overwrite", "--precision", precision});
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    lowest.push_back(numbers("frequency").at(0));
  }
  EXPECT_GT(lowest[0], 0.1);
  EXPECT_NEAR(lowest[1] / lowest[0], 1, 3e-3);
}

// The lowest frequency is less than 1e-5 of the largest. In single precision, round-off of the
// Hessian changes it by about 1 %, and must not decide its sign.
TEST_F(Bands, HaveLowFrequenciesInBothPrecisions) {
  std::string const bcc = R"toml([system]
kind = "llg"
damping = 0.0
[lattice]
shape = [3, 3, 3]
crystal = "bcc"
boundary = "periodic"
[field]
couplings = { shells = [1.0] }
anisotropy = { constant = 1e-4, axis = [0, 0, 1] }
[initial]
uniform = [0, 0, 1]
)toml";
  for (std::string const precision : {"double", "single"})
    for (std::string const damping : {"0", "0.05"}) {
      auto const outcome =
          modes(bcc, {"--wave-vector", "0,0,0", "--quiet", "--overwrite", "--precision", precision,
                      "--set", "system.damping=" + damping});
      EXPECT_EQ(outcome.status, 0) << outcome.errors;
      // Elements of the Hessian are up to 8, with errors of a few 1e-7 in single precision.
      double const error = precision == "double" ? 1e-12 : 2e-5;
      auto const frequency = numbers("frequency"), decay = numbers("decay");
      ASSERT_EQ(frequency.size(), 2U);
      EXPECT_NEAR(frequency[0], 1e-4, error) << precision << damping;
      EXPECT_NEAR(frequency[1], 16.0001, error) << precision << damping;
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(decay[i] / frequency[i], std::stod(damping), 1e-3) << precision << damping;
    }
}

TEST_F(Bands, RefuseWhatHasNone) {
  auto const refused = [&](Arguments const& more, std::string const& part) {
    expect_refused(joined({"modes", write("scene.toml", film), "--wave-vector"}, more), part);
    EXPECT_FALSE(exists("modes.h5"));
  };
  refused({"0.1,0,0"}, "lattice.boundary");
  refused({"0.1,0"}, "three numbers");
  refused(
      {"0.1,0,0", "--set", "lattice.boundary=\"periodic\"", "--set", "lattice.frozen=\"i < 1\""},
      "the cells differ");
  refused({"0,0,0", "--at-rest", "--set", "lattice.boundary=\"periodic\"", "--set",
           "lattice.regions=\"i < 4 ? 0 : 1\"", "--set",
           "field.anisotropy={constant={regions=[0.5, 2.0]}, axis=[0, 0, 1]}", "--set",
           "initial={uniform=[0, 0, 1]}"},
          "the cells differ");
  std::string const strip = "lattice.boundary=[\"periodic\",\"open\"]";
  refused({"0,0.3,0", "--set", strip}, "along y, which is open; accepted: 0 there");
  refused({"0.3,0,0", "--set", strip, "--set", "lattice.shape=[1,8]"},
          "1 cell along x, and bonds reach over 1 cell; accepted: at least 2");
  refused({"0.3,0,0", "--set", "lattice.boundary=[\"periodic\",\"open\",\"open\"]", "--set",
           "lattice.shape=[3,40,40]"},
          "has 1600 sites in a cell, which extends over the open axes");
}

}  // namespace
}  // namespace cayspin::program::test
