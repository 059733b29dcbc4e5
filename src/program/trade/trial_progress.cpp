// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "trial_progress.hpp"

#include "program/bar.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace cayspin::program::trade {

TrialProgress::TrialProgress(bool quiet, bool lines)
    : quiet_(quiet), lines_(lines), terminal_(is_terminal(stderr)) {
  if (terminal_) shown_ = {};  // the first one at once
}

void TrialProgress::announce(double most_seconds) {
  most_seconds_ = most_seconds;
  if (!quiet_ && !terminal_ && lines_) {
    fmt::print("trying methods for at most {}\n", simulation::duration_text(most_seconds));
    std::fflush(stdout);
  }
}

void TrialProgress::show(double share, std::string const& what) {
  if (quiet_ || (!terminal_ && !lines_)) return;
  auto const now = Clock::now();
  auto const pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
  if (now - shown_ < pause) return;
  shown_ = now;
  double const elapsed = std::chrono::duration<double>(now - begin_).count();
  auto const so_far = fmt::format("{} so far", simulation::duration_text(elapsed));
  auto const left =
      most_seconds_ > 0
          ? fmt::format("{}, at most {}", so_far, simulation::duration_text(most_seconds_))
      : share > 0.02
          ? fmt::format("about {} left", simulation::duration_text(elapsed * (1 - share) / share))
          : so_far;
  auto const text = fmt::format("{:5.1f} %  {}  {}", 100 * share, left, what);
  if (terminal_) {
    fmt::print(stderr, "\r{}\x1b[K", fitted(fmt::format("{} {}", bar(share), text)));
    drawn_ = true;
  } else {
    fmt::print("{}\n", text);
    std::fflush(stdout);
  }
}

void TrialProgress::clear() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
  drawn_ = false;
}

}  // namespace cayspin::program::trade
