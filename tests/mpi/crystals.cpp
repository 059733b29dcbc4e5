// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes with crystals, couplings, currents and site-dependent numbers give the same numbers on
// several ranks as on one.
#include "on_ranks.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program::test {
namespace {

/// Returns a scene made of these parts, with 12 steps.
std::string scene_of(std::string const& lattice_and_field, std::string const& integrator,
                     std::string const& damping = "0.1") {
  return fmt::format(R"toml([system]
kind = "llg"
damping = {}
{}
[initial]
expression = ["cos(5*x + 2*y)", "sin(3*z + y)", "x - 0.3*k"]
[integrator]
{}
steps = 12
[output]
every = 6
scalars_every = 3
)toml",
                     damping, lattice_and_field, integrator);
}

std::string const heun = "method = \"heun\"\ndt = 0.02";

std::string const bcc = R"toml([lattice]
shape = [5, 6, 8]
crystal = "bcc"
boundary = ["open", "periodic", "open"]
moments = [1, 0.6]
gyromagnetic = [1, 1.3]
[field]
couplings = { shells = [1, -0.25] }
applied = ["0.5*cos(7*t)", "0.1", "0.4"])toml";

class CrystalsOnRanks : public OnRanks {
 protected:
  /// Expects divided runs to equal a run on one rank. `divisions`: pairs of the number of ranks and
  /// the value of --ranks.
  void expect_bits_of_one(std::string const& text,
                          std::vector<std::pair<int, std::string>> const& divisions,
                          Arguments const& more = {}) const {
    auto const scene = write("scene.toml", text);
    auto const one = start(run_of(scene, "one.h5", more));
    ASSERT_EQ(one.status, 0) << one.errors;
    auto const frames = read_dataset("one.h5", "spins").values;
    auto const of_frame = frames.begin() + static_cast<std::ptrdiff_t>(frames.size() / 3);
    ASSERT_FALSE(std::equal(frames.begin(), of_frame, frames.end() - (of_frame - frames.begin())))
        << "nothing moved";
    for (auto const& [ranks, cut] : divisions) {
      SCOPED_TRACE(cut);
      auto in_parts = more;
      in_parts.insert(in_parts.end(), {"--ranks", cut});
      auto const outcome = start_on(ranks, run_of(scene, "many.h5", in_parts));
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      EXPECT_EQ(outcome.errors, one.errors);
      expect_same("one.h5", "many.h5");
      if (contains(text, "crystal =") || contains(text, "basis =")) {
        for (char const* dataset : {"sublattice_magnetization", "positions"})
          EXPECT_EQ(read_dataset("many.h5", dataset).values, read_dataset("one.h5", dataset).values)
              << dataset;
      }
    }
  }

  /// Writes a file with /values of these extents into the folder of the test, and returns its path.
  std::string values_file(std::string const& name, std::vector<hsize_t> const& extents) const {
    hsize_t count = 1;
    for (auto const extent : extents) count *= extent;
    std::vector<double> values(count);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = 0.2 + 0.1 * std::sin(static_cast<double>(i));
    auto const path = in_folder(name).string();
    auto const file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    auto const space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
    auto const data =
        H5Dcreate2(file, "values", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(data), H5Sclose(space), H5Fclose(file);
    return path;
  }
};

TEST_F(CrystalsOnRanks, HaveTheBitsOfOneRank) {
  expect_bits_of_one(scene_of(bcc, heun), {{2, "1,2"}, {3, "3,1"}, {4, "2,2"}});
  expect_bits_of_one(scene_of(bcc, heun), {{3, "1,3"}}, {"--precision", "single"});
  // 16 sites in a cell, and a periodic z.
  expect_bits_of_one(scene_of("[lattice]\nshape = [3, 4, 3]\ncrystal = 'pyrochlore'\n"
                              "boundary = 'periodic'\n[field]\ncouplings = { shells = [0.5] }\n",
                              heun),
                     {{3, "1,3"}, {4, "2,2"}});
}

TEST_F(CrystalsOnRanks, HaveDipoles) {
  for (std::string const boundary : {"open", "periodic"}) {
    SCOPED_TRACE(boundary);
    auto const scene =
        scene_of(fmt::format("[lattice]\nshape = [4, 6, 5]\ncrystal = 'bcc'\nmoments = [1, 0.5]\n"
                             "boundary = ['open', 'periodic', '{}']\n[field]\ndipoles = true\n"
                             "couplings = {{ shells = [0.5] }}\n",
                             boundary),
                 heun);
    expect_bits_of_one(scene, {{2, "1,2"}, {3, "3,1"}, {4, "2,2"}});
    expect_bits_of_one(scene, {{3, "1,3"}}, {"--precision", "single"});
  }
}

// Bonds of every kind, which reach over more rows and planes than a step has stages.
TEST_F(CrystalsOnRanks, MayHaveBondsOfLongReach) {
  for (std::string const boundary : {"open", "periodic"}) {
    SCOPED_TRACE(boundary);
    expect_bits_of_one(scene_of(fmt::format(R"toml([lattice]
shape = [5, 7, 9]
basis = [[0, 0, 0], [0.3, 0.4, 0.5], [0.6, 0.1, 0.2]]
boundary = "{}"
[field]
couplings = [
  {{ between = [0, 1], J = 1, D = [0.1, 0.2, -0.1] }},
  {{ between = [1, 2], offset = [1, -3, 1], J = -0.5 }},
  {{ between = [2, 0], offset = [0, 1, 3], tensor = [[0.2, 0.1, 0], [0, 0.3, 0], [0.1, 0, -0.1]] }},
  {{ between = [1, 1], offset = [-2, 0, 2], J = 0.3, biquadratic = 0.2 }},
])toml",
                                            boundary),
                                heun),
                       {{2, "1,2"}, {2, "2,1"}, {3, "1,3"}, {4, "2,2"}});
  }
}

TEST_F(CrystalsOnRanks, HaveVacanciesFrozenSpinsAndNoise) {
  auto const text = scene_of(R"toml([lattice]
shape = [6, 8, 6]
crystal = "bcc"
boundary = ["periodic", "open", "periodic"]
moments = [1, 2]
occupied = "(x - 0.5)^2 + (y - 0.5)^2 + 0.1*z < 0.3"
frozen = "k == 3 && s == 1"
[field]
couplings = { shells = [1, 0.2] }
anisotropy = [ { cubic = 0.5, axes = [[1, 1, 0], [0, 0, 1]], site = 1 }, { constant = 0.3, axis = [0, 1, 2], site = 0 } ])toml",
                             heun);
  expect_bits_of_one(text, {{2, "1,2"}, {4, "2,2"}});
  expect_bits_of_one(text, {{2, "2,1"}, {3, "1,3"}},
                     {"--set", "thermal={temperature=0.5,seed=3}", "--precision", "single"});
}

TEST_F(CrystalsOnRanks, HaveNumbersOfSites) {
  auto const values = values_file("values.h5", {9, 8, 5});
  expect_bits_of_one(scene_of(fmt::format(R"toml([lattice]
shape = [5, 8, 9]
boundary = ["open", "open", "periodic"]
[field]
exchange = "1 + 0.3*x + 0.2*sin(5*y + 3*z)"
dmi = {{ bulk = {{ file = "{0}" }} }}
anisotropy = [ {{ constant = {{ file = "{0}" }}, axis = [1, 2, 3] }}, {{ constant = "x + z", axis = [0, 0, 1] }} ])toml",
                                          values),
                              heun, "\"0.1 + 0.05*cos(4*y + 6*z)\""),
                     {{3, "3,1"}, {4, "2,2"}});
  auto const of_crystal = values_file("of_crystal.h5", {2, 8, 6, 5});
  expect_bits_of_one(
      scene_of(
          bcc + fmt::format("\nanisotropy = {{ constant = {{ file = \"{}\" }}, axis = [1, 0, 1], "
                            "site = 1 }}",
                            of_crystal),
          heun),
      {{3, "1,3"}});
}

TEST_F(CrystalsOnRanks, HaveTorques) {
  expect_bits_of_one(scene_of(R"toml([lattice]
shape = [6, 9, 8]
spacing = [0.9, 1, 1.1]
boundary = ["open", "periodic", "open"]
[field]
exchange = 0.7
dmi = { bulk = 0.2 }
slab_demag = { normal = [0, 0, 1], where = "host" }
[torque]
zhang_li = { velocity = ["0.3*cos(t)", 0.2, -0.4], nonadiabaticity = 0.2 }
slonczewski = { damping_like = "0.1*t", field_like = 0.2, polarization = [0, 1, 0.5] })toml",
                              heun),
                     {{2, "1,2"}, {3, "3,1"}, {4, "2,2"}});
}

// Interlayer bonds reach over three rows and planes, further than the other terms of a stage.
TEST_F(CrystalsOnRanks, HaveTorquesOfSitesAndBondsAcrossSpacers) {
  std::string const layers = R"toml([lattice]
shape = [6, 12, 14]
boundary = ["open", "periodic", "open"]
regions = "(i + j) % 3"
occupied = "k % 5 != 2 && k % 5 != 3 && j != 4 && j != 5"
gyromagnetic = { regions = [1, 0.6, 1.7] }
[field]
exchange = 0.7
anisotropy = { constant = 0.4, axis = { regions = [[1, 2, 3], [0, 0, 1], [1, 0, 0]] } })toml";
  std::string const bonds = R"toml(
interlayer = [ { between = [0, 0], J = -0.2, biquadratic = 0.03, range = 2 } ])toml";
  std::string const torque = R"toml(
[torque.slonczewski]
damping_like = { profile = "0.1*i", time = "cos(t)" }
field_like = { regions = [0.1, -0.2, 0.3] }
lambda = 1.6
polarization = { regions = [[0, 1, 0.5], [1, 0, 0], [0, 0, 1]] })toml";
  // The second bond is longer than y and z, and leaves the reach of the first as it is.
  std::string const with_long = R"toml(
interlayer = [
  { between = [0, 0], J = -0.2, biquadratic = 0.03, range = 2 },
  { between = [0, 0], J = 0.1, range = 13 },
])toml";
  for (auto const& text : {layers + torque, layers + bonds + torque, layers + with_long + torque})
    expect_bits_of_one(scene_of(text, heun), {{2, "1,2"}, {3, "3,1"}, {4, "2,2"}});
}

// The bonds at the start, which takes no steps, reach further than those of the stage after it.
TEST_F(CrystalsOnRanks, HaveGhostsAsDeepAsAnyStageNeeds) {
  expect_bits_of_one(R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [6, 12, 14]
regions = "i % 2"
occupied = "k % 5 != 2 && k % 5 != 3 && j != 4"
[field]
exchange = 0.7
applied = [0.3, 0.1, 0.2]
interlayer = [ { between = [0, 0], J = -0.2, range = 2 } ]
[initial]
expression = ["cos(5*x + 2*y)", "sin(3*z + y)", "x - 0.3*k"]
[output]
every = 6
[[stage]]
integrator = { method = "heun", dt = 0.02, steps = 12 }
field.interlayer = [ { between = [0, 0], J = -0.2, range = 1 } ]
)toml",
                     {{2, "1,2"}, {3, "3,1"}, {4, "2,2"}});
}

TEST_F(CrystalsOnRanks, StepByEveryKindOfMethod) {
  for (std::string const method :
       {"euler\"\nisotropy = \"finite_difference", "ab2", "rkmk4\"\ncompensated = true #", "rkmk8",
        "implicit_midpoint", "projected_rk5"}) {
    SCOPED_TRACE(method);
    auto const integrator = fmt::format("method = \"{}\"\ndt = 0.02", method);
    // rkmk8 has 12 stages, and a part needs at least as many planes.
    expect_bits_of_one(scene_of(bcc, integrator), {{2, "1,2"}},
                       {"--set", "lattice.shape=[4,5,14]"});
  }
  for (std::string const method : {"tsit5", "projected_dp5"}) {
    SCOPED_TRACE(method);
    auto const integrator = fmt::format("method = \"{}\"\ntolerance = 1e-5\ndt = 0.02", method);
    expect_bits_of_one(scene_of(bcc, integrator), {{3, "1,3"}},
                       {"--set", "lattice.shape=[4,5,12]"});
  }
}

TEST_F(CrystalsOnRanks, GoOnFromFilesOfOtherRanks) {
  for (std::string const method : {"heun", "ab2"}) {
    SCOPED_TRACE(method);
    auto const scene = write(
        "scene.toml", scene_of(bcc, fmt::format("method = \"{}\"\ndt = 0.02", method)) +
                          (method == "heun" ? "[thermal]\ntemperature = 0.3\nseed = 5\n" : ""));
    ASSERT_EQ(start(run_of(scene, "whole.h5")).status, 0);
    Arguments const half{"--set", "integrator.steps=6"};
    ASSERT_EQ(start_on(3, run_of(scene, "begin.h5", half)).status, 0);
    for (int const ranks : {1, 2, 4}) {
      auto const arguments = run_of(scene, "end.h5", {"--restart", "begin.h5"});
      auto const outcome = ranks == 1 ? start(arguments) : start_on(ranks, arguments);
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      EXPECT_EQ(last_spins("end.h5"), last_spins("whole.h5")) << ranks;
    }
  }
}

TEST_F(CrystalsOnRanks, NeedPartsOfWholeCellsAsThickAsBondsReach) {
  auto const far =
      write("far.toml", scene_of("[lattice]\nshape = [3, 7, 8]\ncrystal = 'bcc'\n"
                                 "[field]\ncouplings = [ { offset = [0, 4, 3], J = 1 } ]",
                                 heun));
  EXPECT_EQ(start_on(2, run_of(far, "out.h5", {"--ranks", "1,2"})).status, 0);
  for (std::string const cut : {"2,1", "1,3"})
    expect_refused(start_on(3, run_of(far, "out.h5", {"--ranks", cut})),
                   "of at least 4 rows or 6 planes each");
  auto const outcome = start_on(3, run_of(far, "out.h5"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors,
            "warning: 1 of 3 ranks has nothing to do: a part needs at least 4 rows or 6 planes\n");
  auto const stiff = write("stiff.toml", scene_of(bcc, "method = \"stiff2\"\ndt = 0.02"));
  expect_refused(start_on(2, run_of(stiff, "out.h5")), "runs only on one rank");
}

// An expression that fails on one rank ends the run on all ranks, with one line.
TEST_F(CrystalsOnRanks, SayOnceWhatIsWrongAtOneSite) {
  auto const text = [&](std::string const& lattice, std::string const& damping) {
    return write("scene.toml",
                 scene_of("[lattice]\nshape = [4, 6, 8]\n" + lattice + "\n[field]\nexchange = 1\n",
                          heun, damping));
  };
  expect_refused(start_on(3, run_of(text("frozen = '1/(k - 7)'", "0.1"), "out.h5")),
                 "lattice.frozen");
  expect_refused(start_on(3, run_of(text("", "\"0.1 - 0.2*(k == 7)\""), "out.h5")),
                 "is negative at a site");
  // Both parts have such sites.
  expect_refused(
      start_on(2,
               run_of(text("", "0.1"), "out.h5",
                      {"--ranks", "1,2", "--set",
                       "field.anisotropy={constant=1,axis=[0,0,'(k == 0 || k == 7) ? 0 : 1']}"})),
      "has no direction at site (0, 0, 0)");
}

}  // namespace
}  // namespace cayspin::program::test
