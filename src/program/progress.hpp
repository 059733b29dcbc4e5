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

}  // namespace cayspin::program
