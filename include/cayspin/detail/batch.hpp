// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>

#include <cstdint>
#include <string>
#include <tuple>

namespace cayspin::inline v0_2::detail {

/// Functor that runs host loops over a small lattice one after another, `count` times.
template <class... Loops>
struct RepeatLoops {
  std::tuple<Loops...> loops;
  std::int64_t count;

  void operator()(std::int64_t) const {
    auto const at_once =
        std::apply([](auto const&... loop) { return std::tuple(loop.task_at(0)...); }, loops);
    for (std::int64_t i = 0; i < count; ++i)
      std::apply(
          [&](auto const&... loop) {
            std::apply([&](auto const&... first) { (run(loop, first), ...); }, at_once);
          },
          loops);
  }

 private:
  template <class Loop, class Task>
  static void run(Loop const& loop, Task const& first) {
    first();
    std::int64_t const tasks = loop.tasks();
    for (std::int64_t task = 1; task < tasks; ++task) loop(task);
  }
};

/// Runs the loops `count` times in one launch, on the calling thread.
template <class... Loops>
void repeat_on_calling_thread(std::string const& label, std::int64_t count,
                              std::tuple<Loops...> const& loops) {
  for_each_task(CallingThread(), label, 1, 1, RepeatLoops<Loops...>{loops, count});
}

}  // namespace cayspin::inline v0_2::detail
