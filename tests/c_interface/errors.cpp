// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Calls that fail: their status, their message, and the state that they preserve.
#include "c_interface_test.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>

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
  cayspin_minimum found{};
  refuses(cayspin_borrow_field(nullptr, &spins), "simulation");
  refuses(cayspin_borrow_field(simulation.get(), nullptr), "field");
  refuses(cayspin_relax(nullptr, 1e-6, 10, nullptr, &found), "simulation");
  refuses(cayspin_relax(simulation.get(), 1e-6, 10, nullptr, nullptr), "found");
  refuses(cayspin_energy(nullptr, &number), "simulation");
  refuses(cayspin_energy(simulation.get(), nullptr), "energy");
  refuses(cayspin_magnetization(nullptr, &number), "simulation");
  refuses(cayspin_magnetization(simulation.get(), nullptr), "magnetization");
  EXPECT_EQ(cayspin_close(nullptr), CAYSPIN_OK);
}

/// A failed call does not change the variables that its arguments point to.
TEST(CInterfaceErrors, LeaveWhatPointersPointTo) {
  auto* const before = reinterpret_cast<cayspin_simulation*>(&expect_failure);
  auto* simulation = before;
  auto const text = scene_text();
  std::string const folder = std::filesystem::temp_directory_path().string();
  auto const file = [&](char const* path) {
    return cayspin_open_file(path, CAYSPIN_DOUBLE, nullptr, &simulation);
  };
  auto const parse = [&](std::string const& scene, char const* name, char const* space) {
    return cayspin_open_text(scene.c_str(), name, CAYSPIN_DOUBLE, space, &simulation);
  };
  expect_failure(file(""), CAYSPIN_WRONG_SCENE, "accepted: a readable TOML file");
  expect_failure(file(folder.c_str()), CAYSPIN_WRONG_SCENE, "is a folder");
  expect_failure(parse("", "", nullptr), CAYSPIN_WRONG_SCENE, "system: is missing");
  expect_failure(parse(text, "a\nb", ""), CAYSPIN_WRONG_USAGE, "accepted: ");
  expect_failure(parse(text, nullptr, "serial "), CAYSPIN_WRONG_USAGE, "accepted: ");
  EXPECT_EQ(simulation, before);

  double numbers[3] = {7, 8, 9};
  int64_t steps = 7;
  cayspin_array spins{numbers, CAYSPIN_SINGLE, {1, 2, 3, 4}, {5, 6, 7, 8}};
  EXPECT_EQ(cayspin_time(nullptr, numbers), CAYSPIN_WRONG_USAGE);
  EXPECT_EQ(cayspin_energy(nullptr, numbers), CAYSPIN_WRONG_USAGE);
  EXPECT_EQ(cayspin_magnetization(nullptr, numbers), CAYSPIN_WRONG_USAGE);
  EXPECT_EQ(cayspin_steps(nullptr, &steps), CAYSPIN_WRONG_USAGE);
  EXPECT_EQ(cayspin_borrow_spins(nullptr, &spins), CAYSPIN_WRONG_USAGE);
  EXPECT_EQ(numbers[0] + numbers[1] + numbers[2], 24);
  EXPECT_EQ(steps, 7);
  EXPECT_EQ(spins.data, numbers);
  EXPECT_EQ(spins.shape[3] + spins.strides[3], 12);
}

TEST(CInterfaceErrors, WrongScenes) {
  expect_failure(open_with(scene_text("konstant = 1.0\n")), CAYSPIN_WRONG_SCENE,
                 "mine.toml:8: field.konstant");
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
  expect_failure(cayspin_step(simulation.get(), INT64_MIN), CAYSPIN_WRONG_USAGE, "accepted: ");
  int64_t steps = -1;
  EXPECT_EQ(cayspin_steps(simulation.get(), &steps), CAYSPIN_OK);
  EXPECT_EQ(steps, 0);
  EXPECT_EQ(cayspin_step(simulation.get(), 0), CAYSPIN_OK);
  EXPECT_EQ(cayspin_step(simulation.get(), 2), CAYSPIN_OK);
  for (auto const count : {INT64_MAX, INT64_MAX - 1, (int64_t{1} << 53) - 1})
    expect_failure(cayspin_step(simulation.get(), count), CAYSPIN_WRONG_USAGE,
                   std::to_string(count) + " steps after step 2; accepted: up to step 90071992547");
  EXPECT_EQ(cayspin_steps(simulation.get(), &steps), CAYSPIN_OK);
  EXPECT_EQ(steps, 2);
}

TEST(CInterfaceErrors, StepsBeyondTheEndOfAdaptiveMethods) {
  auto text = scene_text();
  text.replace(text.find("\"rkmk4\""), 7, "\"tsit5\"\ntolerance = 1e-6");
  auto const simulation = open(text);
  EXPECT_EQ(cayspin_step(simulation.get(), 9), CAYSPIN_OK);
  expect_failure(cayspin_step(simulation.get(), 2), CAYSPIN_WRONG_USAGE, "lies beyond step 10");
  EXPECT_EQ(cayspin_step(simulation.get(), 1), CAYSPIN_OK) << cayspin_last_error();
}

TEST(CInterfaceErrors, WrongSpins) {
  auto const simulation = open(scene_text());
  double numbers[6] = {1, 0, 0, 0, 0, 0};
  auto const refuses = [&](cayspin_array const& spins, std::string const& words) {
    expect_failure(cayspin_set_spins(simulation.get(), &spins), CAYSPIN_WRONG_USAGE, words);
  };
  refuses({numbers, CAYSPIN_DOUBLE, {1, 1, 3, 3}, {9, 9, 3, 1}}, "(1, 1, 3, 3)");
  refuses({numbers, CAYSPIN_DOUBLE, {1, 1, 2, 2}, {6, 6, 3, 1}}, "shape[3] = 3");
  for (int axis = 0; axis < 3; ++axis)
    for (int64_t const extent : {int64_t{0}, int64_t{-1}, int64_t{-2}, INT64_MAX, INT64_MIN}) {
      cayspin_array spins{numbers, CAYSPIN_DOUBLE, {1, 1, 2, 3}, {6, 6, 3, 1}};
      spins.shape[axis] = extent;
      refuses(spins, "accepted: (1, 1, 2, 3)");
    }
  refuses({numbers, CAYSPIN_DOUBLE, {2, 1, 1, 3}, {3, 3, 3, 1}}, "(2, 1, 1, 3)");
  refuses({numbers, static_cast<cayspin_precision>(0), {1, 1, 2, 3}, {6, 6, 3, 1}}, "precision 0");
  // The message starts with the name of the argument, and names no line of a scene.
  auto const refuses_second = [&] {
    refuses({numbers, CAYSPIN_DOUBLE, {1, 1, 2, 3}, {6, 6, 3, 1}},
            "spins: the spin of site (1, 0, 0)");
    EXPECT_EQ(std::string(cayspin_last_error()).find("spins: "), 0u) << cayspin_last_error();
  };
  refuses_second();  // the spin has length 0
  numbers[3] = std::nan("");
  refuses_second();
  double m[3] = {};
  EXPECT_EQ(cayspin_magnetization(simulation.get(), m), CAYSPIN_OK);
  EXPECT_EQ(m[0], 1);
}

TEST(CInterfaceErrors, Equilibria) {
  auto text = scene_text();
  auto const simulation = open(text);
  cayspin_minimum found{7, 7, 7, 7};
  auto const relax = [&](double torque, int64_t evaluations, double const* applied = nullptr) {
    return cayspin_relax(simulation.get(), torque, evaluations, applied, &found);
  };
  expect_failure(relax(0, 10), CAYSPIN_WRONG_USAGE, "torque 0; accepted: ");
  expect_failure(relax(std::nan(""), 10), CAYSPIN_WRONG_USAGE, "torque nan; accepted: ");
  expect_failure(relax(1e-6, 0), CAYSPIN_WRONG_USAGE, "0 evaluations; accepted: ");
  double const applied[3] = {0, std::nan(""), 0};
  expect_failure(relax(1e-6, 10, applied), CAYSPIN_WRONG_USAGE, "applied: not finite");
  EXPECT_EQ(found.converged + found.torque + found.energy + double(found.evaluations), 28);

  text.erase(text.find("[integrator]"));
  auto const at_rest = open(text);
  for (auto const status : {cayspin_step(at_rest.get(), 1), cayspin_run(at_rest.get(), "no.h5", 0)})
    expect_failure(status, CAYSPIN_WRONG_USAGE, "has no table [integrator]");
  text.replace(text.find("[0.0, 0.0, 1.0]"), 15, "[[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]");
  expect_failure(open_with(text), CAYSPIN_WRONG_SCENE, "cayspin_relax for each of a list");
}

TEST(CInterfaceErrors, RunsAndFiles) {
  auto const folder = temporary("runs");
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  auto const file = (folder / "run.h5").string();
  auto const simulation = open(scene_text());
  expect_failure(cayspin_run(simulation.get(), nullptr, 0), CAYSPIN_WRONG_USAGE, "output.file");
  std::ofstream(file) << "mine";
  expect_failure(cayspin_run(simulation.get(), file.c_str(), 0), CAYSPIN_FAILED, "run.h5");
  for (auto const& [wrong, words] :
       {std::pair{std::string(), "cannot create the file: No such file or directory"},
        {folder.string(), "it exists and is not a regular file"},
        {(folder / "run.txt" / "").string(), "run.txt does not exist"}})
    expect_failure(cayspin_run(simulation.get(), wrong.c_str(), 1), CAYSPIN_FAILED, words);
  EXPECT_EQ(cayspin_run(simulation.get(), file.c_str(), 1), CAYSPIN_OK) << cayspin_last_error();
  auto from_file = scene_text();
  from_file.replace(from_file.find("uniform = [1.0, 0.0, 0.0]"), 25, "file = '" + file + "'");
  expect_failure(cayspin_run(open(from_file).get(), file.c_str(), 1), CAYSPIN_WRONG_USAGE,
                 "run.h5: the scene reads it");
  EXPECT_EQ(cayspin_step(simulation.get(), 1), CAYSPIN_OK);
  expect_failure(cayspin_run(simulation.get(), file.c_str(), 1), CAYSPIN_WRONG_USAGE,
                 "at step 11 and the scene ends at step 10");
  auto const nowhere = (folder / "no" / "run.h5").string();
  expect_failure(cayspin_run(open(scene_text()).get(), nowhere.c_str(), 0), CAYSPIN_FAILED,
                 "run.h5");
  std::filesystem::remove_all(folder);
}

// With this dt, classical Euler makes spins 1e300 times longer in each step until they overflow.
// The guard reports the overflow, and the last good state is kept.
TEST(CInterfaceErrors, NumbersThatFail) {
  auto text = scene_text();
  text.replace(text.find("rkmk4"), 5, "classical_euler");
  text.replace(text.find("dt = 0.01"), 9, "dt = 1e300");
  auto const simulation = open(text);
  expect_failure(cayspin_step(simulation.get(), 200), CAYSPIN_NUMBERS_FAILED, "step");

  // Other calls still work, and new spins start a new run.
  auto* const failed = simulation.get();
  double time = -1, energy = -1, m[3] = {};
  int64_t steps = -1;
  cayspin_array spins{};
  EXPECT_EQ(cayspin_time(failed, &time), CAYSPIN_OK);
  EXPECT_EQ(cayspin_steps(failed, &steps), CAYSPIN_OK);
  EXPECT_LT(steps, 200);
  EXPECT_EQ(time, static_cast<double>(steps) * 1e300);
  EXPECT_EQ(cayspin_energy(failed, &energy), CAYSPIN_OK);
  EXPECT_EQ(cayspin_magnetization(failed, m), CAYSPIN_OK);
  EXPECT_EQ(cayspin_borrow_spins(failed, &spins), CAYSPIN_OK);
  double const up[6] = {0, 0, 1, 0, 0, 1};
  cayspin_array const start{up, CAYSPIN_DOUBLE, {1, 1, 2, 3}, {6, 6, 3, 1}};
  ASSERT_EQ(cayspin_set_spins(failed, &start), CAYSPIN_OK) << cayspin_last_error();
  EXPECT_EQ(cayspin_step(failed, 3), CAYSPIN_OK) << cayspin_last_error();
  EXPECT_EQ(cayspin_energy(failed, &energy), CAYSPIN_OK);
  EXPECT_EQ(energy, -2);  // the new spins are along the field and do not turn
}

// Above 4096 sites the guard checks only every tenth step, and each frame.
TEST(CInterfaceErrors, NumbersThatFailInTheLastFrame) {
  auto text = scene_text({}, "steps = 5");
  text.replace(text.find("[2]"), 3, "[4100]");
  text.replace(text.find("rkmk4"), 5, "classical_euler");
  text.replace(text.find("dt = 0.01"), 9, "dt = 1e300");
  auto const simulation = open(text);
  auto const file = temporary("failing.h5");
  expect_failure(cayspin_run(simulation.get(), file.c_str(), 1), CAYSPIN_NUMBERS_FAILED,
                 "not finite");
  std::filesystem::remove(file);
}

TEST(CInterfaceErrors, RefusedSteps) {
  auto const text = scene_text({}, "steps = 10\nrefuse_unstable = true");
  auto unstable = text;
  unstable.replace(unstable.find("dt = 0.01"), 9, "dt = 1000.0");
  auto const simulation = open(unstable);
  auto const file = temporary("refused.h5");
  std::filesystem::remove(file);
  expect_failure(cayspin_step(simulation.get(), 1), CAYSPIN_WRONG_SCENE, "integrator.dt: 1000");
  expect_failure(cayspin_run(simulation.get(), file.c_str(), 0), CAYSPIN_WRONG_SCENE, "dt: 1000");
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_EQ(cayspin_step(open(text).get(), 1), CAYSPIN_OK) << cayspin_last_error();
}

// Each thread has its own message, like errno.
TEST(CInterfaceErrors, BelongToTheirThread) {
  expect_failure(cayspin_step(nullptr, 1), CAYSPIN_WRONG_USAGE, "simulation is NULL");
  std::string there = "unset";
  std::thread([&] { there = cayspin_last_error(); }).join();
  EXPECT_EQ(there, "");
  auto const simulation = open(scene_text());  // a successful call keeps the message

  EXPECT_EQ(std::string(cayspin_last_error()).find("simulation is NULL"), 0u);
}

}  // namespace
