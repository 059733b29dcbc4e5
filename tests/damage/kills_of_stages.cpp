// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A run in stages, killed at random times, continues in its stage and gives bitwise the same spins
// as an uninterrupted run. CAYSPIN_KILLS and CAYSPIN_SEED: a quarter of the number of kills, and
// the seed.
#include "damaged_bytes.hpp"
#include "program/program_test.hpp"

#include <chrono>
#include <csignal>
#include <iostream>
#include <map>
#include <thread>

namespace cayspin::program::test {
namespace {

using cayspin::test::Chance;
using cayspin::test::number_from;

// tsit5 remembers the previous step; the stage before the last ends early.
std::string const scene = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [10, 3]
[field]
exchange = 1.0
applied = ["0.3*cos(7*t)", -0.2, 0.1]
[initial]
random = { seed = 3 }
[integrator]
method = "rkmk4"
dt = 1e-3
steps = 4000
[output]
every = 100
checkpoint_every = "500 steps"
[[stage]]
relax = true
field.applied = [0.1, 0, 0.1]
[[stage]]
field.applied = ["0.3*cos(7*t)", 0.1, 0.1]
integrator = { method = "tsit5", tolerance = 1e-7, dt = 1e-3, steps = 8000 }
[[stage]]
field.applied = [0, 0, 0.5]
integrator = { method = "rkmk4", dt = 1e-2, steps = 400000, until_torque = 0.05 }
[[stage]]
field.applied = ["0.3*cos(7*t)", 0.1, 0.1]
integrator = { method = "heun", dt = 1e-3, steps = 8000 }
)toml";

class KillsOfStages : public ProgramTest {
 protected:
  KillsOfStages() { write("scene.toml", scene); }

  static Arguments into(std::string const& file, Arguments const& more = {}) {
    return joined(
        {"run", "scene.toml", "--quiet", "--threads", "1", "--overwrite", "--output", file}, more);
  }
};

TEST_F(KillsOfStages, GoOnToTheSameBits) {
  auto const begun = std::chrono::steady_clock::now();
  output_of(into("whole.h5"));
  auto const longest = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now() - begun);
  auto const whole = info_of("whole.h5");
  auto const spins = last_spins("whole.h5");
  ASSERT_EQ(whole.frame_stages.back(), 4);
  ASSERT_LT(whole.frame_steps.back(), 400000);
  long const kills = 4 * number_from("CAYSPIN_KILLS", 5);
  Chance chance(static_cast<std::uint64_t>(number_from("CAYSPIN_SEED", 1)));
  std::map<std::int64_t, int> killed_in, continued_in;
  auto const in_the_middle = [&] { return continued_in[2] + continued_in[3]; };
  long kill = 0, without_checkpoint = 0;
  std::string from;
  // More kills follow until one has come in stage 2 or 3.
  for (; kill < kills || (in_the_middle() == 0 && kill < 10 * kills); ++kill) {
    std::string const file = kill % 2 == 0 ? "a.h5" : "b.h5";
    auto const arguments = into(file, from.empty() ? Arguments{} : Arguments{"--restart", from});
    auto const process = begin(arguments);
    std::this_thread::sleep_for(
        std::chrono::microseconds(chance.below(static_cast<std::uint64_t>(longest.count()))));
    end(process, SIGKILL);
    if (!exists(file) || info_of(file).frames == 0) continue;
    auto const killed = info_of(file);
    ++killed_in[killed.frame_stages.back()];
    if (killed.complete) {
      EXPECT_EQ(last_spins(file), spins);
      from.clear();
      continue;
    }
    auto const outcome = start(into("on.h5", {"--restart", file}));
    // Before its first checkpoint, a method that remembers steps cannot be continued with bitwise
    // the same results.
    if (outcome.errors.find("checkpoint.h5 is not there") != std::string::npos) {
      ++without_checkpoint;
      from.clear();
      continue;
    }
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    auto const on = info_of("on.h5");
    EXPECT_EQ(last_spins("on.h5"), spins) << "killed in stage " << killed.frame_stages.back();
    EXPECT_EQ(on.frame_steps.back(), whole.frame_steps.back());
    EXPECT_EQ(on.frame_times.back(), whole.frame_times.back());
    ++continued_in[killed.frame_stages.back()];
    // With probability 1/2, the next run to be killed continues this one.
    from = chance.below(2) == 0 ? file : std::string();
  }
  std::cout << "killed in stage:";
  for (auto const& [stage, count] : killed_in) std::cout << ' ' << stage << ": " << count << ',';
  std::cout << " without a checkpoint: " << without_checkpoint << '\n';
  EXPECT_GT(in_the_middle(), 0);
  // Stage 2 lacks a checkpoint during a sixteenth of its steps.
  EXPECT_LE(2 * without_checkpoint, kill);
}

}  // namespace
}  // namespace cayspin::program::test
