// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Prefactors of rates from given Hessians: soft modes, zero modes, and spins without precession.
#include "simulation/failure.hpp"
#include "simulation/transition_rates.hpp"

#include <cayspin/vec3.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

/// Returns spins along z with the given curvatures.
StateHessian state_of(std::vector<double> const& curvatures) {
  std::size_t const count = curvatures.size();
  std::vector<double> spins;
  for (std::size_t site = 0; 2 * site < count; ++site) spins.insert(spins.end(), {0, 0, 1});
  StateHessian state(spins, {});
  state.numbers.resize(count * count);
  for (std::size_t i = 0; i < count; ++i) state.numbers[i * count + i] = curvatures[i];
  return state;
}

/// A term curvature * v * v^T of a Hessian. At spin i, the vector v is spins[i] * direction.
struct Mode {
  double curvature;
  std::vector<double> spins;
  cayspin::Vec3<double> direction;
};
StateHessian state_of(std::vector<double> const& spins, std::vector<Mode> const& modes) {
  StateHessian state(spins, {});
  std::size_t const count = state.size();
  state.numbers.resize(count * count);
  for (auto const& [curvature, of_spins, e] : modes) {
    std::vector<double> v(count);
    for (std::size_t i = 0; i < count; ++i) {
      auto const* const axis = state.vector(i);
      v[i] = of_spins[i / 2] * (axis[0] * e.x + axis[1] * e.y + axis[2] * e.z);
    }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < count; ++k)
        state.numbers[i * count + k] += curvature * v[i] * v[k];
  }
  return state;
}

// Two spins along x: they turn together about z without a force, and about y against a weak one.
TEST(RatesOfMatrices, TurnTheSpinsOfFarStatesDifferently) {
  auto const state = state_of({1, 1, 1, 1, 1, 1});
  for (unsigned sample = 0; sample < 8; ++sample) {
    auto const far = state.far_state(sample);
    for (std::size_t site = 0; site < 3; ++site) {
      double square = 0, apart = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        double const other = far[3 * ((site + 1) % 3) + c];
        square += far[3 * site + c] * far[3 * site + c];
        apart += std::abs(far[3 * site + c] - other);
      }
      EXPECT_NEAR(square, 1, 1e-14) << sample;
      EXPECT_GT(apart, 1e-3) << sample;
    }
  }
}

TEST(RatesOfMatrices, CountSoftModesThatNoSymmetryExplains) {
  io::Scene scene;
  scene.lattice.shape = {2, 1, 1};
  double const half = std::sqrt(0.5);
  auto const state = [&](double in_plane, double soft, double opposed) {
    auto found = state_of({1, 0, 0, 1, 0, 0}, {{in_plane, {half, half}, {0, 1, 0}},
                                               {soft, {half, half}, {0, 0, 1}},
                                               {opposed, {half, -half}, {0, 1, 0}},
                                               {1, {half, -half}, {0, 0, 1}}});
    found.torques = {{1, 0, 0}, {0, 1, 0}, {0, 0, in_plane == 0 ? 0.0 : 1e-6}};
    found.torque_scale = 3;
    return found;
  };
  auto const expect = [&](StateHessian const& well, StateHessian const& top, double square,
                          std::int64_t zeros) {
    auto const rates = rates_between(scene, well, top, well, -1);
    EXPECT_EQ(rates.zero_modes, (std::array{zeros, zeros, zeros}));
    EXPECT_NEAR(rates.prefactor_forward * 2 * std::numbers::pi / std::sqrt(square), 1, 1e-5);
  };
  expect(state(0, 4e-6, 1), state(0, 1, -1), 4e-6, 1);
  expect(state(6e-6, 4e-6, 1), state(6e-6, 1, -1), 4e-6, 0);
  expect(state(6e-6, 4e-6, 1), state(1, 1, -1), 24e-12, 0);

  auto const top = state(1, 1, -1);
  auto const refused = [&](StateHessian const& well) {
    EXPECT_THROW(rates_between(scene, well, top, well, -1), NumbersFailed);
  };
  refused(state(6e-6, 4e-9, 1));
  refused(state(6e-6, -4e-6, 1));
  auto moving = state(6e-6, 4e-6, 1);
  moving.torque = 1e-6;
  refused(moving);
}

// If the direction of the spins changes by the same angle from site to site, turning all of them is
// a shift along the chain. In a chain with open ends, the volume of this shift is unknown.
TEST(RatesOfMatrices, RefuseAShiftAlongAnOpenAxis) {
  io::Scene scene;
  scene.lattice.shape = {4, 1, 1};
  double const soft = 4e-6;
  auto const well = [&](double step) {
    std::vector<double> spins, turn;
    for (int site = 0; site < 4; ++site) {
      double const sine = std::sin(step * site), cosine = std::cos(step * site);
      spins.insert(spins.end(), {sine, 0, cosine});
      turn.insert(turn.end(), {0.5 * cosine, 0, -0.5 * sine});
    }
    StateHessian state(spins, {});
    std::size_t const count = state.size();
    std::vector<double> v(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 3; ++c) v[i] += state.vector(i)[c] * turn[3 * (i / 2) + c];
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < count; ++k)
        state.numbers.push_back((i == k ? 1 : 0) - (1 - soft) * v[i] * v[k]);
    state.torques = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    state.torque_scale = 3;
    return state;
  };
  auto const top = state_of({-1, 1, 1, 1, 1, 1, 1, 1});
  auto const parallel = rates_between(scene, well(0), top, well(0), -1);
  EXPECT_NEAR(parallel.prefactor_forward * 2 * std::numbers::pi / std::sqrt(soft), 1, 1e-5);
  EXPECT_THROW(rates_between(scene, well(0.5), top, well(0.5), -1), NumbersFailed);
}

TEST(RatesOfMatrices, HaveNoFluxByPrecessionWithoutIt) {
  io::Scene scene;
  scene.lattice.shape = {1, 1, 1};
  scene.system.damping = 0.5;
  auto const well = state_of({1, 2}), top = state_of({-1, 1});
  EXPECT_GT(rates_between(scene, well, top, well, -1).prefactor_forward, 0.1);
  scene.system.precession = false;
  // before three factorisations of the saddle, one or more for the growth, and two of each minimum
  int polls = 0;
  rates_between(scene, well, top, well, -1, [&] { ++polls; });
  EXPECT_GE(polls, 8);
  struct Interrupted {};
  EXPECT_THROW(rates_between(scene, well, top, well, -1, [] { throw Interrupted(); }), Interrupted);
  auto const overdamped = rates_between(scene, well, top, well, -1);
  EXPECT_EQ(overdamped.prefactor_forward, 0);
  EXPECT_EQ(overdamped.prefactor_backward, 0);
  EXPECT_GT(overdamped.langer_forward, 0.01);
}

TEST(RatesOfMatrices, SayThatThereAreAtLeastEightZeroModes) {
  io::Scene scene;
  scene.lattice.shape = {6, 1, 1};
  std::vector<double> curvatures(12, 0.0);
  curvatures[0] = -1, curvatures[1] = 1;
  auto const top = state_of(curvatures);
  try {
    rates_between(scene, top, top, top, -1);
    ADD_FAILURE() << "taken";
  } catch (NumbersFailed const& error) {
    EXPECT_NE(std::string(error.what()).find("at least 8 zero modes"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
