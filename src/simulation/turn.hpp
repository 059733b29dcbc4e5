// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"

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

 private:
  static void require_free(bool taken = taken_) {
    if (taken)
      throw UsageError(
          "this run is taking a step: a field function or an observer's due() may not use it");
  }
  static std::recursive_mutex& mutex_of_others() {
    static std::recursive_mutex one;
    require_free(works_);
    return one;
  }
  static inline bool taken_ = false;
  static inline thread_local bool works_ = false;
  std::lock_guard<std::recursive_mutex> lock_;
};

}  // namespace cayspin::simulation
