// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <chrono>
#include <string>

namespace cayspin::program::trade {

/// How far the tries are, with an estimate of the time left. A bar where standard error is a
/// terminal, so that results in a file or a pipe stay clean; otherwise lines on standard output.
class TrialProgress {
 public:
  /// `lines`: may standard output have them?
  TrialProgress(bool quiet, bool lines);
  /// Takes the bar away.
  ~TrialProgress() { clear(); }
  TrialProgress(TrialProgress const&) = delete;
  TrialProgress& operator=(TrialProgress const&) = delete;

  /// Before the first try: how long all of them may take.
  void announce(double most_seconds);
  /// Before each try: the share of the work that is done, and what is tried.
  void show(double share, std::string const& what);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_, lines_, terminal_, drawn_ = false;
  double most_seconds_ = 0;  // 0: not known
  Clock::time_point begin_ = Clock::now(), shown_ = begin_;
};

}  // namespace cayspin::program::trade
