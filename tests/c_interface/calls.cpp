// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "c_interface_test.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

using namespace cayspin::test;

namespace {

template <class Real>
class CInterface : public ::testing::Test {
 protected:
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();
  static constexpr cayspin_precision precision =
      std::is_same_v<Real, double> ? CAYSPIN_DOUBLE : CAYSPIN_SINGLE;

  Simulation simulation = open(scene_text(), precision);

  static double number(cayspin_array const& spins, int64_t x, int64_t component) {
    return static_cast<Real const*>(
        spins.data)[x * spins.strides[2] + component * spins.strides[3]];
  }
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CInterface, Precisions);

TYPED_TEST(CInterface, StepsAndLendsSpins) {
  auto* const simulation = this->simulation.get();
  ASSERT_EQ(cayspin_step(simulation, 100), CAYSPIN_OK);
  double time = 0, m[3] = {};
  int64_t steps = 0;
  EXPECT_EQ(cayspin_time(simulation, &time), CAYSPIN_OK);
  EXPECT_EQ(cayspin_steps(simulation, &steps), CAYSPIN_OK);
  EXPECT_NEAR(time, 1, 1e-15);
  EXPECT_EQ(steps, 100);

  cayspin_array spins{};
  ASSERT_EQ(cayspin_borrow_spins(simulation, &spins), CAYSPIN_OK);
  EXPECT_EQ(spins.precision, this->precision);
  int64_t const shape[] = {1, 1, 2, 3};
  for (int axis = 0; axis < 4; ++axis) EXPECT_EQ(spins.shape[axis], shape[axis]);
  double const limit = 1e-10 + 200 * this->epsilon;
  for (int x = 0; x < 2; ++x) {
    EXPECT_NEAR(this->number(spins, x, 0), std::cos(1.0), limit);
    EXPECT_NEAR(this->number(spins, x, 1), std::sin(1.0), limit);
    EXPECT_NEAR(this->number(spins, x, 2), 0, limit);
  }
  ASSERT_EQ(cayspin_magnetization(simulation, m), CAYSPIN_OK);
  EXPECT_NEAR(m[0], std::cos(1.0), limit);
  EXPECT_NEAR(m[1], std::sin(1.0), limit);
}

TYPED_TEST(CInterface, TakesSpinsOfItsOwnStrides) {
  auto* const simulation = this->simulation.get();
  ASSERT_EQ(cayspin_step(simulation, 3), CAYSPIN_OK);
  // All x components come first, then y and z. The sites are in reverse order, and the spins do not
  // have unit length.
  TypeParam const numbers[] = {0, 3, 2, 0, 0, 4};
  cayspin_array const mine{&numbers[1], this->precision, {1, 1, 2, 3}, {0, 0, -1, 2}};
  ASSERT_EQ(cayspin_set_spins(simulation, &mine), CAYSPIN_OK) << cayspin_last_error();
  cayspin_array spins{};
  ASSERT_EQ(cayspin_borrow_spins(simulation, &spins), CAYSPIN_OK);
  EXPECT_NEAR(this->number(spins, 0, 0), 0.6, this->epsilon);  // (3, 0, 4) / 5
  EXPECT_EQ(this->number(spins, 0, 1), 0);
  EXPECT_NEAR(this->number(spins, 0, 2), 0.8, this->epsilon);
  EXPECT_EQ(this->number(spins, 1, 1), 1);  // (0, 2, 0) / 2
  double energy = 0;
  ASSERT_EQ(cayspin_energy(simulation, &energy), CAYSPIN_OK);
  EXPECT_NEAR(energy, -0.8, 2 * this->epsilon);
}

// On hosts, spins are lent without a copy. Each step swaps two arrays, so after an even number of
// steps the spins are in the original memory. Lent memory may be the input of set_spins.
TYPED_TEST(CInterface, LendsAndTakesBack) {
  auto* const simulation = this->simulation.get();
  cayspin_array first{}, second{}, later{};
  ASSERT_EQ(cayspin_borrow_spins(simulation, &first), CAYSPIN_OK);
  ASSERT_EQ(cayspin_borrow_spins(simulation, &second), CAYSPIN_OK);
  EXPECT_EQ(first.data, second.data);
  ASSERT_EQ(cayspin_step(simulation, 2), CAYSPIN_OK);
  ASSERT_EQ(cayspin_borrow_spins(simulation, &later), CAYSPIN_OK);
  if (on_host) {
    EXPECT_EQ(later.data, first.data);
  }
  ASSERT_EQ(cayspin_set_spins(simulation, &later), CAYSPIN_OK) << cayspin_last_error();
  double m[3] = {};
  ASSERT_EQ(cayspin_magnetization(simulation, m), CAYSPIN_OK);
  EXPECT_NEAR(m[1], std::sin(0.02), 1e-10 + 8 * this->epsilon);
}

// An easy axis along z and a field h along x that is too weak for saturation: at equilibrium,
// m_x = h / K and H = (h, 0, K * m_z).
TYPED_TEST(CInterface, RelaxesAndLendsTheField) {
  std::string text = scene_text("anisotropy = { constant = 2.0, axis = [0, 0, 1] }\n");
  text.replace(text.find("[0.0, 0.0, 1.0]"), 15, "[1.0, 0.0, 0.0]");
  text.replace(text.find("uniform = [1.0, 0.0, 0.0]"), 25, "uniform = [0.6, 0.3, 0.6]");
  text.erase(text.find("[integrator]"));
  auto const owner = open(text, this->precision);
  auto* const simulation = owner.get();
  double const torque = 1e3 * this->epsilon, limit = 1e4 * this->epsilon;
  auto const expect_rest = [&](double const* applied, double m_x, double h) {
    cayspin_minimum found{};
    ASSERT_EQ(cayspin_relax(simulation, torque, 1000, applied, &found), CAYSPIN_OK)
        << cayspin_last_error();
    EXPECT_EQ(found.converged, 1);
    EXPECT_LE(found.torque, torque);
    EXPECT_GT(found.evaluations, 1);
    EXPECT_NEAR(found.energy, 2 * (-h * m_x - (1 - m_x * m_x)), limit);
    double m[3] = {};
    ASSERT_EQ(cayspin_magnetization(simulation, m), CAYSPIN_OK);
    EXPECT_NEAR(m[0], m_x, limit);
    EXPECT_NEAR(m[2], std::sqrt(1 - m_x * m_x), limit);
  };
  expect_rest(nullptr, 0.5, 1);
  double const applied[3] = {-1.6, 0, 0};
  expect_rest(applied, -0.8, -1.6);
  int64_t steps = -1;
  EXPECT_EQ(cayspin_steps(simulation, &steps), CAYSPIN_OK);
  EXPECT_EQ(steps, 0);

  cayspin_array field{};
  ASSERT_EQ(cayspin_borrow_field(simulation, &field), CAYSPIN_OK) << cayspin_last_error();
  for (int x = 0; x < 2; ++x) {
    EXPECT_EQ(this->number(field, x, 0), 1);  // the applied field of the scene
    EXPECT_EQ(this->number(field, x, 1), 0);
    EXPECT_NEAR(this->number(field, x, 2), 2 * 0.6, 2 * limit);
  }
}

TEST(CInterfaceTexts, Version) { EXPECT_EQ(std::string(cayspin_version()).substr(0, 2), "0."); }

}  // namespace
