// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"

#include <pthread.h>

#include <mutex>

namespace cayspin::simulation {

/// A thread's turn to use Kokkos. Other threads wait for its end, because an execution space
/// accepts work from only one thread at a time. Throws UsageError if the thread has a turn already,
/// as in a field function that a step calls.
class Turn {
 public:
  Turn() : lock_(mutex_of_others()) {
    require_free();
    taken_ = true;
  }
  ~Turn() { taken_ = false; }
  Turn(Turn const&) = delete;
  Turn& operator=(Turn const&) = delete;

  /// Keeps other threads from taking a turn. The thread that created this object may still take
  /// one.
  class Reserved {
   public:
    Reserved() : lock_(mutex_of_others()) { require_free(); }

   private:
    std::lock_guard<std::recursive_mutex> lock_;
  };

  /// Marks a thread that works for the thread with the turn, which waits for it.
  class Work {
   public:
    Work() : before_(works_) { works_ = true; }
    ~Work() { works_ = before_; }
    Work(Work const&) = delete;
    Work& operator=(Work const&) = delete;

   private:
    bool before_;
  };

  /// Makes every turn in a process that is forked from now on throw UsageError. Call it for runs on
  /// several threads or on a device: a forked process has neither, and would wait for them forever.
  static void end_at_fork() {
    [[maybe_unused]] static int const registered =
        ::pthread_atfork(nullptr, nullptr, [] { is_forked_ = true; });
  }

 private:
  static void require_free(bool taken = taken_) {
    if (taken)
      throw UsageError(
          "this run is taking a step: a field function or an observer's due() may not use it");
  }
  static std::recursive_mutex& mutex_of_others() {
    static std::recursive_mutex one;
    // Another thread may have held the mutex at the fork, so this comes before the lock.
    if (is_forked_)
      throw UsageError(
          "this process was forked from one with runs on several threads or on a device; accepted: "
          "a new process, as multiprocessing starts with the method \"spawn\"");
    require_free(works_);
    return one;
  }
  static inline bool is_forked_ = false;
  static inline bool taken_ = false;
  static inline thread_local bool works_ = false;
  std::lock_guard<std::recursive_mutex> lock_;
};

}  // namespace cayspin::simulation
