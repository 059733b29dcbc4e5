// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace cayspin::inline v0_2::detail {

/// Host threads with work memory that is reused from task to task.
template <class Number>
class Workers {
 public:
  /// Allocates memory of `numbers` values for each thread. There are as many threads as the host
  /// space has, but at most `tasks`.
  Workers(std::string const& label, std::int64_t tasks, std::size_t numbers)
      : label_(label),
        count_(std::min<std::int64_t>(tasks, Kokkos::DefaultHostExecutionSpace().concurrency())),
        numbers_(whole_lines(numbers)),
        memory_(label, static_cast<std::size_t>(count_) * numbers_) {}

  /// Calls body(task, memory of the thread) for all tasks. The memory is set to 0 at allocation
  /// only: later tasks find in it what earlier ones left.
  template <class Body>
  void run(std::int64_t tasks, Body const& body) const {
    Kokkos::DefaultHostExecutionSpace const exec;
    for_each_task(exec, label_, count_, tasks * static_cast<std::int64_t>(numbers_),
                  Run<Body>{body, tasks, count_, numbers_, memory_.data()});
    exec.fence(label_);
  }

  static std::size_t whole_lines(std::size_t numbers) {
    constexpr std::size_t per_line = 64 / sizeof(Number);
    return (numbers + per_line - 1) / per_line * per_line;
  }

 private:
  template <class Body>
  struct Run {
    Body const& body;
    std::int64_t tasks, count;
    std::size_t numbers;
    Number* memory;

    void operator()(std::int64_t worker) const {
      std::int64_t const end = tasks * (worker + 1) / count;
      for (std::int64_t task = tasks * worker / count; task < end; ++task)
        body(task, memory + static_cast<std::size_t>(worker) * numbers);
    }
  };

  std::string label_;
  std::int64_t count_;
  std::size_t numbers_;
  Kokkos::View<Number*, Kokkos::HostSpace> memory_;
};

}  // namespace cayspin::inline v0_2::detail
