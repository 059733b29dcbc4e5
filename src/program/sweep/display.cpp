// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "display.hpp"

#include "program/bar.hpp"
#include "simulation/failure.hpp"
#include "simulation/message.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace cayspin::program::sweep {
namespace {

std::string outcome_text(io::SweptRun const& run) {
  if (run.status != Status::done) return fmt::format("failed: {}", run.message);
  auto const text =
      fmt::format("{} in {}", counted(run.step, "step"), duration_text(run.cost.wall_seconds));
  return run.message.empty() ? text : fmt::format("{}; {}", text, run.message);
}

}  // namespace

Display::Display(Grid const& grid, std::vector<std::int64_t> const& open, bool quiet)
    : grid_(grid), quiet_(quiet), terminal_(is_terminal(stdout)), count_(open.size()) {
  for (auto const run : open) cost_ += cost(run);
}

std::string Display::time_left(std::vector<Running> const& running) const {
  double done = cost_ended_;
  for (auto const& [run, share] : running) done += share * cost(run);
  if (!(done > 0)) return {};
  std::chrono::duration<double> const elapsed = Clock::now() - begin_;
  return duration_text(elapsed.count() * (cost_ - done) / done) + " left";
}

void Display::ended(std::int64_t number, io::SweptRun const& run,
                    std::vector<Running> const& running) {
  ++ended_;
  cost_ended_ += cost(number);
  if (quiet_) return;
  clear();
  auto line = fmt::format("{} of {}  run {}  {}: {}", ended_, count_, io::swept_run_name(number),
                          values_text(grid_.header, number), outcome_text(run));
  if (!terminal_ && ended_ < count_) {
    auto const left = time_left(running);
    if (!left.empty()) line += ", " + left;
  }
  write_text(stdout, line + '\n');
  std::fflush(stdout);
  shown_ = {};
}

void Display::show(std::vector<Running> const& running) {
  auto const now = Clock::now();
  if (quiet_ || !terminal_ || now - shown_ < std::chrono::milliseconds(100)) return;
  shown_ = now;
  clear();
  auto const line = [&](double share, std::string const& text) {
    write_text(stdout,
               fitted(fmt::format("{} {:5.1f} %  {}", bar(share), 100 * share, text)) + '\n');
    ++lines_;
  };
  // Lines that have scrolled off the top cannot be erased. Two lines are kept for the bar of all
  // runs and for the cursor.
  int const most_bars = terminal_lines() - 2;
  double done = cost_ended_;
  for (auto const& [run, share] : running) {
    done += share * cost(run);
    if (lines_ >= most_bars) continue;
    line(share, fmt::format("run {}  {}", io::swept_run_name(run), values_text(grid_.header, run)));
  }
  line(cost_ > 0 ? done / cost_ : 0,
       fmt::format("{} of {} runs  {}", ended_, count_, time_left(running)));
  std::fflush(stdout);
}

void Display::clear() {
  if (lines_ > 0) write_text(stdout, fmt::format("\x1b[{}A\r\x1b[J", lines_));
  lines_ = 0;
}

}  // namespace cayspin::program::sweep
