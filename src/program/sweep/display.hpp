// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "grid.hpp"
#include "io/sweep.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace cayspin::program::sweep {

/// A run under way and the share of it that is done.
struct Running {
  std::int64_t run;
  double share;
};

/// How far a sweep is, on standard output: on a terminal a bar for each run under way, as far
/// as they fit, and one for all, otherwise a line for each that has ended.
class Display {
 public:
  /// `open`: what has to be run.
  Display(Grid const& grid, std::vector<std::int64_t> const& open, bool quiet);

  void ended(std::int64_t number, io::SweptRun const& run, std::vector<Running> const& running);
  void show(std::vector<Running> const& running);
  /// Takes the bars away.
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
  int lines_ = 0;  // of bars on the terminal
};

}  // namespace cayspin::program::sweep
