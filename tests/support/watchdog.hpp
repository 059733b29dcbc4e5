// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>

namespace cayspin::test {

/// Ends the program with status 1 after two minutes without progress, which is a hang even on a
/// busy machine.
class Watchdog {
 public:
  explicit Watchdog(std::string what) : what_(std::move(what)) {}
  Watchdog(Watchdog const&) = delete;
  ~Watchdog() = default;

  void progress() {
    std::lock_guard const lock(mutex_);
    ++steps_;
  }

 private:
  void watch(std::stop_token const& stop) {
    std::unique_lock lock(mutex_);
    long seen = -1;
    while (!stop.stop_requested() && seen != steps_) {
      seen = steps_;
      stopped_.wait_for(lock, stop, std::chrono::minutes(2), [] { return false; });
    }
    if (stop.stop_requested()) return;
    std::fprintf(stderr, "%s: it hangs after step %ld\n", what_.c_str(), seen);
    std::_Exit(1);
  }

  std::string what_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  long steps_ = 0;
  std::jthread thread_{[this](std::stop_token const& stop) { watch(stop); }};
};

}  // namespace cayspin::test
