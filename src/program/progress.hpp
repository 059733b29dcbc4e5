// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/integrate.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace cayspin::program {

/// Makes SIGINT and SIGTERM end a run after its step instead of killing it, and makes a write past
/// the file size limit fail like any other write.
void catch_signals();

/// Returns true once SIGINT or SIGTERM has arrived.
bool interrupt_requested();

/// The reader of a run's progress messages.
enum class Listener { nobody, user, program };

/// Progress report of a run on standard output: a bar on a terminal, otherwise a line now and then.
/// For a program, a line with the current and the last step several times a second.
class Progress {
 public:
  Progress(std::int64_t sites, Listener listener);

  /// Call before a stage, or a run without stages, continues from step `first`. `end`: the last
  /// step of the run. `equal_steps`: the method has no internal steps. `name`: of the stage, or
  /// empty.
  void begin_stage(std::int64_t first, std::int64_t end, bool equal_steps, std::string name);
  /// Counts the steps of a stage.
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
  std::int64_t method_steps_ = 0;  // internal ones, if the method has such
  std::string stage_;
  std::optional<Clock::time_point> begin_;  // start of the run
  Clock::time_point stage_begin_, shown_;
  bool on_line_ = false;
};

/// Progress report of trials, with an estimate of the time left: a bar if standard error is a
/// terminal, so that results in a file or a pipe stay clean; otherwise lines on standard output.
class TrialProgress {
 public:
  /// `lines`: standard output may be used.
  TrialProgress(bool quiet, bool lines);
  /// Removes the bar.
  ~TrialProgress() { clear(); }
  TrialProgress(TrialProgress const&) = delete;
  TrialProgress& operator=(TrialProgress const&) = delete;

  /// Call before the first trial. `most_seconds`: the longest time that all trials together may
  /// take.
  void announce(double most_seconds);
  /// Call before each trial. `share`: the share of the work that is done; `what`: the name of the
  /// trial.
  void show(double share, std::string const& what);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_, lines_, terminal_, drawn_ = false;
  double most_seconds_ = 0;  // 0: unknown
  Clock::time_point begin_ = Clock::now(), shown_ = begin_;
};

}  // namespace cayspin::program
