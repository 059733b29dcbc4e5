// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "bar.hpp"
#include "command.hpp"
#include "io/follow.hpp"
#include "io/sweep.hpp"
#include "simulation/failure.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

namespace cayspin::program {
namespace {

using io::FollowedTrajectory;
using Seconds = std::chrono::duration<double>;

struct WatchOptions {
  std::filesystem::path file;
  bool once = false;
};

constexpr auto between_looks = std::chrono::milliseconds(500);
constexpr auto between_lines = std::chrono::seconds(5);
// A file that nobody writes for so long is asked for its writer.
constexpr double quiet_seconds = 10;

enum class Fate { under_way, complete, ended_early, killed };

/// What the scene in a file says, which a newer version may have written.
struct Planned {
  std::int64_t steps = 0;   // 0 where that is not known
  bool equal_steps = true;  // those of the method are those of the run
};

/// What a file says of its run.
struct Report : Planned {
  Fate fate = Fate::under_way;
  double idle = 0;                                // seconds since the file was written
  std::optional<double> elapsed = {}, rate = {};  // seconds, and steps per second
};

Planned planned(FollowedTrajectory const& run) {
  auto const& header = run.header();
  io::Scene scene;
  scene.path = run.path();
  scene.text = header.resolved_scene.empty() ? header.scene_text : header.resolved_scene;
  try {
    auto const integrator = io::with_overrides(scene, {}).integrator;
    return {integrator.steps, !integrator.tolerance};
  } catch (std::exception const&) {
    return {};
  }
}

Fate fate_of(FollowedTrajectory const& run, double idle) {
  if (run.complete()) return Fate::complete;
  if (run.cost().wall_seconds > 0) return Fate::ended_early;
  if (idle > quiet_seconds && io::is_being_written(run.path()) == false) return Fate::killed;
  return Fate::under_way;
}

Report report_on(FollowedTrajectory const& run, Planned const& plan) {
  Report report{plan};
  report.idle = std::max(0.0, Seconds(FollowedTrajectory::Clock::now() - run.written()).count());
  report.fate = fate_of(run, report.idle);
  if (run.cost().wall_seconds > 0)
    report.elapsed = run.cost().wall_seconds;
  else if (run.created())
    report.elapsed = Seconds(run.written() - *run.created()).count();
  if (run.steps().size() > 1 && report.elapsed && *report.elapsed > 0)
    report.rate = static_cast<double>(run.steps().back() - run.steps().front()) / *report.elapsed;
  return report;
}

std::string fate_text(Report const& report) {
  switch (report.fate) {
    case Fate::complete:
      return "complete";
    case Fate::ended_early:
      return "ended early: interrupted or failed";
    case Fate::killed:
      return fmt::format("ended early: nobody has written it for {}", duration_text(report.idle));
    default:
      return report.idle < 2
                 ? "under way"
                 : fmt::format("under way, last written {} ago", duration_text(report.idle));
  }
}

std::string steps_text(FollowedTrajectory const& run, Report const& report) {
  auto const step = run.steps().back();
  auto text = fmt::format("step {}", step);
  if (report.steps > 0)
    text += fmt::format(" of {} ({:.1f} %)", report.steps,
                        100 * static_cast<double>(step) / static_cast<double>(report.steps));
  auto const unit = run.header().units.si ? " s" : "";
  return text + fmt::format(", t = {:.9g}{}", run.times().back(), unit);
}

std::string last_energy_text(FollowedTrajectory const& run) {
  auto const unit = run.header().units.si ? " J" : "";
  return fmt::format("{:.9g}{}", run.scalars().back().energy, unit);
}

std::string left_text(FollowedTrajectory const& run, Report const& report) {
  if (report.fate != Fate::under_way || !report.rate || *report.rate <= 0 || report.steps == 0)
    return {};
  auto const left = static_cast<double>(report.steps - run.steps().back()) / *report.rate;
  return fmt::format("{} left", duration_text(std::max(0.0, left - report.idle)));
}

// Of the mean of m, between the last two samples.
std::optional<double> magnetization_rate(FollowedTrajectory const& run) {
  auto const count = run.times().size();
  if (count < 2) return std::nullopt;
  auto const& a = run.scalars()[count - 2].magnetization;
  auto const& b = run.scalars()[count - 1].magnetization;
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) /
         (run.times()[count - 1] - run.times()[count - 2]);
}

template <class Member>
std::string history(FollowedTrajectory const& run, Member const& member) {
  // As many as are drawn, and the first and the last among them.
  std::vector<double> values;
  auto const count = run.scalars().size();
  auto const shown = std::min<std::size_t>(count, 40);
  for (std::size_t i = 0; i < shown; ++i)
    values.push_back(member(run.scalars()[shown > 1 ? i * (count - 1) / (shown - 1) : 0]));
  return sparkline(values);
}

std::vector<std::string> lines_of(FollowedTrajectory const& run, Report const& report) {
  auto const& header = run.header();
  std::vector<std::string> lines;
  auto const add = [&](char const* name, std::string const& text) {
    lines.push_back(fmt::format("{:<13} {}", name, text));
  };
  auto const sites = static_cast<double>(header.shape[0] * header.shape[1] * header.shape[2]);
  add("file", fmt::format("{}, {}, {} precision, {}, {} threads", run.path().string(),
                          sites_text(header.shape, header.cell_sites), header.precision,
                          header.space, header.threads));
  add("run", fate_text(report));
  if (run.steps().empty()) return lines;
  auto const& now = run.scalars().back();
  auto const& m = now.magnetization;
  add("progress", steps_text(run, report));
  if (report.elapsed) {
    auto text = duration_text(*report.elapsed);
    if (report.rate && report.equal_steps)
      text += fmt::format(", {}spin updates/s", rate_text(*report.rate * sites));
    if (auto const left = left_text(run, report); !left.empty()) text += ", " + left;
    add("time", text);
  }
  add("energy", fmt::format("{:<18} {}", last_energy_text(run),
                            history(run, [](auto const& scalars) { return scalars.energy; })));
  add("norm defect",
      fmt::format("{:<18.3g} {}", now.norm_defect,
                  history(run, [](auto const& scalars) { return scalars.norm_defect; })));
  for (std::size_t c = 0; c < 3; ++c)
    add(c == 0 ? "magnetization" : "",
        fmt::format("{} {:<12.6f}     {}", "xyz"[c], m[c],
                    history(run, [c](auto const& scalars) { return scalars.magnetization[c]; })));
  if (auto const rate = magnetization_rate(run))
    add("|dm/dt|", fmt::format("{:.3g}{}", *rate, header.units.si ? " 1/s" : ""));
  for (auto& line : lines) line.erase(line.find_last_not_of(' ') + 1);
  return lines;
}

std::string one_line_of(FollowedTrajectory const& run, Report const& report) {
  if (run.steps().empty()) return fate_text(report);
  auto const& now = run.scalars().back();
  auto const& m = now.magnetization;
  auto line = fmt::format("{}: energy {}, norm defect {:.3g}, m ({:.6f}, {:.6f}, {:.6f})",
                          steps_text(run, report), last_energy_text(run), now.norm_defect, m[0],
                          m[1], m[2]);
  if (auto const left = left_text(run, report); !left.empty()) line += ", " + left;
  return line;
}

// What is half written now may be whole in a moment.
void look_patiently(FollowedTrajectory& run, int tries) {
  if (!std::filesystem::exists(run.path())) return run.look();
  while (true) {
    try {
      return run.look();
    } catch (std::runtime_error const&) {
      if (--tries <= 0) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

// A file that is being written is none: it is locked.
bool has_sweep(std::filesystem::path const& path) {
  try {
    return io::is_sweep(path);
  } catch (std::runtime_error const&) {
    return false;
  }
}

/// Says how a run goes: on a terminal in place, otherwise by a line from time to time.
class Screen {
 public:
  void show(FollowedTrajectory const& run, Report const& report) {
    if (terminal_) return redraw(lines_of(run, report));
    auto const now = std::chrono::steady_clock::now();
    auto const step = run.steps().empty() ? -1 : run.steps().back();
    bool const ended = report.fate != Fate::under_way;
    if (!ended && (step == shown_step_ || (shown_step_ >= 0 && now - shown_ < between_lines)))
      return;
    shown_ = now;
    shown_step_ = step;
    fmt::print("{}{}\n", one_line_of(run, report),
               ended && !run.steps().empty() ? "; " + fate_text(report) : "");
    std::fflush(stdout);
  }

 private:
  void redraw(std::vector<std::string> const& lines) {
    if (drawn_ > 0) fmt::print("\x1b[{}A\r\x1b[J", drawn_);
    for (auto const& line : lines) fmt::print("{}\n", fitted(line));
    drawn_ = lines.size();
    std::fflush(stdout);
  }

  bool terminal_ = is_terminal(stdout);
  std::size_t drawn_ = 0;
  std::int64_t shown_step_ = -1;
  std::chrono::steady_clock::time_point shown_;
};

int watch(WatchOptions const& options) {
  if (has_sweep(options.file))
    throw UsageError(
        fmt::format("{}: it has a sweep, which `cayspin info` lists; accepted: the "
                    "file of a run, such as one in {}",
                    options.file.string(), io::sweep_folder(options.file).string()));
  FollowedTrajectory run(options.file);
  look_patiently(run, 10);
  // The second one knows what to believe.
  std::this_thread::sleep_for(std::chrono::milliseconds(run.complete() ? 0 : 50));
  look_patiently(run, 10);
  auto plan = planned(run);
  auto report = report_on(run, plan);
  if (options.once) {
    for (auto const& line : lines_of(run, report)) fmt::print("{}\n", line);
    return Status::done;
  }
  Screen screen;
  auto text = run.header().scene_text;
  while (true) {
    screen.show(run, report);
    if (report.fate != Fate::under_way) break;
    std::this_thread::sleep_for(between_looks);
    look_patiently(run, 100);
    if (text != run.header().scene_text) {
      text = run.header().scene_text;
      plan = planned(run);
    }
    report = report_on(run, plan);
  }
  if (report.fate == Fate::complete) return Status::done;
  throw NumbersFailed(fmt::format("{}: {}", options.file.string(), fate_text(report)));
}

}  // namespace

Command add_watch(CLI::App& program) {
  auto const options = std::make_shared<WatchOptions>();
  auto* const command = program.add_subcommand("watch", "Follow a run by its trajectory file");
  command->add_option("FILE", options->file, "Trajectory file (HDF5)")->required();
  command->add_flag("--once", options->once, "Say how far it is, and end");
  return {command, [options](Ranks&) { return watch(*options); }};
}

}  // namespace cayspin::program
