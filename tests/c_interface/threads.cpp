// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Calls from several threads on one simulation take turns, and calls for its progress do not wait.
// Run this test with -fsanitize=thread, too.
#include "../program/program_test.hpp"
#include "c_interface_test.hpp"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

using namespace cayspin::test;

namespace {

class Threads : public cayspin::program::test::ProgramTest {};

int64_t steps_of(cayspin_simulation const* simulation) {
  int64_t steps = -1;
  EXPECT_EQ(cayspin_steps(simulation, &steps), CAYSPIN_OK);
  return steps;
}

TEST_F(Threads, StepBorrowSetAndLook) {
  auto const owner = open(scene_text());
  auto* const simulation = owner.get();
  int64_t const count = 3000;
  std::atomic<bool> done = false;
  std::atomic<int> failures = 0;
  auto const expect = [&](bool holds) { failures += holds ? 0 : 1; };
  auto const until_done = [&](auto const& call) {
    return std::thread([&done, call] {
      do call();
      while (!done);
    });
  };
  std::vector<std::thread> others;
  for (int i = 0; i < 2; ++i)
    others.push_back(until_done([&] {
      cayspin_array spins{};
      expect(cayspin_borrow_spins(simulation, &spins) == CAYSPIN_OK && spins.data != nullptr);
    }));
  // Spins along the field, which steps do not change.
  others.push_back(until_done([&] {
    double const up[6] = {0, 0, 2, 0, 0, 3};
    cayspin_array const start{up, CAYSPIN_DOUBLE, {1, 1, 2, 3}, {6, 6, 3, 1}};
    expect(cayspin_set_spins(simulation, &start) == CAYSPIN_OK);
    double energy = 0, m[3] = {};
    expect(cayspin_energy(simulation, &energy) == CAYSPIN_OK && energy == -2);
    expect(cayspin_magnetization(simulation, m) == CAYSPIN_OK && m[2] == 1);
  }));
  int64_t before = 0;
  others.push_back(until_done([&] {
    int64_t const steps = steps_of(simulation);
    double time = -1;
    expect(cayspin_time(simulation, &time) == CAYSPIN_OK);
    expect(before <= steps && steps <= count && static_cast<double>(steps) * 0.01 <= time + 1e-9);
    before = steps;
  }));
  for (int64_t i = 0; i < count; ++i) expect(cayspin_step(simulation, 1) == CAYSPIN_OK);
  done = true;
  for (auto& other : others) other.join();
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(steps_of(simulation), count);
}

// A run holds the lock, also between its frames.
TEST_F(Threads, NoCallInTheMiddleOfARun) {
  auto const text = scene_text({}, "steps = 20000\n[output]\nevery = 20");
  auto const alone = open(text), disturbed = open(text);
  ASSERT_EQ(cayspin_run(alone.get(), in_folder("alone.h5").c_str(), 0), CAYSPIN_OK)
      << cayspin_last_error();
  std::atomic<bool> ended = false;
  std::thread run([&] {
    EXPECT_EQ(cayspin_run(disturbed.get(), in_folder("disturbed.h5").c_str(), 0), CAYSPIN_OK)
        << cayspin_last_error();
    ended = true;
  });
  while (steps_of(disturbed.get()) == 0 && !ended) std::this_thread::yield();
  double const up[6] = {0, 0, 1, 0, 0, 1};
  cayspin_array const start{up, CAYSPIN_DOUBLE, {1, 1, 2, 3}, {6, 6, 3, 1}};
  EXPECT_EQ(cayspin_set_spins(disturbed.get(), &start), CAYSPIN_OK);
  EXPECT_EQ(steps_of(disturbed.get()), 20000);
  run.join();
  double m[3] = {};
  EXPECT_EQ(cayspin_magnetization(disturbed.get(), m), CAYSPIN_OK);
  EXPECT_EQ(m[2], 1);
  EXPECT_EQ(last_spins("disturbed.h5"), last_spins("alone.h5"));
}

}  // namespace
