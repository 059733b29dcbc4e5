// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "info_progress.hpp"

#include "io/stages.hpp"
#include "simulation/restart.hpp"
#include "simulation/text.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <exception>

namespace cayspin::program {

using namespace simulation;

namespace {

/// Times of a file, in seconds.
struct FileAge {
  double idle = 0;     // since the file was last written
  double written = 0;  // from the file's creation to its last write; 0 if unknown
};

FileAge age_of(std::filesystem::path const& path) {
  std::chrono::duration<double> const now = std::chrono::system_clock::now().time_since_epoch();
#if defined(STATX_BTIME)
  struct statx status {};
  if (::statx(AT_FDCWD, path.c_str(), 0, STATX_MTIME | STATX_BTIME, &status) != 0) return {};
  auto const seconds = [](statx_timestamp const& time) {
    return static_cast<double>(time.tv_sec) + 1e-9 * time.tv_nsec;
  };
  FileAge age{.idle = std::max(0.0, now.count() - seconds(status.stx_mtime))};
  if ((status.stx_mask & STATX_BTIME) != 0)
    age.written = std::max(0.0, seconds(status.stx_mtime) - seconds(status.stx_btime));
  return age;
#else
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {.idle = std::max(0.0, now.count() - static_cast<double>(status.st_mtime))};
#endif
}

/// Planned steps of the scene in a file. They are unknown if this version cannot read the scene,
/// which a newer version may have written.
struct PlannedSteps {
  std::int64_t steps = 0;    // 0 if unknown
  bool equal_steps = false;  // the method has no internal steps
};

PlannedSteps planned_steps(io::TrajectoryInfo const& info) {
  if (info.cost.relaxed) return {};  // frames are equilibria, not steps
  auto const& header = info.header;
  io::Scene scene;
  scene.path = info.path;
  scene.text = header.resolved_scene.empty() ? header.scene_text : header.resolved_scene;
  try {
    auto stages = io::stages_of(io::with_overrides(scene, {}));
    if (stages.size() > 1 && info.frames > 0) {  // earlier stages may have ended early
      auto const begin = last_frame(info, stages).begin;
      auto const now = static_cast<std::size_t>(begin.stage);
      stages.at(now).scene.begin = begin;
      io::put_begins(stages, now);
    }
    bool const equal = std::ranges::none_of(
        stages, [](auto& one) { return one.scene.integrator.tolerance.has_value(); });
    return {io::end_of(stages.back()), equal};
  } catch (std::exception const&) {
    return {};
  }
}

std::string state_text(RunProgress const& progress, bool has_cost) {
  auto const last_written = fmt::format(", last written {} ago", duration_text(progress.idle));
  if (progress.is_running == true)
    return "no: still running" + (progress.idle < 2 ? "" : last_written);
  if (has_cost) return "no: interrupted or failed";
  if (!progress.is_running) return "no: still running or killed" + last_written;
  return "no: killed, or ended by an error such as a full disk";
}

std::string progress_text(io::Sample const& now, std::optional<std::int64_t> planned, bool si) {
  auto text = fmt::format("step {}", now.step);
  if (planned)
    text += fmt::format(" of {} ({:.1f} %)", *planned,
                        100 * static_cast<double>(now.step) / static_cast<double>(*planned));
  return text + fmt::format(", t = {:.9g}{}", now.time, si ? " s" : "");
}

bool has_cost(io::TrajectoryInfo const& info) { return info.cost.wall_seconds > 0; }

}  // namespace

RunProgress progress_of(io::TrajectoryInfo const& info, std::optional<bool> being_written) {
  auto const age = age_of(info.path);
  RunProgress progress{.is_running = being_written, .idle = age.idle, .last = info.last_sample};
  if (!being_written && has_cost(info)) progress.is_running = false;
  auto& last = progress.last;
  if (info.frames > 0 && (!last || info.frame_steps.back() > last->step))
    last = {info.frame_steps.back(), info.frame_times.back(), info.frame_scalars.back()};
  if (!last) return progress;
  auto const plan = planned_steps(info);
  if (plan.steps > 0) progress.steps = plan.steps;

  if (has_cost(info) || age.written == 0) return progress;
  progress.seconds = age.written;
  auto const first = info.frames > 0 ? info.frame_steps.front() : last->step;
  double const rate = static_cast<double>(last->step - first) / age.written;  // steps per second
  if (rate > 0 && plan.equal_steps) {
    auto const& shape = info.header.shape;
    auto const sites = static_cast<double>(shape[0]) * static_cast<double>(shape[1] * shape[2]);
    progress.updates_per_second = rate * sites;
  }
  if (rate > 0 && plan.steps > 0 && being_written != false)
    progress.seconds_left =
        std::max(0.0, static_cast<double>(plan.steps - last->step) / rate - age.idle);
  return progress;
}

std::vector<std::pair<std::string, std::string>> progress_lines(io::TrajectoryInfo const& info,
                                                                std::optional<bool> being_written) {
  auto const progress = progress_of(info, being_written);
  std::vector<std::pair<std::string, std::string>> lines{
      {"complete", state_text(progress, has_cost(info))}};
  if (!progress.last) return lines;
  lines.emplace_back("progress",
                     progress_text(*progress.last, progress.steps, info.header.units.si));
  if (!progress.seconds) return lines;
  auto time = duration_text(*progress.seconds);
  if (progress.updates_per_second)
    time += fmt::format(", {}spin updates/s", rate_text(*progress.updates_per_second));
  if (progress.seconds_left)
    time += fmt::format(", {} left", duration_text(*progress.seconds_left));
  lines.emplace_back("time", time);
  return lines;
}

}  // namespace cayspin::program
