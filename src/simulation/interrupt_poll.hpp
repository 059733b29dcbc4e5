// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <utility>

namespace cayspin::simulation {

/// Function that asks a question at most twenty times a second, however often it is called. It
/// returns false until the answer is true, and true from then on.
class InterruptPoll {
 public:
  explicit InterruptPoll(std::function<bool()> question) : question_(std::move(question)) {}

  bool operator()() {
    if (yes_ || !question_ || ++calls_ < calls_to_clock_) return yes_;
    auto const now = Clock::now();
    auto const since_look = now - looked_;
    looked_ = now;
    calls_ = 0;
    calls_to_clock_ =
        since_look < std::chrono::milliseconds(1) ? std::min(2 * calls_to_clock_, 1024) : 1;
    if (now - asked_ < std::chrono::milliseconds(50)) return false;
    yes_ = question_();
    asked_ = Clock::now();
    return yes_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::function<bool()> question_;
  Clock::time_point asked_ = Clock::now(), looked_ = asked_;
  int calls_ = 0, calls_to_clock_ = 1;
  bool yes_ = false;
};

}  // namespace cayspin::simulation
