// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Strips that wait only for their neighbours: every step sees the results of the previous one, with
// any number of threads.
#include <cayspin/detail/strip_crew.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <thread>
#include <vector>

using namespace cayspin::detail;

namespace {

constexpr std::int64_t steps = 300;

/// One number for each strip. A step computes it from the previous numbers of the strip and its two
/// neighbours (double buffered). The numbers are not atomic: only the crew orders access to them.
struct Neighbours {
  std::vector<std::uint64_t> numbers[2];

  explicit Neighbours(std::int32_t strips) {
    for (auto& half : numbers) half.resize(static_cast<std::size_t>(strips));
    std::iota(numbers[0].begin(), numbers[0].end(), 1);
  }
  void step(std::int32_t strip, std::int64_t number) {
    auto const& from = numbers[number % 2];
    auto const at = static_cast<std::size_t>(strip), count = from.size();
    numbers[(number + 1) % 2][at] = from[(at + count - 1) % count] + 3 * from[at] +
                                    7 * from[(at + 1) % count] + static_cast<unsigned>(number);
  }
};

std::vector<std::uint64_t> expected(std::int32_t strips) {
  Neighbours neighbours(strips);
  for (std::int64_t step = 0; step < steps; ++step)
    for (std::int32_t strip = 0; strip < strips; ++strip) neighbours.step(strip, step);
  return neighbours.numbers[steps % 2];
}

/// Starts `threads` threads, each of which calls work() for its own strips one after the other.
/// `late`: one thread starts late, and one strip is slow at some steps.
std::vector<std::uint64_t> by_crew(std::int32_t strips, int threads, bool late) {
  Neighbours neighbours(strips);
  std::vector<StripProgress> progress(static_cast<std::size_t>(strips) + 1);
  StripCrew const crew{progress.data(), strips, steps, 0};
  std::vector<std::thread> running;
  for (int thread = 0; thread < threads; ++thread)
    running.emplace_back([&, thread] {
      if (late && thread == 1) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      for (std::int32_t own = thread; own < strips; own += threads)
        crew.work(own, [&](std::int32_t strip, std::int64_t step) {
          neighbours.step(strip, step);
          if (late && strip == 0 && step % 50 == 7)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        });
    });
  for (auto& thread : running) thread.join();
  for (auto const& place : progress) EXPECT_EQ(place.state.load(), 0);
  return neighbours.numbers[steps % 2];
}

TEST(StripCrew, OrdersStepsOfNeighbours) {
  for (std::int32_t const strips : {2, 3, 4, 7, 16})
    for (int const threads : {1, 2, 3, 16})
      EXPECT_EQ(by_crew(strips, std::min<int>(threads, strips), false), expected(strips))
          << strips << " strips, " << threads << " threads";
}

TEST(StripCrew, OutlastsLateThreads) {
  for (int const threads : {2, 5}) EXPECT_EQ(by_crew(5, threads, true), expected(5));
}

// A single thread calls work() for each strip in turn. During the first call, it has to take steps
// of all other strips.
TEST(StripCrew, NeedsNoSecondThread) { EXPECT_EQ(by_crew(9, 1, false), expected(9)); }

}  // namespace
