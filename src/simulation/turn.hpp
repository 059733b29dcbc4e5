// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"

#include <mutex>

namespace cayspin::simulation {

/// One for all runs: a space of Kokkos takes work from one thread at a time.
class Turn {
 public:
  Turn() : lock_(mutex()) {
    if (taken_)
      throw UsageError("a field or an observer's question may not use a run that is stepping");
    taken_ = true;
  }
  ~Turn() { taken_ = false; }
  Turn(Turn const&) = delete;
  Turn& operator=(Turn const&) = delete;

 private:
  static std::recursive_mutex& mutex() {
    static std::recursive_mutex one;
    return one;
  }
  static inline bool taken_ = false;
  std::lock_guard<std::recursive_mutex> lock_;
};

}  // namespace cayspin::simulation
