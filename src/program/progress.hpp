// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/integrate.hpp>

#include <chrono>
#include <cstdint>
#include <string>

namespace cayspin::program {

/// From here on SIGINT and SIGTERM ask a run to end after its step instead of killing it, and a
/// write past the limit of a file's size is an error like any other.
void catch_signals();

/// True once one of them came.
bool interrupt_requested();

/// To whom a run says how far it is.
enum class Listener { nobody, user, program };

/// Tells on standard output how far a run is: a bar on a terminal, otherwise now and then a line.
/// For a program, a line "STEP STEPS" some times a second.
class Progress {
 public:
  /// `equal_steps`: those of the method are those of the run.
  Progress(std::int64_t first, std::int64_t steps, std::int64_t sites, bool equal_steps,
           Listener listener);

  bool due(Step const& step) const { return step.number >= next_; }
  void show(Step const& step);

  /// One closing line: what was done, and into which file.
  void close(Summary const& summary, std::int64_t frames, std::string const& file);

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double done, std::string const& text);

  Listener listener_;
  bool terminal_, equal_steps_;
  std::int64_t first_, steps_, sites_, next_;
  Clock::time_point begin_ = Clock::now(), shown_ = begin_;
  bool on_line_ = false;
};

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

}  // namespace cayspin::program
