// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "progress.hpp"

#include "bar.hpp"
#include "simulation/message.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

namespace cayspin::program {

using namespace simulation;

namespace {

// Draws a bar and a text over the current line.
void draw_over(std::FILE* stream, double share, std::string const& text) {
  write_text(stream, fmt::format("\r{}\x1b[K", fitted(fmt::format("{} {}", bar(share), text))));
}

// Prints a line and flushes, so that lines reach a pipe one by one, too.
void say(std::string const& line) {
  write_text(stdout, line + '\n');
  std::fflush(stdout);
}

}  // namespace

Progress::Progress(std::int64_t sites, Listener listener)
    : listener_(listener), terminal_(is_terminal(stdout)), sites_(sites) {}

void Progress::begin_stage(std::int64_t first, std::int64_t end, bool equal_steps,
                           std::string name) {
  first_ = first;
  steps_ = end;
  equal_steps_ = equal_steps;
  stage_ = std::move(name);
  stage_begin_ = shown_ = Clock::now();
  if (!begin_) begin_ = stage_begin_;
  next_ = listener_ == Listener::nobody ? std::numeric_limits<std::int64_t>::max()
          : terminal_                   ? first
                                        : first + 1;
}

void Progress::add(Summary const& summary) {
  method_steps_ += equal_steps_ ? summary.steps : summary.own_steps;
}

void Progress::tell(std::string const& text) {
  if (listener_ != Listener::user) return;
  if (on_line_) write_text(stdout, "\r\x1b[K");
  on_line_ = false;
  say(fmt::format("{}: {}", stage_, text));
}

void Progress::draw(double done, std::string const& text) {
  draw_over(stdout, done, text);
  std::fflush(stdout);
  on_line_ = true;
}

void Progress::show(Step const& step) {
  auto const now = Clock::now();
  std::chrono::duration<double> const of_stage = now - stage_begin_, pause = now - shown_;
  double const seconds = std::max(of_stage.count(), 1e-9);
  double const rate = static_cast<double>(step.number - first_) / seconds;
  // Reading the clock costs as much as a small step, so the clock is read about ten times a second.
  next_ = step.number + std::max<std::int64_t>(1, static_cast<std::int64_t>(0.1 * rate));
  double const least_pause = listener_ == Listener::program ? 0.2 : terminal_ ? 0.1 : 5;
  if (step.number == first_) {
    // Draws at once, because the first step may take long.
    if (listener_ == Listener::user && steps_ > first_)
      draw(static_cast<double>(first_) / static_cast<double>(steps_),
           fmt::format("step {} of {}", first_, steps_));
    return;
  }
  if (pause.count() < least_pause) return;
  shown_ = now;
  if (listener_ == Listener::program) return say(fmt::format("{} {}", step.number, steps_));
  double const done = static_cast<double>(step.number) / static_cast<double>(steps_);
  auto text = fmt::format("{:5.1f} %  {}step {} of {}", 100 * done,
                          stage_.empty() ? "" : stage_ + ", ", step.number, steps_);
  if (equal_steps_)
    text += fmt::format("  {}spin updates/s", rate_text(rate * static_cast<double>(sites_)));
  text += fmt::format("  {} left", duration_text(static_cast<double>(steps_ - step.number) / rate));
  terminal_ ? draw(done, text) : say(text);
}

void Progress::close(Summary const& summary, std::int64_t frames, std::string const& file) {
  if (listener_ != Listener::user) return;
  if (on_line_) write_text(stdout, "\r\x1b[K");
  auto const now = Clock::now();
  std::chrono::duration<double> const total = now - begin_.value_or(now);
  auto const updates = static_cast<double>(method_steps_) * static_cast<double>(sites_);
  std::string rate;
  if (method_steps_ > 0)
    rate = fmt::format(", stepping at {}spin updates/s",
                       rate_text(updates / std::max(summary.step_seconds, 1e-9)));
  if (summary.own_steps > 0)
    rate += fmt::format(", {} of the method, {} rejected",
                        counted(summary.own_steps, "internal step"), summary.rejected);
  say(fmt::format("{}: {}, {} in {}{}", file, counted(summary.steps, "step"),
                  counted(frames, "frame"), duration_text(total.count()), rate));
}

TrialProgress::TrialProgress(bool quiet, bool lines)
    : quiet_(quiet), lines_(lines), terminal_(is_terminal(stderr)) {
  if (terminal_) shown_ = {};  // the first call of show() draws at once
}

void TrialProgress::announce(double most_seconds) {
  most_seconds_ = most_seconds;
  if (!quiet_ && !terminal_ && lines_)
    say(fmt::format("trying methods for at most {}", duration_text(most_seconds)));
}

void TrialProgress::show(double share, std::string const& what) {
  if (quiet_ || (!terminal_ && !lines_)) return;
  auto const now = Clock::now();
  auto const pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
  if (now - shown_ < pause) return;
  shown_ = now;
  double const elapsed = std::chrono::duration<double>(now - begin_).count();
  auto const so_far = fmt::format("{} so far", duration_text(elapsed));
  auto const left =
      most_seconds_ > 0 ? fmt::format("{}, at most {}", so_far, duration_text(most_seconds_))
      : share > 0.02    ? fmt::format("about {} left", duration_text(elapsed * (1 - share) / share))
                        : so_far;
  auto const text = fmt::format("{:5.1f} %  {}  {}", 100 * share, left, what);
  if (!terminal_) return say(text);
  draw_over(stderr, share, text);
  drawn_ = true;
}

void TrialProgress::clear() {
  if (drawn_) write_text(stderr, "\r\x1b[K");
  drawn_ = false;
}

}  // namespace cayspin::program
