// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin path without --to: the lowest saddle around a state, and the state beyond it.
#include "hdf5/attribute.hpp"
#include "hdf5/handle.hpp"
#include "program_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>

namespace cayspin::program::test {
namespace {

struct Escapes : ProgramTest {
  void write_state(std::string const& text) const {
    expect_status(0, {"relax", write("scene.toml", text), "--output", "a.h5", "--quiet"});
  }
  Arguments arguments(Arguments const& more = {}) const {
    return joined({"path", in_folder("scene.toml"), "--from", "a.h5", "--output", "path.h5"}, more);
  }
  double attribute(char const* name) const {
    auto const path = in_folder("path.h5");
    auto const file = io::open_file(path);
    return io::RootAttributes(file.get(), path).read_real(name);
  }
  static std::string head(std::string const& lattice) {
    return "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\n" + lattice + "\n";
  }
};

// Both ways lead over a hard plane; that along the field is lower. The spins turn together.
TEST_F(Escapes, TakeTheLowerOfTwoWays) {
  write_state(head("shape = [3]") + R"toml([field]
exchange = 20.0
anisotropy = [{ constant = 1.3, axis = [0, 0, 1] }, { constant = -0.7, axis = [0, 1, 0] }]
applied = [0.4, 0, 0]
[initial]
uniform = [0, 0, 1]
)toml");
  for (std::string const modes : {"1", "4"}) {
    auto const outcome = start(arguments({"--modes", modes, "--overwrite"}));
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_TRUE(contains(outcome.output, "barriers 0.934615")) << outcome.output;
    double const barrier = 3 * 0.5 * 1.3 * std::pow(1 - 0.4 / 1.3, 2);
    EXPECT_NEAR(attribute("barrier_forward"), barrier, 1e-11);
    EXPECT_NEAR(attribute("barrier_backward"), barrier, 1e-11);
    EXPECT_NEAR(attribute("saddle_curvature"), 0.4 - 1.3, 1e-5);
    auto const saddle = read_dataset("path.h5", "/saddle").values;
    for (std::size_t site = 0; site < 3; ++site) EXPECT_NEAR(saddle.at(3 * site), 1, 1e-9);
    EXPECT_LT(read_dataset("path.h5", "/spins").values.back(), -0.9);
  }
  auto const info = output_of({"info", "path.h5"});
  EXPECT_TRUE(contains(info, "from         a.h5\n"));
  EXPECT_FALSE(contains(info, "\nto "));
}

// The weaker of two coupled spins turns first. Newton's method finds the angles of both.
TEST_F(Escapes, TurnTheWeakerSpin) {
  write_state(head("shape = [2]") + R"toml([field]
exchange = 0.1
anisotropy = [{ constant = "i == 0 ? 1.7 : 1.0", axis = [0, 0, 1] }, { constant = -0.5, axis = [0, 1, 0] }]
[initial]
uniform = [0, 0, 1]
)toml");
  double a = 0, b = 1.5;  // of the strong and of the weak spin
  for (int step = 0; step < 50; ++step) {
    double const s = 0.1 * std::sin(a - b), c = 0.1 * std::cos(a - b);
    double const ga = 0.85 * std::sin(2 * a) + s, gb = 0.5 * std::sin(2 * b) - s;
    double const aa = 1.7 * std::cos(2 * a) + c, bb = std::cos(2 * b) + c, det = aa * bb - c * c;
    a -= (bb * ga + c * gb) / det;
    b -= (aa * gb + c * ga) / det;
  }
  auto const energy = [](double strong, double weak) {
    return -0.85 * std::pow(std::cos(strong), 2) - 0.5 * std::pow(std::cos(weak), 2) -
           0.1 * (std::cos(strong - weak) - 1);
  };
  expect_status(0, arguments({"--quiet"}));
  EXPECT_NEAR(attribute("barrier_forward"), energy(a, b) - energy(0, 0), 1e-11);
  auto const spins = read_dataset("path.h5", "/spins").values;
  EXPECT_NEAR(spins.at(spins.size() - 4), 1, 0.1);
  EXPECT_NEAR(spins.back(), -1, 0.1);
}

// The two modes of lowest curvature move the skyrmion and do not change its energy. The next one
// changes its size, and leads to its collapse. The numbers are those of other programs. A coarse
// torque leaves the skyrmion at another place after the way back.
TEST_F(Escapes, CollapseASkyrmion) {
  write_state(head("shape = [16, 16]\nboundary = \"periodic\"") + R"toml([field]
exchange = 10.0
dmi = { bulk = 6.0 }
applied = [0, 0, 2.894190905]
[initial]
state = "bloch_skyrmion"
radius = 5
)toml");
  for (auto const& [precision, torque, tolerance] :
       {std::tuple{"double", "1e-6", 1e-6}, {"double", "1e-4", 1e-6}, {"single", "1e-4", 1e-2}}) {
    auto const outcome = start(arguments(
        {"--precision", precision, "--torque", torque, "--modes", "1", "--quiet", "--overwrite"}));
    ASSERT_EQ(outcome.status, 0) << precision << torque << outcome.errors;
    EXPECT_NEAR(attribute("barrier_forward"), 38.16697354, tolerance);
    EXPECT_NEAR(attribute("barrier_backward"), 49.38834616, tolerance);
    EXPECT_NEAR(attribute("saddle_curvature"), -11.821835, 10 * tolerance);
    auto const spins = read_dataset("path.h5", "/spins").values;
    double least = 1;
    for (std::size_t z = spins.size() - 3 * 256 + 2; z < spins.size(); z += 3)
      least = std::min(least, spins[z]);
    EXPECT_NEAR(least, 1, tolerance);  // the state beyond is uniform
  }
}

// A weak anisotropy is no zero mode beside strong exchange: two spins turn together.
TEST_F(Escapes, TurnStiffSpinsOverAWeakAnisotropy) {
  write_state(head("shape = [2]") + R"toml([field]
exchange = 20.0
anisotropy = [{ constant = 1e-3, axis = [0, 0, 1] }, { constant = -1e-3, axis = [0, 1, 0] }]
[initial]
uniform = [0, 0, 1]
)toml");
  for (std::string const modes : {"1", "2", "4"}) {
    expect_status(0, arguments({"--modes", modes, "--torque", "1e-9", "--quiet", "--overwrite"}));
    EXPECT_NEAR(attribute("barrier_forward"), 1e-3, 1e-10) << modes;
  }
}

// Sites 0 and 5 hold no spin and a frozen spin. In SI, energies are multiplied by the unit.
TEST_F(Escapes, KeepVacanciesAndFrozenSpins) {
  std::string const crystal = head(R"toml(crystal = "honeycomb"
shape = [2, 2]
occupied = "!(i == 0 && j == 0 && s == 0)"
frozen = "i == 1 && j == 0 && s == 1")toml") +
                              R"toml([field]
couplings = { shells = [0.05] }
anisotropy = [{ constant = 1.3, axis = [0, 0, 1] }, { constant = -0.4, axis = [0, 1, 0] }]
[initial]
uniform = [0, 0, 1]
)toml";
  write_state(crystal);
  expect_status(0, arguments({"--quiet"}));
  EXPECT_GT(attribute("barrier_forward"), 0.5 * 1.3);
  EXPECT_LT(attribute("barrier_forward"), 0.5 * 1.3 + 3 * 0.05 * 2);
  auto const first = read_dataset("a.h5", "/spins").values,
             images = read_dataset("path.h5", "/spins").values;
  std::size_t const numbers = first.size(), count = images.size() / numbers;
  ASSERT_EQ(count, 16U);
  int vacant = 0, still = 0;
  for (std::size_t site = 0; site < numbers; site += 3) {
    vacant += first[site] == 0 && first[site + 1] == 0 && first[site + 2] == 0;
    bool moves = false;
    for (std::size_t image = 0; image < count; ++image)
      for (std::size_t c = 0; c < 3; ++c)
        moves = moves || images[image * numbers + site + c] != first[site + c];
    still += !moves;
  }
  EXPECT_EQ(vacant, 1);
  EXPECT_EQ(still, 2);
}

// E = -K m_z^2 - mu_s B m_x of one spin.
TEST_F(Escapes, AreInJoulesInSi) {
  write_state(R"toml(units = "SI"
[system]
kind = "llg"
[material]
mu_s = { bohr_magnetons = 2.0 }
alpha = 0.1
damping_form = "gilbert"
K = 1e-22
axis = [0, 0, 1]
[lattice]
shape = [1]
spacing = 3e-10
[field]
applied = [0.1, 0, 0]
[initial]
uniform = [0, 0, 1]
)toml");
  expect_status(0, arguments({"--torque", "1e-9", "--quiet"}));
  double const moment = 2 * 9.2740100783e-24, k = 1e-22;
  double const barrier = k * std::pow(1 - moment * 0.1 / (2 * k), 2);
  EXPECT_NEAR(attribute("barrier_forward") / barrier, 1, 1e-9);
}

// The limit counts the evaluations of the state, its modes, the climbs and the path.
TEST_F(Escapes, EndAtTheLimitOfEvaluations) {
  write_state(head("shape = [3]") + R"toml([field]
exchange = 20.0
anisotropy = [{ constant = 1.3, axis = [0, 0, 1] }, { constant = -0.7, axis = [0, 1, 0] }]
[initial]
uniform = [0, 0, 1]
)toml");
  for (std::string const most : {"60", "150"}) {
    auto const outcome = start(arguments({"--evaluations", most, "--overwrite"}));
    EXPECT_EQ(outcome.status, 3);
    EXPECT_TRUE(contains(outcome.errors, "evaluation limit, after ")) << outcome.errors;
  }
}

// Without other terms, a field has one minimum and one maximum.
TEST_F(Escapes, AreNotFoundWhereThereIsOneState) {
  write_state(head("shape = [1]") +
              "[field]\napplied = [0, 0, 1]\n[initial]\nuniform = [0, 0, 1]\n");
  auto const outcome = start(arguments());
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(contains(outcome.errors, "no path: no saddle found, after ")) << outcome.errors;
  EXPECT_FALSE(exists("path.h5"));
}

TEST_F(Escapes, RefuseWrongOptions) {
  write_state(head("shape = [1]") +
              "[field]\napplied = [0, 0, 1]\n[initial]\nuniform = [0, 0, 1]\n");
  expect_refused(arguments({"--modes", "0"}), "--modes 0; accepted: a whole number from 1 to 100");
  expect_refused(arguments({"--modes", "2", "--to", "a.h5"}),
                 "--modes: --to names the other end; accepted: one of them");
  EXPECT_FALSE(exists("path.h5"));
}

}  // namespace
}  // namespace cayspin::program::test
