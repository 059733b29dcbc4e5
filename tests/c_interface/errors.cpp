// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Every way in which a call fails: its status, its line, and what it leaves as it was.
#include "c_interface_test.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

using namespace cayspin::test;

namespace {

cayspin_status open_with(std::string const& text, char const* space = nullptr,
                         cayspin_precision precision = CAYSPIN_DOUBLE) {
  cayspin_simulation* simulation = nullptr;
  auto const status = cayspin_open_text(text.c_str(), "mine.toml", precision, space, &simulation);
  EXPECT_EQ(simulation, nullptr);
  return status;
}

TEST(CInterfaceErrors, NullPointers) {
  auto const simulation = open(scene_text());
  cayspin_simulation* none = nullptr;
  cayspin_array spins{};
  double number = 0;
  int64_t count = 0;
  auto const refuses = [](cayspin_status status, std::string const& name) {
    expect_failure(status, CAYSPIN_WRONG_USAGE, name + " is NULL");
  };
  auto const text = scene_text();
  refuses(cayspin_open_file(nullptr, CAYSPIN_DOUBLE, nullptr, &none), "path");
  refuses(cayspin_open_file("a.toml", CAYSPIN_DOUBLE, nullptr, nullptr), "simulation");
  refuses(cayspin_open_text(nullptr, nullptr, CAYSPIN_DOUBLE, nullptr, &none), "text");
  refuses(cayspin_open_text(text.c_str(), nullptr, CAYSPIN_DOUBLE, nullptr, nullptr), "simulation");
  refuses(cayspin_step(nullptr, 1), "simulation");
  refuses(cayspin_run(nullptr, "a.h5", 0), "simulation");
  refuses(cayspin_time(nullptr, &number), "simulation");
  refuses(cayspin_time(simulation.get(), nullptr), "time");
  refuses(cayspin_steps(nullptr, &count), "simulation");
  refuses(cayspin_steps(simulation.get(), nullptr), "steps");
  refuses(cayspin_borrow_spins(nullptr, &spins), "simulation");
  refuses(cayspin_borrow_spins(simulation.get(), nullptr), "spins");
  refuses(cayspin_set_spins(nullptr, &spins), "simulation");
  refuses(cayspin_set_spins(simulation.get(), nullptr), "spins");
  refuses(cayspin_set_spins(simulation.get(), &spins), "spins->data");
  refuses(cayspin_energy(nullptr, &number), "simulation");
  refuses(cayspin_energy(simulation.get(), nullptr), "energy");
  refuses(cayspin_magnetization(nullptr, &number), "simulation");
  refuses(cayspin_magnetization(simulation.get(), nullptr), "magnetization");
  EXPECT_EQ(cayspin_close(nullptr), CAYSPIN_OK);
}

TEST(CInterfaceErrors, WrongScenes) {
  expect_failure(open_with(scene_text("konstant = 1.0\n")), CAYSPIN_WRONG_SCENE,
                 "mine.toml:8: field.konstant");
  expect_failure(open_with("[system"), CAYSPIN_WRONG_SCENE, "mine.toml:1");
  cayspin_simulation* simulation = nullptr;
  expect_failure(cayspin_open_file("no_such.toml", CAYSPIN_DOUBLE, nullptr, &simulation),
                 CAYSPIN_WRONG_SCENE, "no_such.toml");
  EXPECT_EQ(simulation, nullptr);
}

TEST(CInterfaceErrors, WrongPrecisionAndSpace) {
  expect_failure(open_with(scene_text(), nullptr, static_cast<cayspin_precision>(16)),
                 CAYSPIN_WRONG_USAGE, "precision 16; accepted: CAYSPIN_SINGLE, CAYSPIN_DOUBLE");
  expect_failure(open_with(scene_text(), "abacus"), CAYSPIN_WRONG_USAGE, "abacus");
}

TEST(CInterfaceErrors, WrongSteps) {
  auto const simulation = open(scene_text());
  expect_failure(cayspin_step(simulation.get(), -1), CAYSPIN_WRONG_USAGE, "-1 steps");
  int64_t steps = -1;
  EXPECT_EQ(cayspin_steps(simulation.get(), &steps), CAYSPIN_OK);
  EXPECT_EQ(steps, 0);
}

TEST(CInterfaceErrors, WrongSpins) {
  auto const simulation = open(scene_text());
  double numbers[6] = {1, 0, 0, 0, 0, 0};
  auto const refuses = [&](cayspin_array const& spins, std::string const& words) {
    expect_failure(cayspin_set_spins(simulation.get(), &spins), CAYSPIN_WRONG_USAGE, words);
  };
  refuses({numbers, CAYSPIN_DOUBLE, {1, 1, 3, 3}, {9, 9, 3, 1}}, "(1, 1, 3, 3)");
  refuses({numbers, CAYSPIN_DOUBLE, {1, 1, 2, 2}, {6, 6, 3, 1}}, "shape[3] = 3");
  refuses({numbers, static_cast<cayspin_precision>(0), {1, 1, 2, 3}, {6, 6, 3, 1}}, "precision 0");
  refuses({numbers, CAYSPIN_DOUBLE, {1, 1, 2, 3}, {6, 6, 3, 1}}, "");  // a spin of length 0
  numbers[3] = std::nan("");
  refuses({numbers, CAYSPIN_DOUBLE, {1, 1, 2, 3}, {6, 6, 3, 1}}, "");
  double m[3] = {};
  EXPECT_EQ(cayspin_magnetization(simulation.get(), m), CAYSPIN_OK);
  EXPECT_EQ(m[0], 1);
}

TEST(CInterfaceErrors, RunsAndFiles) {
  auto const folder = std::filesystem::temp_directory_path() / "cayspin_c_interface";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  auto const file = (folder / "run.h5").string();
  auto const simulation = open(scene_text());
  expect_failure(cayspin_run(simulation.get(), nullptr, 0), CAYSPIN_WRONG_USAGE, "output.file");
  std::ofstream(file) << "mine";
  expect_failure(cayspin_run(simulation.get(), file.c_str(), 0), CAYSPIN_FAILED, "run.h5");
  EXPECT_EQ(cayspin_run(simulation.get(), file.c_str(), 1), CAYSPIN_OK) << cayspin_last_error();
  EXPECT_EQ(cayspin_step(simulation.get(), 1), CAYSPIN_OK);
  expect_failure(cayspin_run(simulation.get(), file.c_str(), 1), CAYSPIN_WRONG_USAGE,
                 "at step 11 and the scene ends at step 10");
  auto const nowhere = (folder / "no" / "run.h5").string();
  expect_failure(cayspin_run(open(scene_text()).get(), nowhere.c_str(), 0), CAYSPIN_FAILED,
                 "run.h5");
  std::filesystem::remove_all(folder);
}

// Classical Euler doubles lengths: the guard says so, and the state before is kept.
TEST(CInterfaceErrors, NumbersThatFail) {
  auto text = scene_text();
  text.replace(text.find("rkmk4"), 5, "classical_euler");
  text.replace(text.find("dt = 0.01"), 9, "dt = 1e300");
  auto const simulation = open(text);
  expect_failure(cayspin_step(simulation.get(), 200), CAYSPIN_NUMBERS_FAILED, "step");
}

// As strerror's texts are: each thread has a line of its own.
TEST(CInterfaceErrors, BelongToTheirThread) {
  expect_failure(cayspin_step(nullptr, 1), CAYSPIN_WRONG_USAGE, "simulation is NULL");
  std::string there = "unset";
  std::thread([&] { there = cayspin_last_error(); }).join();
  EXPECT_EQ(there, "");
  EXPECT_EQ(std::string(cayspin_last_error()).find("simulation is NULL"), 0u);
}

}  // namespace
