// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/integrate.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace cayspin::program {

/// Makes the first SIGINT or SIGTERM set interrupt_requested() instead of killing the program. A
/// second signal kills the program. A write past the file size limit becomes an ordinary error.
void catch_signals();

/// Returns true once SIGINT or SIGTERM has arrived.
bool interrupt_requested();

/// The reader of a run's progress messages.
enum class Listener { nobody, user, program };

/// Progress report of a run on standard output. For a user it is a bar on a terminal, otherwise a
/// line every few seconds. For a program it is a line with the numbers of the current step and of
/// the last step, several times a second.
class Progress {
 public:
  Progress(std::int64_t sites, Listener listener);

  /// Call before each stage, or before a run without stages. `first`: the step at which it starts.
  /// `end`: the last step of the whole run. `equal_steps`: true if the method has no internal
  /// steps. `name`: the name of the stage, or empty.
  void begin_stage(std::int64_t first, std::int64_t end, bool equal_steps, std::string name);
  /// Adds the steps of a stage to the total that close() reports.
  void add(Summary const& summary);
  /// Prints a line about the stage.
  void tell(std::string const& text);

  bool due(Step const& step) const { return step.number >= next_; }
  void show(Step const& step);

  /// Prints one closing line: what was done, and the name of the file.
  void close(Summary const& summary, std::int64_t frames, std::string const& file);

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double done, std::string const& text);

  Listener listener_;
  bool terminal_, equal_steps_ = true;
  std::int64_t sites_, first_ = 0, steps_ = 0, next_ = 0;
  std::int64_t method_steps_ = 0;  // steps of all stages; internal steps, if the method has them
  std::string stage_;
  std::optional<Clock::time_point> begin_;  // start of the run
  Clock::time_point stage_begin_, shown_;
  bool on_line_ = false;
};

/// Progress report of trials, with an estimate of the time left. If standard error is a terminal,
/// it is a bar there, so that results in a file or a pipe stay clean. Otherwise it is lines on
/// standard output.
class TrialProgress {
 public:
  /// `lines`: true if lines may be printed on standard output.
  TrialProgress(bool quiet, bool lines);
  /// Removes the bar.
  ~TrialProgress() { clear(); }
  TrialProgress(TrialProgress const&) = delete;
  TrialProgress& operator=(TrialProgress const&) = delete;

  /// Call before the first trial. `most_seconds`: the longest time that all trials together may
  /// take.
  void announce(double most_seconds);
  /// Call before each trial. `share`: the fraction of the work that is done; `what`: the name of
  /// the trial.
  void show(double share, std::string const& what);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_, lines_, terminal_, drawn_ = false;
  double most_seconds_ = 0;  // 0: unknown
  Clock::time_point begin_ = Clock::now(), shown_ = begin_;
};

}  // namespace cayspin::program
