// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "info_progress.hpp"

#include "io/stages.hpp"
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

/// Ages in seconds.
struct FileAge {
  double idle = 0;     // since it was last written
  double written = 0;  // from its creation until then; 0 if the file system does not know
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

/// Planned steps of the scene in a file, which a newer version may have written.
struct PlannedSteps {
  std::int64_t steps = 0;    // 0 if unknown
  bool equal_steps = false;  // steps of the method are those of the run
};

PlannedSteps planned_steps(io::TrajectoryInfo const& info) {
  if (info.cost.relaxed) return {};  // its frames are equilibria, not steps
  auto const& header = info.header;
  io::Scene scene;
  scene.path = info.path;
  scene.text = header.resolved_scene.empty() ? header.scene_text : header.resolved_scene;
  try {
    auto const stages = io::stages_of(io::with_overrides(scene, {}));
    bool const equal = std::ranges::none_of(
        stages, [](auto& one) { return one.scene.integrator.tolerance.has_value(); });
    return {io::end_of(stages.back()), equal};
  } catch (std::exception const&) {
    return {};
  }
}

std::string state_text(io::TrajectoryInfo const& info, std::optional<bool> being_written,
                       double idle) {
  auto const last_written = fmt::format(", last written {} ago", duration_text(idle));
  if (being_written == true) return "no: still running" + (idle < 2 ? "" : last_written);
  if (info.cost.wall_seconds > 0) return "no: interrupted or failed";
  if (!being_written) return "no: still running or killed" + last_written;
  return "no: killed, or ended by an error such as a full disk";
}

std::string progress_text(io::TrajectoryInfo const& info, io::Sample const& now,
                          std::int64_t planned) {
  auto text = fmt::format("step {}", now.step);
  if (planned > 0)
    text += fmt::format(" of {} ({:.1f} %)", planned,
                        100 * static_cast<double>(now.step) / static_cast<double>(planned));
  return text + fmt::format(", t = {:.9g}{}", now.time, info.header.units.si ? " s" : "");
}

}  // namespace

std::vector<std::pair<std::string, std::string>> progress_lines(io::TrajectoryInfo const& info,
                                                                std::optional<bool> being_written) {
  auto const age = age_of(info.path);
  std::vector<std::pair<std::string, std::string>> lines{
      {"complete", state_text(info, being_written, age.idle)}};
  auto now = info.last_sample;
  if (info.frames > 0 && (!now || info.frame_steps.back() > now->step))
    now = {info.frame_steps.back(), info.frame_times.back(), info.frame_scalars.back()};
  if (!now) return lines;
  auto const plan = planned_steps(info);
  lines.emplace_back("progress", progress_text(info, *now, plan.steps));

  bool const has_ended = info.cost.wall_seconds > 0;  // a run writes this at its end
  if (has_ended || age.written == 0) return lines;
  auto time = duration_text(age.written);
  auto const first = info.frames > 0 ? info.frame_steps.front() : now->step;
  double const rate = static_cast<double>(now->step - first) / age.written;  // steps per second
  if (rate > 0 && plan.equal_steps) {
    auto const& shape = info.header.shape;
    auto const sites = static_cast<double>(shape[0]) * static_cast<double>(shape[1] * shape[2]);
    time += fmt::format(", {}spin updates/s", rate_text(rate * sites));
  }
  if (rate > 0 && plan.steps > 0 && being_written != false) {
    double const left = static_cast<double>(plan.steps - now->step) / rate - age.idle;
    time += fmt::format(", {} left", duration_text(std::max(0.0, left)));
  }
  lines.emplace_back("time", time);
  return lines;
}

}  // namespace cayspin::program
