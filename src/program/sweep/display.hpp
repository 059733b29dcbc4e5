// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "grid.hpp"
#include "io/sweep.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace cayspin::program::sweep {

/// A run in progress, and the fraction of its steps that are done.
struct Running {
  std::int64_t run;
  double share;
};

/// Progress report of a sweep on standard output: a line for each run that has ended; on a terminal
/// also bars, one for each run in progress, as many as fit, and one for all runs.
class Display {
 public:
  /// `open`: the runs that are still to do.
  Display(Grid const& grid, std::vector<std::int64_t> const& open, bool quiet);

  void ended(std::int64_t number, io::SweptRun const& run, std::vector<Running> const& running);
  void show(std::vector<Running> const& running);
  /// Removes the bars.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::string time_left(std::vector<Running> const& running) const;
  double cost(std::int64_t run) const { return grid_.costs[static_cast<std::size_t>(run)]; }

  Grid const& grid_;
  bool quiet_, terminal_;
  std::size_t count_, ended_ = 0;
  double cost_ = 0, cost_ended_ = 0;
  Clock::time_point begin_ = Clock::now(), shown_;
  int lines_ = 0;  // number of lines with bars on the terminal
};

}  // namespace cayspin::program::sweep
