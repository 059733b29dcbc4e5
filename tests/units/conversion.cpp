// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Conversions give the figures of docs/guide/units.md, and refuse wrong input.
#include "../support/figures.hpp"

#include <cayspin/units.hpp>

#include <limits>

namespace units = cayspin::units;
using cayspin::test::expect_figure;

namespace {

units::Micromagnetic permalloy(units::Damping const& damping) {
  return units::Micromagnetic({.Ms = 8e5, .cell = {5e-9, 5e-9, 5e-9}, .damping = damping});
}

TEST(Units, PermalloyHasTheFiguresOfTheGuide) {
  auto const material = permalloy(units::gilbert(0.02));
  constexpr double exact = 0;  // as exact as the printed digits
  expect_figure("exchange", material.exchange(1.3e-11), "1.2931", exact);
  expect_figure("anisotropy", material.anisotropy(500), "1.2434e-3", exact);
  expect_figure("dmi", material.dmi(3e-3), "0.74604", exact);
  expect_figure("field of 25 mT", material.applied(0.025), "0.024868", exact);
  expect_figure("field unit", material.field_unit(), "1.0053", exact);
  expect_figure("time unit", material.time_unit(), "5.6513e-12", exact);
  expect_figure("1 ns", material.time(1e-9), "176.95", exact);
  expect_figure("energy unit", material.energy_unit(), "1.0053e-19", exact);
  expect_figure("time unit at 0.5", permalloy(units::gilbert(0.5)).time_unit(), "7.0613e-12",
                exact);
  expect_figure("time unit at 1", permalloy(units::gilbert(1)).time_unit(), "1.1298e-11", exact);
  expect_figure("time unit, Landau-Lifshitz", permalloy(units::landau_lifshitz(1)).time_unit(),
                "5.6491e-12", exact);
}

TEST(Units, AtomisticFigures) {
  units::Atomistic const material(
      {.mu_s = 2 * units::bohr_magneton, .energy = 1e-21, .lattice_constant = 2.5e-10});
  constexpr double exact = 0;
  expect_figure("1 T", material.applied(1), "0.018548", exact);
  expect_figure("time unit", material.time_unit(), "1.0534e-13", exact);
  expect_figure("300 K", material.temperature(300), "4.1419", exact);
  EXPECT_EQ(material.exchange(1e-21), 1);
  EXPECT_EQ(material.anisotropy(1e-21), 2);
  EXPECT_EQ(material.dmi(1e-21), 1);
}

// From g * mu_B * P * j / (2 * e * Ms) and hbar * P * j / (2 * e * Ms * d), by hand. Electrons move
// against the current.
TEST(Units, CurrentsComeToVelocitiesAndFields) {
  units::PolarizedCurrent drift{.density = 1e12, .polarization = 0.4, .Ms = 8e5};
  EXPECT_NEAR(units::drift_velocity(drift), -28.9755, 5e-5);
  drift.density = -2e12, drift.gamma = 2 * units::electron_gamma;
  EXPECT_NEAR(units::drift_velocity(drift), 115.902, 5e-4);
  units::LayerCurrent layer{.density = 1e12, .efficiency = 0.4, .Ms = 8e5, .thickness = 3e-9};
  EXPECT_NEAR(units::spin_torque(layer), 0.0548510, 5e-8);
  layer.efficiency = -0.1;
  EXPECT_NEAR(units::spin_torque(layer), -0.01371275, 5e-9);
  for (auto const& damping : {units::gilbert(0.5), units::landau_lifshitz(0.5)})
    EXPECT_NEAR(permalloy(damping).velocity(100), 100 / (5e-9 * 1.760859e11 * 1.0053096), 1e-8);
  EXPECT_THROW(units::drift_velocity({.density = 1, .polarization = 1, .Ms = 0}),
               std::invalid_argument);
  EXPECT_THROW(units::spin_torque({.density = 1, .efficiency = 1, .Ms = 1, .thickness = 0}),
               std::invalid_argument);
}

TEST(Units, CubicAnisotropyIsAnEnergyOfASite) {
  EXPECT_NEAR(permalloy({}).cubic_anisotropy(4.8e4), 4.8e4 / 8.04248e5, 1e-6);
  units::Atomistic const atoms({.mu_s = 1e-23, .energy = 4e-21, .lattice_constant = 3e-10});
  EXPECT_EQ(atoms.cubic_anisotropy(1e-21), 0.25);
}

TEST(Units, GoThereAndBack) {
  auto const material = permalloy(units::gilbert(0.3));
  double const eps = std::numeric_limits<double>::epsilon();
  auto const expect_back = [&](double back) { EXPECT_NEAR(back, 0.7, eps); };
  expect_back(material.seconds(material.time(0.7)));
  expect_back(material.metres(material.length(0.7)));
  expect_back(material.tesla(material.applied(0.7)));
  expect_back(material.joules(material.energy(0.7)));
  expect_back(material.kelvin(material.temperature(0.7)));
  expect_back(material.per_second(material.rate(0.7)));
  // The unit of the field is Ms.
  EXPECT_NEAR(material.applied_from_ampere_per_metre(8e5), 1, eps);
  EXPECT_NEAR(material.rate(1 / material.time_unit()), 1, eps);
  EXPECT_EQ(material.damping(), 0.3);
}

TEST(Units, ASpacingOfItsOwnAlongEachAxis) {
  units::Micromagnetic const material({.Ms = 1e6, .cell = {4e-9, 2e-9, 1e-9}});
  EXPECT_EQ(material.spacing(), (std::array<double, 3>{1, 0.5, 0.25}));
  EXPECT_EQ(material.length_unit(), 4e-9);
  EXPECT_EQ(material.damping(), 0);
  EXPECT_EQ(material.demagnetization(0.4), 0.4);
}

TEST(Units, WhatIsNotPositiveAndFiniteIsRefused) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  double const infinity = std::numeric_limits<double>::infinity();
  for (double const wrong : {0.0, -1.0, nan, infinity}) {
    EXPECT_THROW(units::Micromagnetic({.Ms = wrong, .cell = {1, 1, 1}}), std::invalid_argument);
    EXPECT_THROW(units::Micromagnetic({.Ms = 1, .cell = {1, wrong, 1}}), std::invalid_argument);
    EXPECT_THROW(units::Micromagnetic({.Ms = 1, .cell = {1, 1, 1}, .damping = {}, .gamma = wrong}),
                 std::invalid_argument);
    EXPECT_THROW(units::Atomistic({.mu_s = wrong, .energy = 1, .lattice_constant = 1}),
                 std::invalid_argument);
    EXPECT_THROW(units::Atomistic({.mu_s = 1, .energy = wrong, .lattice_constant = 1}),
                 std::invalid_argument);
    EXPECT_THROW(units::Atomistic({.mu_s = 1, .energy = 1, .lattice_constant = wrong}),
                 std::invalid_argument);
    if (wrong == 0) continue;
    EXPECT_THROW(units::gilbert(wrong), std::invalid_argument);
    EXPECT_THROW(units::landau_lifshitz(wrong), std::invalid_argument);
  }
}

}  // namespace
