// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Lattices that follow a wall, a skyrmion or a vortex. The wall's velocity is compared with that on
// a lattice long enough not to follow it.
#include "scenes_of_text.hpp"
#include "simulation/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace cayspin::simulation::test {
namespace {

constexpr double spacing = 0.25, dt = 0.01, hard = 2, damping = 0.1,
                 applied = 0.5 * damping * hard / 2;

// Walker's wall in half of Walker's limiting field, along z. It has m_z = 1 on its left and moves
// along +x. The easy axis is z, the hard axis y.
std::string wall(int cells, std::string const& method, int steps) {
  auto const x = fmt::format("{}*(i - {} + 0.5)", spacing, cells / 2);
  return fmt::format(R"toml(
[system]
kind = "llg"
damping = {}
[lattice]
shape = [{}]
spacing = {}
[field]
exchange = 1.0
anisotropy = [ {{ constant = 1.0, axis = [0, 0, 1] }}, {{ constant = {}, axis = [0, 1, 0] }} ]
applied = [0, 0, {}]
[initial]
expression = ["1/cosh({})", "0.2/cosh({})", "-tanh({})"]
[integrator]
{}
dt = {}
steps = {}
)toml",
                     damping, cells, spacing, -hard, applied, x, x, x, method, dt, steps);
}

std::vector<std::string> const following = {"lattice.follow={axis='x',quantity='mz'}"};

// Returns the wall's position: the mean of m_z gives the number of cells that point up, to which
// the shift is added.
double place_of_wall(SceneRun& run, int cells) {
  auto const mean = run.sample().magnetization.z;
  return spacing * (0.5 * cells * (1 + mean) + static_cast<double>(run.shift()));
}

// An adaptive method keeps the spins of the last step that the follower has seen.
TEST(Following, ARunWhoseFieldFailsSaysTheStepOfItsSpins) {
  auto scene = scene_of(wall(240, "method = \"tsit5\"\ntolerance = 1e-6", 200), following);
  auto const fails = std::make_shared<bool>(false);
  scene.field.own.uniform = [fails](double t) {
    if (*fails && t > 0.775) throw std::runtime_error("once");
    return std::array<double, 3>{0, 0, applied};
  };
  auto const run = SceneRun::open(scene, {}), same = SceneRun::open(scene, {});
  *fails = true;
  EXPECT_THROW(run->advance(200), std::runtime_error);
  EXPECT_GT(run->steps(), 0);
  same->advance(run->steps());
  EXPECT_LT(largest_distance(spins_of(*run), spins_of(*same)), 1e-4);
}

TEST(Following, AWallGoesAsFastAsInALongStrip) {
  constexpr int begin = 2000, steps = 8000, few = 240, many = 640;
  std::string const method = "method = \"rkmk4\"";
  double velocities[2];
  for (bool const follows : {false, true}) {
    int const cells = follows ? few : many;
    auto const scene =
        scene_of(wall(cells, method, steps), follows ? following : std::vector<std::string>());
    auto const run = SceneRun::open(scene, {});
    run->advance(begin, {.period = 10});
    double const from = place_of_wall(*run, cells);
    run->advance(steps - begin, {.period = 10});
    velocities[follows] = (place_of_wall(*run, cells) - from) / (dt * (steps - begin));
    if (!follows) continue;
    // The wall has left the cells in which it started.
    EXPECT_GT(run->shift(), few / 2);
    EXPECT_LT(std::abs(run->sample().magnetization.z), 4.0 / few);
  }
  EXPECT_NEAR(velocities[1], velocities[0], 1e-8 * velocities[0]);
  double const sine = 2 * applied / (damping * hard);  // of twice the wall's angle to the x axis
  double const square = (1 - std::sqrt(1 - sine * sine)) / 2;
  double const width = 1 / std::sqrt(1 + hard * square);
  double const closed = (1 + damping * damping) / damping * applied * width;
  EXPECT_NEAR(velocities[1], closed, 0.02 * closed);
}

// Spins move by whole cells, and entering cells copy the last ones.
TEST(Following, MovesSpinsByWholeCells) {
  for (auto const& [axis, shape, k] :
       {std::tuple{"x", "[24, 3, 2]", "i"}, {"y", "[3, 24, 2]", "j"}, {"z", "[2, 3, 24]", "k"}}) {
    SCOPED_TRACE(axis);
    // There is no field, so nothing moves the wall, which is five cells off the middle.
    auto const scene = scene_of(fmt::format(R"toml(
system = {{ kind = "llg", damping = 0.1 }}
lattice = {{ shape = {}, follow = {{ axis = "{}", quantity = "my" }} }}
initial = {{ expression = ["0.01*{} + 0.1*({} - 2)^2/400", "{} < 17 ? 1 : -1", "0"] }}
integrator = {{ method = "rkmk4", dt = 0.02, steps = 2 }}
)toml",
                                            shape, axis, k, k, k));
    for (auto const precision : precisions) {
      auto const run = SceneRun::open(scene, {.precision = precision});
      auto const before = spins_of(*run);
      run->advance(2);
      EXPECT_NEAR(static_cast<double>(run->shift()), 5, 1);
      auto const after = spins_of(*run);
      auto const stride = axis[0] == 'x' ? 1 : axis[0] == 'y' ? 3 : 6;
      for (std::int64_t site = 0; site < 144; ++site) {
        auto const at = site / stride % 24;
        auto const from = site + (std::min<std::int64_t>(at + run->shift(), 23) - at) * stride;
        for (std::int64_t c = 0; c < 3; ++c)
          EXPECT_EQ(after[static_cast<std::size_t>(3 * site + c)],
                    before[static_cast<std::size_t>(3 * from + c)])
              << site;
      }
    }
  }
}

TEST(Following, ASkyrmionAndAVortexComeIntoTheMiddle) {
  for (std::string const start : {"{ state = \"neel_skyrmion\", radius = 4, center = [0.36, 0.5] }",
                                  "{ state = \"vortex\", center = [0.36, 0.5] }"}) {
    SCOPED_TRACE(start);
    auto const scene = scene_of(fmt::format(R"toml(
system = {{ kind = "llg", damping = 0.1 }}
lattice = {{ shape = [33, 33], follow = {{ axis = "x", quantity = "charge" }} }}
field = {{ exchange = 1e-9 }}
initial = {}
integrator = {{ method = "rkmk4", dt = 0.02, steps = 3 }}
)toml",
                                            start));
    auto const run = SceneRun::open(scene, {});
    run->advance(3);
    EXPECT_NEAR(static_cast<double>(run->shift()), (0.36 - 0.5) * 33, 1);
  }
}

// The energy of a damped run falls, except when cells enter. Such a rise must not stop the run.
TEST(Following, IsNotTakenForAnEnergyThatRises) {
  auto const scene = scene_of(wall(160, "method = \"heun\"", 1500), following);
  auto const run = SceneRun::open(scene, {});
  auto const first = run->sample().energy.value;
  run->advance(1500, {.period = 1});
  EXPECT_GT(run->shift(), 10);
  // On a long strip the energy would fall further, since the wall's motion turns spins into the
  // field.
  EXPECT_LT(first - run->sample().energy.value, applied * static_cast<double>(run->shift()));
}

TEST(Following, GoesOnFromItsShiftAfterAChange) {
  auto const run = SceneRun::open(scene_of(wall(160, "method = \"rkmk4\"", 1500), following), {});
  run->advance(1500);
  auto const shift = run->shift();
  EXPECT_GT(shift, 10);
  run->change({"system.damping=0.2"});
  EXPECT_EQ(run->shift(), shift);
  EXPECT_EQ(run->more_of_sample(), std::vector{static_cast<double>(shift)});
}

TEST(Following, HasTheSameBitsAfterABreak) {
  for (std::string const method :
       {"heun", "rkmk4", "projected_rk4", "red_black2", "stiff2", "tsit5\"\ntolerance = 1e-6\n#",
        "rkmk4\"\ncompensated = true\n#"}) {
    SCOPED_TRACE(method);
    auto const text = wall(80, "method = \"" + method + "\"", 400);
    for (int const cut : {151, 200}) {
      auto scene = scene_of(text, following);
      expect_same_bits_after_a_break(scene, cut);
      auto const run = SceneRun::open(scene, {});
      run->advance(400);
      EXPECT_GT(run->shift(), 1);
    }
  }
  auto const warm = scene_of(wall(80, "method = \"heun\"", 300),
                             {following[0], "thermal={temperature=1e-4,seed=3}"});
  expect_same_bits_after_a_break(warm, 151, Precision::single_precision);
  auto const multirate = scene_of(wall(80, "method = \"rkmk4\"\nsubsteps = 2", 300),
                                  {following[0],
                                   "field.slab_demag={normal=[1,0,0],strength=0.1,"
                                   "where='host',multirate=true}"});
  expect_same_bits_after_a_break(multirate, 151);
  auto const held = scene_of(wall(80, "method = \"rkmk4\"\nenergy_control = true", 300),
                             {following[0], "system.damping=0"});
  expect_same_bits_after_a_break(held, 151);
}

TEST(Following, StepsTakenOneByOneHaveTheSameBits) {
  auto const scene = scene_of(wall(80, "method = \"rkmk4\"", 300), following);
  auto const one_by_one = SceneRun::open(scene, {}), at_once = SceneRun::open(scene, {});
  for (int step = 0; step < 300; ++step) one_by_one->advance(1);
  at_once->advance(300);
  EXPECT_EQ(spins_of(*one_by_one), spins_of(*at_once));
  EXPECT_EQ(one_by_one->shift(), at_once->shift());
  EXPECT_GT(at_once->shift(), 1);
}

TEST(Following, WhatStandsStillIsRefused) {
  auto const text = wall(80, "method = \"rkmk4\"", 10);
  auto const refused = [&](std::string const& change, std::string const& words) {
    expect_refused([&] { return scene_of(text, {following[0], change}); }, words);
  };
  std::string const along = " differs along x, along which lattice.follow moves the lattice";
  refused("lattice.regions='i % 2'", "lattice.follow: lattice.regions" + along);
  refused("lattice.occupied='i > 3'", "lattice.follow: lattice.occupied" + along);
  refused("lattice.frozen='i == 0'", "lattice.follow: lattice.frozen" + along);
  refused("lattice.moments='1 + x'", "lattice.follow: lattice.moments" + along);
  refused("field.exchange='1 + x'", "lattice.follow: field.exchange" + along);
  refused("field.sources=[{profile=['x',0,0]}]", "lattice.follow: field.sources" + along);
  refused("system.damping='x'", "lattice.follow: system.damping" + along);
  refused("lattice.boundary='periodic'", "the lattice is periodic along x");
  refused("lattice.follow.axis='y'", "the lattice has only one cell along y");
  refused("lattice.follow.axis='a'", "lattice.follow.axis: ");
  refused("lattice.follow.quantity='charge'", "the charge is that of planes along x and y");
  refused("lattice.follow.value=1.5", "lattice.follow.value: ");
  refused("lattice.follow=true", "lattice.follow: ");
  // These values are uniform along the axis.
  auto const alike =
      scene_of(text, {following[0], "lattice.shape=[80,2]", "lattice.regions='j'",
                      "field.exchange='1 + y'", "field.sources=[{profile=['y',0,0]}]"});
  EXPECT_NO_THROW(make_plan(alike, Precision::double_precision));
}

}  // namespace
}  // namespace cayspin::simulation::test
