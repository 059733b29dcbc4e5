// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Calls for ensembles that fail: their status, their message, and the state that they preserve.
#include "c_interface_test.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

using namespace cayspin::test;

namespace {

std::string const three = "[ensemble]\nreplicas = 3\n";

cayspin_status open_all_with(std::string const& text, char const* space_name = space,
                             cayspin_precision precision = CAYSPIN_DOUBLE) {
  cayspin_ensemble* ensemble = nullptr;
  auto const status =
      cayspin_ensemble_open_text(text.c_str(), "mine.toml", precision, space_name, &ensemble);
  EXPECT_EQ(ensemble, nullptr);
  return status;
}

TEST(CInterfaceEnsembleErrors, NullPointers) {
  auto const owner = open_ensemble(scene_text(three));
  auto* const ensemble = owner.get();
  cayspin_ensemble* none = nullptr;
  cayspin_array spins{};
  cayspin_minimum found[3] = {};
  double numbers[9] = {};
  int64_t count = 0;
  auto const refuses = [](cayspin_status status, std::string const& name) {
    expect_failure(status, CAYSPIN_WRONG_USAGE, name + " is NULL");
  };
  auto const text = scene_text(three);
  refuses(cayspin_ensemble_open_file(nullptr, CAYSPIN_DOUBLE, nullptr, &none), "path");
  refuses(cayspin_ensemble_open_file("a.toml", CAYSPIN_DOUBLE, nullptr, nullptr), "ensemble");
  refuses(cayspin_ensemble_open_text(nullptr, nullptr, CAYSPIN_DOUBLE, nullptr, &none), "text");
  refuses(cayspin_ensemble_open_text(text.c_str(), nullptr, CAYSPIN_DOUBLE, nullptr, nullptr),
          "ensemble");
  refuses(cayspin_ensemble_replicas(nullptr, &count), "ensemble");
  refuses(cayspin_ensemble_replicas(ensemble, nullptr), "replicas");
  refuses(cayspin_ensemble_step(nullptr, 1), "ensemble");
  refuses(cayspin_ensemble_relax(nullptr, 1e-6, 10, found), "ensemble");
  refuses(cayspin_ensemble_relax(ensemble, 1e-6, 10, nullptr), "found");
  refuses(cayspin_ensemble_time(nullptr, numbers), "ensemble");
  refuses(cayspin_ensemble_time(ensemble, nullptr), "time");
  refuses(cayspin_ensemble_steps(nullptr, &count), "ensemble");
  refuses(cayspin_ensemble_steps(ensemble, nullptr), "steps");
  refuses(cayspin_ensemble_borrow_spins(nullptr, 0, &spins), "ensemble");
  refuses(cayspin_ensemble_borrow_spins(ensemble, 0, nullptr), "spins");
  refuses(cayspin_ensemble_energies(nullptr, numbers), "ensemble");
  refuses(cayspin_ensemble_energies(ensemble, nullptr), "energies");
  refuses(cayspin_ensemble_magnetizations(nullptr, numbers), "ensemble");
  refuses(cayspin_ensemble_magnetizations(ensemble, nullptr), "magnetizations");
  EXPECT_EQ(cayspin_ensemble_close(nullptr), CAYSPIN_OK);
}

// The message names the function that opens the scene.
TEST(CInterfaceEnsembleErrors, ScenesOfTheOtherKind) {
  auto const one = scene_text(), all = scene_text(three);
  auto const file = [](char const* name, std::string const& text) {
    auto const path = temporary(name);
    std::ofstream(path) << text;
    return path.string();
  };
  auto const one_file = file("one.toml", one), all_file = file("all.toml", all);
  cayspin_simulation* simulation = nullptr;
  expect_failure(cayspin_open_text(all.c_str(), "mine.toml", CAYSPIN_DOUBLE, space, &simulation),
                 CAYSPIN_WRONG_SCENE,
                 "ensemble: a simulation has no replicas; accepted: no such table, or "
                 "cayspin_ensemble_open_text");
  EXPECT_EQ(std::string(cayspin_last_error()).find("mine.toml:"), 0u) << cayspin_last_error();
  expect_failure(cayspin_open_file(all_file.c_str(), CAYSPIN_DOUBLE, space, &simulation),
                 CAYSPIN_WRONG_SCENE, "accepted: no such table, or cayspin_ensemble_open_file");
  EXPECT_EQ(simulation, nullptr);
  expect_failure(open_all_with(one), CAYSPIN_WRONG_SCENE,
                 "mine.toml:1: ensemble: is missing; accepted: a scene with [ensemble], or "
                 "cayspin_open_text");
  cayspin_ensemble* ensemble = nullptr;
  expect_failure(cayspin_ensemble_open_file(one_file.c_str(), CAYSPIN_DOUBLE, space, &ensemble),
                 CAYSPIN_WRONG_SCENE, "accepted: a scene with [ensemble], or cayspin_open_file");
  EXPECT_EQ(ensemble, nullptr);
  EXPECT_EQ(cayspin_ensemble_open_file(all_file.c_str(), CAYSPIN_DOUBLE, space, &ensemble),
            CAYSPIN_OK)
      << cayspin_last_error();
  EXPECT_EQ(cayspin_ensemble_close(ensemble), CAYSPIN_OK);
  std::filesystem::remove(one_file);
  std::filesystem::remove(all_file);
}

TEST(CInterfaceEnsembleErrors, WrongScenes) {
  expect_failure(open_all_with(scene_text("[ensemble]\nreplicas = 0\n")), CAYSPIN_WRONG_SCENE,
                 "ensemble.replicas");
  expect_failure(open_all_with(scene_text(three + "vary.\"lattice.spacing\" = [1, 2, 3]\n")),
                 CAYSPIN_WRONG_SCENE, "must be the same in all replicas");
  cayspin_ensemble* ensemble = nullptr;
  expect_failure(cayspin_ensemble_open_file("no_such.toml", CAYSPIN_DOUBLE, space, &ensemble),
                 CAYSPIN_WRONG_SCENE, "no_such.toml");
  EXPECT_EQ(ensemble, nullptr);
}

TEST(CInterfaceEnsembleErrors, WrongPrecisionAndSpace) {
  auto const text = scene_text(three);
  expect_failure(open_all_with(text, space, static_cast<cayspin_precision>(16)),
                 CAYSPIN_WRONG_USAGE, "precision 16; accepted: CAYSPIN_SINGLE, CAYSPIN_DOUBLE");
  expect_failure(open_all_with(text, "abacus"), CAYSPIN_WRONG_USAGE, "abacus");
}

TEST(CInterfaceEnsembleErrors, WrongSteps) {
  auto text = scene_text(three);
  auto const ensemble = open_ensemble(text);
  expect_failure(cayspin_ensemble_step(ensemble.get(), -1), CAYSPIN_WRONG_USAGE, "-1 steps");
  expect_failure(cayspin_ensemble_step(ensemble.get(), INT64_MIN), CAYSPIN_WRONG_USAGE,
                 "accepted: ");
  EXPECT_EQ(cayspin_ensemble_step(ensemble.get(), 2), CAYSPIN_OK) << cayspin_last_error();
  expect_failure(cayspin_ensemble_step(ensemble.get(), INT64_MAX), CAYSPIN_WRONG_USAGE,
                 "steps after step 2; accepted: up to step 90071992547");
  int64_t steps = -1;
  EXPECT_EQ(cayspin_ensemble_steps(ensemble.get(), &steps), CAYSPIN_OK);
  EXPECT_EQ(steps, 2);

  text.erase(text.find("[integrator]"));
  expect_failure(cayspin_ensemble_step(open_ensemble(text).get(), 1), CAYSPIN_WRONG_USAGE,
                 "has no table [integrator]");
}

/// A failed call does not change what its arguments point to.
TEST(CInterfaceEnsembleErrors, WrongReplicas) {
  auto const ensemble = open_ensemble(scene_text(three));
  double numbers[3] = {7, 8, 9};
  cayspin_array spins{numbers, CAYSPIN_SINGLE, {1, 2, 3, 4}, {5, 6, 7, 8}};
  for (int64_t const replica : {int64_t{-1}, int64_t{3}, INT64_MIN, INT64_MAX})
    expect_failure(cayspin_ensemble_borrow_spins(ensemble.get(), replica, &spins),
                   CAYSPIN_WRONG_USAGE,
                   "replica " + std::to_string(replica) + "; accepted: 0 to 2");
  EXPECT_EQ(spins.data, numbers);
  EXPECT_EQ(spins.shape[3] + spins.strides[3], 12);
}

TEST(CInterfaceEnsembleErrors, WrongSearches) {
  auto text = scene_text(three);
  auto const ensemble = open_ensemble(text);
  cayspin_minimum found[3] = {{7, 7, 7, 7}, {7, 7, 7, 7}, {7, 7, 7, 7}};
  auto const relax = [&](double torque, int64_t evaluations) {
    return cayspin_ensemble_relax(ensemble.get(), torque, evaluations, found);
  };
  expect_failure(relax(0, 10), CAYSPIN_WRONG_USAGE, "torque 0; accepted: ");
  expect_failure(relax(std::nan(""), 10), CAYSPIN_WRONG_USAGE, "torque nan; accepted: ");
  expect_failure(relax(1e-6, 0), CAYSPIN_WRONG_USAGE, "0 evaluations; accepted: ");
  text.replace(text.find("damping = 0.0"), 13, "damping = 0.5");
  text += "[thermal]\ntemperature = 0.1\n";
  expect_failure(cayspin_ensemble_relax(open_ensemble(text).get(), 1e-6, 10, found),
                 CAYSPIN_WRONG_SCENE, "thermal.temperature");
  for (auto const& [converged, torque, energy, evaluations] : found)
    EXPECT_EQ(converged + torque + energy + static_cast<double>(evaluations), 28);
}

// With this dt, classical Euler makes the spins of the second replica 1e300 times longer in each
// step until they overflow. The first replica has no field, and its spins stay where they are.
TEST(CInterfaceEnsembleErrors, NumbersThatFail) {
  auto text = scene_text("[ensemble]\nreplicas = 2\nvary.\"field.applied.2\" = [0.0, 1.0]\n");
  text.replace(text.find("rkmk4"), 5, "classical_euler");
  text.replace(text.find("dt = 0.01"), 9, "dt = 1e300");
  auto const owner = open_ensemble(text);
  auto* const ensemble = owner.get();
  expect_failure(cayspin_ensemble_step(ensemble, 200), CAYSPIN_NUMBERS_FAILED, "replica 1: ");
  double energies[2] = {-1, -1}, magnetizations[6] = {};
  int64_t steps = -1;
  cayspin_array spins{};
  EXPECT_EQ(cayspin_ensemble_steps(ensemble, &steps), CAYSPIN_OK);
  EXPECT_LT(steps, 200);
  EXPECT_EQ(cayspin_ensemble_borrow_spins(ensemble, 1, &spins), CAYSPIN_OK);
  EXPECT_EQ(cayspin_ensemble_energies(ensemble, energies), CAYSPIN_OK);
  EXPECT_EQ(cayspin_ensemble_magnetizations(ensemble, magnetizations), CAYSPIN_OK);
  EXPECT_EQ(energies[0], 0);
  EXPECT_EQ(magnetizations[0], 1);
}

TEST(CInterfaceEnsembleErrors, RefusedSteps) {
  auto text = scene_text(three, "steps = 10\nrefuse_unstable = true");
  EXPECT_EQ(cayspin_ensemble_step(open_ensemble(text).get(), 1), CAYSPIN_OK)
      << cayspin_last_error();
  text.replace(text.find("dt = 0.01"), 9, "dt = 1000.0");
  auto const ensemble = open_ensemble(text);
  for (int i = 0; i < 2; ++i)
    expect_failure(cayspin_ensemble_step(ensemble.get(), 1), CAYSPIN_WRONG_SCENE,
                   "integrator.dt: 1000");
  int64_t steps = -1;
  EXPECT_EQ(cayspin_ensemble_steps(ensemble.get(), &steps), CAYSPIN_OK);
  EXPECT_EQ(steps, 0);
}

}  // namespace
