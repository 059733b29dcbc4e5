// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "interrupt_poll.hpp"
#include "io/scene.hpp"

#include <cayspin/step.hpp>

#include <chrono>
#include <cstdint>
#include <optional>

namespace cayspin::simulation {

/// Schedule of a run's checkpoints.
class CheckpointSchedule {
 public:
  CheckpointSchedule(io::CheckpointPeriod const& period, std::int64_t first)
      : period_(period), first_(first) {
    wait();
  }

  bool due(Step const& step) const {
    if (step.number == first_ || step.last) return false;
    return period_.steps > 0 ? step.number % period_.steps == 0 : elapsed_ && (*elapsed_)();
  }
  /// Returns true if the steps with a checkpoint are known in advance.
  bool is_by_steps() const { return period_.steps > 0; }
  /// Starts the next period. Call it after storing a checkpoint.
  void wait() {
    if (period_.seconds == 0) return;
    std::chrono::duration<double> const period(period_.seconds);
    elapsed_.emplace([begin = Clock::now(), period] { return Clock::now() - begin >= period; });
  }

 private:
  using Clock = std::chrono::steady_clock;
  io::CheckpointPeriod period_;
  std::int64_t first_;
  mutable std::optional<InterruptPoll> elapsed_;  // asked at most twenty times a second
};

}  // namespace cayspin::simulation
