// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The named values of initial.state, compared with closed forms.
#include "initial_states.hpp"

#include "wrong_scenes.hpp"

#include <cmath>
#include <numbers>

namespace cayspin::inline v0_2::io::test {
namespace {

constexpr double pi = std::numbers::pi;

TEST(InitialStates, VortexCirclesAboutItsCore) {
  for (double const circulation : {1, -1})
    for (double const polarity : {1, -1}) {
      auto const state = state_of(
          fmt::format("state='vortex', circulation={}, polarity={}, radius=1.3, center=[0.6, 0.25]",
                      circulation, polarity),
          {"lattice={shape=[10, 16, 2], spacing=[1, 0.5, 3]}"});
      state.for_each([&](Triple const& at, Triple const& m) {
        double const x = at[0] - 6, y = at[1] - 2, r = std::hypot(x, y);
        double const theta = r < 1.3 ? 2 * std::atan(r / 1.3) : pi / 2;
        expect_near(m, {-circulation * std::sin(theta) * y / r,
                        circulation * std::sin(theta) * x / r, polarity * std::cos(theta)});
      });
    }
}

TEST(InitialStates, VortexHasACoreOfThreeCellsInTheMiddle) {
  auto const state = state_of("state='vortex'", {"lattice={shape=[21, 21], spacing=[1, 2]}"});
  expect_near(state.at(10, 10), {0, 0, 1});
  expect_near(state.at(16, 10), {0, 1, 0});
  expect_near(state.at(4, 10), {0, -1, 0});
  expect_near(state.at(10, 13), {-1, 0, 0});
  EXPECT_GT(state.at(15, 10)[2], 0.1);
}

// theta(r) falls from pi at r = 0 to 0, and is pi / 2 at r = radius.
Triple skyrmion(bool bloch, double polarity, double chirality, std::array<double, 2> const& way) {
  double const radius = 6, width = 2, r = std::hypot(way[0], way[1]);
  double const theta = 2 * std::atan(std::sinh(radius / width) / std::sinh(r / width));
  double const x = r > 0 ? way[0] / r : 0, y = r > 0 ? way[1] / r : 0;
  double const in_plane = chirality * std::sin(theta), m_z = -polarity * std::cos(theta);
  return bloch ? Triple{-in_plane * y, in_plane * x, m_z} : Triple{in_plane * x, in_plane * y, m_z};
}

TEST(InitialStates, SkyrmionsHaveTheProfileOfAWallOf360Degrees) {
  for (bool const bloch : {false, true})
    for (double const polarity : {1, -1})
      for (double const chirality : {1, -1}) {
        auto const state = state_of(
            fmt::format("state='{}_skyrmion', polarity={}, chirality={}, radius=6, width=2",
                        bloch ? "bloch" : "neel", polarity, chirality),
            {"lattice={shape=[41, 31, 2], spacing=[1, 1.5, 1]}"});
        state.for_each([&](Triple const& at, Triple const& m) {
          expect_near(m, skyrmion(bloch, polarity, chirality, {at[0] - 20.5, at[1] - 23.25}));
        });
        expect_near(state.at(20, 15), {0, 0, polarity});
        expect_near(state.at(26, 15), bloch ? Triple{0, chirality, 0} : Triple{chirality, 0, 0});
        expect_near(state.at(20, 19), bloch ? Triple{-chirality, 0, 0} : Triple{0, chirality, 0});
        EXPECT_GT(-polarity * state.at(0, 0)[2], 0.99);
      }
}

TEST(InitialStates, SkyrmionsHaveTheChargeOfTheirPolarity) {
  for (std::string const kind : {"neel", "bloch"})
    for (int const polarity : {1, -1}) {
      auto const keys = fmt::format("state='{}_skyrmion', polarity={}, ", kind, polarity);
      for (std::string const rest : {"center=[0.5, 0.5]", "center=[0, 0.9]", "chirality=-1"}) {
        auto const state = state_of(
            keys + rest, {"lattice={shape=[24, 30], boundary='periodic', spacing=[1, 0.8]}"});
        EXPECT_NEAR(state.charge(), polarity, 1e-12) << kind << rest;
      }
    }
}

TEST(InitialStates, SkyrmionsHaveAQuarterOfTheLatticeAsRadiusAndHalfOfThatAsWidth) {
  std::string const lattice = "lattice={shape=[48, 40], spacing=[0.5, 1]}";
  EXPECT_EQ(state_of("state='neel_skyrmion'", {lattice}).spins,
            state_of("state='neel_skyrmion', polarity=-1, chirality=1, center=[0.5, 0.5], "
                     "radius=6, width=3",
                     {lattice})
                .spins);
}

TEST(InitialStates, SkyrmionsOfAnyWidthAreFinite) {
  for (std::string const width : {"1e-3", "1e-10", "1e-300", "1e10"}) {
    auto const state =
        state_of("state='bloch_skyrmion', radius=4, width=" + width, {"lattice={shape=[21, 21]}"});
    expect_near(state.at(10, 10), {0, 0, -1});
    expect_near(state.at(14, 10), {0, 1, 0});
    if (width != "1e10") expect_near(state.at(15, 10), {0, 0, 1});
  }
}

TEST(InitialStates, PeriodicAxesWrapAroundACenter) {
  for (std::string const state : {"vortex", "neel_skyrmion"}) {
    std::string const lattice = "lattice={shape=[16, 12], boundary=['periodic', 'open']}";
    auto const middle = state_of("radius=3, state='" + state + "'", {lattice});
    auto const moved = state_of("radius=3, center=[0.125, 0.5], state='" + state + "'", {lattice});
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 16; ++i) expect_near(moved.at((i + 10) % 16, j), middle.at(i, j));
  }
}

TEST(InitialStates, OppositeDomainsHaveTheWallOfLandauAndLifshitz) {
  auto const state = state_of(
      "state='two_domains', axis='y', directions=[[0, 0, 2], [0, 0, -1]], wall=[3, 0, 0], "
      "position=0.25, width=1.5",
      {"lattice={shape=[2, 20], spacing=[1, 0.5]}"});
  state.for_each([&](Triple const& at, Triple const& m) {
    double const u = (at[1] - 2.5) / 1.5;
    expect_near(m, {1 / std::cosh(u), 0, -std::tanh(u)});
  });
}

TEST(InitialStates, DomainsAtAnAngleTurnTheShorterWay) {
  std::string const domains = "state='two_domains', directions=[[1, 0, 0], [0, 1, 0]]";
  std::string const lattice = "lattice={shape=[101, 2]}";
  auto const state = state_of(domains, {lattice});
  double const middle = std::sqrt(0.5);
  expect_near(state.at(0, 0), {1, 0, 0}, 1e-7);
  expect_near(state.at(50, 1), {middle, middle, 0});
  expect_near(state.at(100, 1), {0, 1, 0}, 1e-7);
  for (int i = 1; i < 101; ++i) EXPECT_GE(state.at(i, 0)[1], state.at(i - 1, 0)[1]);
  EXPECT_EQ(
      state_of(domains + ", axis='x', position=0.5, width=3, wall=[1, 1, 0]", {lattice}).spins,
      state.spins);
  expect_near(state_of(domains + ", wall=[0, 0, -1]", {lattice}).at(50, 0), {0, 0, -1});
}

TEST(InitialStates, HelixIsRightHandedAboutItsNormal) {
  auto const state = state_of("state='helix', period=8, phase=0.5",
                              {"lattice={shape=[12, 2, 2], spacing=[0.75, 1, 1]}"});
  state.for_each([&](Triple const& at, Triple const& m) {
    double const angle = 2 * pi * at[0] / 8 + 0.5;
    expect_near(m, {0, -std::sin(angle), std::cos(angle)});
  });
  auto const along_z = state_of("state='helix', period=5, direction=[0, 0, 3]");
  along_z.for_each([&](Triple const& at, Triple const& m) {
    double const angle = 2 * pi * at[2] / 5;
    expect_near(m, {std::cos(angle), std::sin(angle), 0});
  });
}

TEST(InitialStates, HelixMayBeACycloid) {
  auto const state = state_of("state='helix', period=5, direction=[1, 1, 0], normal=[-1, 1, 0]");
  double const half = std::sqrt(0.5);
  state.for_each([&](Triple const& at, Triple const& m) {
    double const angle = 2 * pi * half * (at[0] + at[1]) / 5;
    expect_near(m, {half * std::sin(angle), half * std::sin(angle), std::cos(angle)});
  });
}

TEST(InitialStates, SiteWithoutASpinIsZeroAndBodiesHaveStatesToo) {
  auto const disk = state_of("state='vortex'", {"lattice={shape=[5, 5], occupied='i>0'}"});
  expect_near(disk.at(0, 2), {0, 0, 0});
  expect_near(disk.at(2, 2), {0, 0, 1});
  auto const bodies = scene_of(body_scene, {"initial={state='helix', period=4}"});
  EXPECT_EQ(initial_spins(bodies).size(), 15U);
}

TEST(WrongScene, OfInitialState) {
  expect_refused(llg_scene, R"(
initial = { state = 'vortx' } | .state: "vortx" is not known, did you mean "vortex"?
  | accepted: "vortex", "neel_skyrmion", "bloch_skyrmion", "two_domains", "helix"
initial = { state = 1 } | .state: 1 is an integer | "vortex", "neel_skyrmion"
initial.state = 'vortex' | initial.uniform: does not go with state = "vortex"
  | accepted: state, circulation, polarity, radius, center
initial = { state = 'vortex', period = 3 } | .period: does not go with state = "vortex" | radius
initial = { state = 'helix', period = 3, center = [0, 0] } | .center: does not go with | normal
initial = { state = 'vortex', radios = 1 } | .radios: unknown key, did you mean | polarity
initial = { radius = 1 } | .radius: unknown key | accepted: uniform, expression, random, file, state
initial = { state = 'vortex', circulation = 0 } | .circulation: is 0 | 1 or -1
initial = { state = 'vortex', polarity = 1.0 } | .polarity: 1.0 is a number | 1 or -1
initial = { state = 'vortex', radius = 0 } | .radius: 0 is not positive | a length > 0
initial = { state = 'vortex', radius = inf } | .radius: inf is not finite | a length > 0
initial = { state = 'vortex', center = [0.5] } | .center: has 1 entries | two numbers from 0 to 1
initial = { state = 'vortex', center = [0, 25] } | .center[1]: 25 is outside | a number from 0 to 1
initial = { state = 'neel_skyrmion', polarity = 2 } | .polarity: is 2 | 1 or -1
initial = { state = 'bloch_skyrmion', chirality = 'left' } | .chirality: 'left' is a string | 1 or -1
initial = { state = 'bloch_skyrmion', width = -1 } | .width: -1 is not positive | a length > 0
initial = { state = 'bloch_skyrmion', wall = [1, 0, 0] } | .wall: does not go with | chirality
initial = { state = 'two_domains' } | .directions: is missing | two vectors
initial = { state = 'two_domains', directions = [0, 0, 1] } | .directions: has 3 entries | two vectors
initial = { state = 'two_domains', directions = [[1, 0, 0], [0, 0, 0]] }
  | .directions[1]: is a zero vector | not all zero
initial = { state = 'two_domains', directions = [[0, 0, 1], [0, 0, -3]] }
  | .wall: is missing: between opposite directions | a direction across
initial = { state = 'two_domains', directions = [[0, 0, 1], [0, 0, -3]], wall = [0, 0, 2] }
  | .wall: is along both domains | a direction across those of the domains
initial = { state = 'two_domains', directions = [[1, 0, 0], [0, 1, 0]], axis = 'w' }
  | .axis: "w" is not known | "x", "y", "z"
initial = { state = 'two_domains', directions = [[1, 0, 0], [0, 1, 0]], position = -0.5 }
  | .position: -0.5 is outside | a number from 0 to 1
initial = { state = 'helix' } | .period: is missing | a length > 0
initial = { state = 'helix', period = 0 } | .period: 0 is not positive | a length > 0
initial = { state = 'helix', period = 3, direction = [0, 0, 0] } | .direction: is a zero vector
initial = { state = 'helix', period = 3, phase = nan } | .phase: nan is not finite | radians
)");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
