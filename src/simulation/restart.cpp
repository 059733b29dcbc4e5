// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "restart.hpp"

#include "failure.hpp"
#include "io/changes.hpp"
#include "io/ensemble_checkpoint.hpp"
#include "io/relax.hpp"
#include "multirate_method.hpp"
#include "text.hpp"
#include "thermal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace cayspin::simulation {
namespace {

std::optional<io::Scene> parsed(std::string const& scene_as_run, io::Scene const& scene) {
  try {
    auto before = io::parse_scene_to_run_or_relax(scene_as_run, scene.path, {}, scene.given);
    before.field.own = scene.field.own;  // functions are not in the text
    return before;
  } catch (io::SceneError const&) {
    return std::nullopt;
  }
}

// Returns the stage that starts at `begin`, as it is in the scene of the file.
std::optional<io::Scene> same_stage(std::optional<io::Scene> scene, io::StageBegin const& begin) {
  if (!scene || begin.stage == 0) return scene;
  if (begin.stage > std::ssize(scene->stages)) return std::nullopt;
  auto const at = static_cast<std::size_t>(begin.stage - 1);
  auto stage = std::move(scene->stages[at].scene);
  stage.field.own = scene->field.own;
  return stage;
}

// Returns the start of a stage, as it is in a file, with its time in the unit of that stage of
// `stages`. The unit depends on keys that may have changed, such as material.alpha.
io::StageBegin in_units_of(std::vector<io::Stage> const& stages, io::StageBegin begin,
                           std::string const& scene_as_run) {
  if (begin.time == 0 || begin.stage < 0 || begin.stage >= std::ssize(stages)) return begin;
  auto const& now = stages[static_cast<std::size_t>(begin.stage)].scene;
  auto const before = same_stage(parsed(scene_as_run, now), begin);
  if (before && before->units.time != now.units.time)
    begin.time *= before->units.time / now.units.time;
  return begin;
}

bool remembers(io::Scene const& scene, Variant const& variant) {
  return variant.remembers || scene.integrator.energy_control ||
         scene.integrator.until_torque.has_value() || has_slow_field(scene) ||
         scene.lattice.follow.has_value();
}

// Returns true if the earlier run, of the scene `before`, used the plan's method, and if its memory
// of steps has what the keys of `scene` need.
bool ran_alike(io::Scene const& before, io::Scene const& scene, Plan const& plan) {
  return io::has_integrator(before) && !before.integrator.method->automatic &&
         &find_variant(before) == &plan.variant &&
         before.integrator.energy_control == scene.integrator.energy_control &&
         before.integrator.substeps == scene.integrator.substeps &&
         before.lattice.follow.has_value() == scene.lattice.follow.has_value() &&
         (before.integrator.until_torque || !scene.integrator.until_torque) &&
         has_slow_field(before) == has_slow_field(scene);
}

// Returns the key of the lattice that differs in the file; empty if none does, or if the lattices
// cannot be compared.
std::string other_lattice_key(io::Scene const& before, io::Scene const& scene) {
  try {
    return io::changed_lattice_key(before, scene);
  } catch (io::SceneError const&) {
    return {};
  }
}

// Returns true for keys that may differ without a warning in a continued run: its start, end and
// output. The lattice is checked separately.
bool is_of_one_run(std::string const& key) {
  bool const is_checked = key.starts_with("lattice.") && !key.starts_with("lattice.regions") &&
                          !key.starts_with("lattice.follow");
  return is_checked || key.starts_with("output") || key.starts_with("initial") ||
         key.starts_with("stage") || key == "integrator.steps" || key == "integrator.end";
}

// Returns true if a change of this key makes the memory of earlier steps useless.
bool changes_motion(std::string const& key) {
  return key == "integrator.dt" || key == "units" ||
         !(key.starts_with("integrator") || key.starts_with("thermal"));
}

constexpr auto of_this_lattice = "the scene's lattice";

// `of_checkpoint`: the scene of the checkpoint beside the file.
void require_same_scene(std::filesystem::path const& path, std::string const& of_file,
                        std::string const& of_checkpoint) {
  if (of_file != of_checkpoint)
    throw UsageError(
        fmt::format("{}: {} is of another scene; accepted: the checkpoint of the same run, or none",
                    path.string(), io::checkpoint_beside(path).string()));
}

}  // namespace

bool remembers(io::Scene const& scene, Plan const& plan) { return remembers(scene, plan.variant); }

EarlierRun::EarlierRun(std::filesystem::path of_run) : path(std::move(of_run)) {
  if (io::is_checkpoint(path)) {
    checkpoint = std::make_unique<io::CheckpointReader>(path);
    return;
  }
  if (io::is_ensemble(path) || io::is_ensemble_checkpoint(path))
    throw UsageError(
        fmt::format("{}: it is of an ensemble; accepted: a scene with [ensemble], or "
                    "a trajectory or checkpoint",
                    path.string()));
  trajectory = io::read_info(path);
  if (trajectory->cost.relaxed) {  // its steps and times are the numbers of the states
    std::ranges::fill(trajectory->frame_steps, 0);
    std::ranges::fill(trajectory->frame_times, 0.0);
  }
  auto const beside = io::checkpoint_beside(path);
  std::error_code ignored;
  if (!std::filesystem::exists(beside, ignored)) return;
  checkpoint = std::make_unique<io::CheckpointReader>(beside);
  require_same_scene(path, trajectory->header.scene_text, checkpoint->header().scene_text);
}

EarlierRun::EarlierRun(std::filesystem::path of_run, io::EnsembleInfo const* info,
                       io::CheckpointHeader const* of_checkpoint)
    : path(std::move(of_run)), is_ensemble(true) {
  if (of_checkpoint) of_ensemble = *of_checkpoint;
  if (!info) return;
  if (of_checkpoint) require_same_scene(path, info->header.scene_text, of_checkpoint->scene_text);
  auto& last = trajectory.emplace();
  last.header = info->header;
  if (info->frames == 0) return;
  last.frames = 1;
  last.frame_steps = {info->step};
  last.frame_times = {info->time};
}

io::CheckpointHeader const* EarlierRun::checkpoint_header() const {
  if (checkpoint) return &checkpoint->header();
  return of_ensemble ? &*of_ensemble : nullptr;
}

std::string const& EarlierRun::scene_text() const {
  return trajectory ? trajectory->header.scene_text : checkpoint_header()->scene_text;
}

std::string const& EarlierRun::resolved_scene() const {
  return trajectory ? trajectory->header.resolved_scene : checkpoint_header()->resolved_scene;
}

std::string const& EarlierRun::scene_as_run() const {
  return resolved_scene().empty() ? scene_text() : resolved_scene();
}

LastFrame last_frame(io::TrajectoryInfo const& trajectory, std::vector<io::Stage> stages) {
  if (trajectory.frames == 0) return {};
  auto const frames = static_cast<std::size_t>(trajectory.frames);
  auto const& steps = trajectory.frame_steps;
  auto const& of_frames = trajectory.frame_stages;
  LastFrame state{trajectory.header.stage.value_or(io::StageBegin{}), steps.back()};
  for (std::size_t frame = 0; frame < of_frames.size() && frame < frames; ++frame)
    while (state.begin.stage < of_frames[frame]) {
      auto const now = static_cast<std::size_t>(state.begin.stage), next = now + 1;
      if (next >= stages.size() || frame == 0)
        throw UsageError(
            fmt::format("{}: its frame {} is of stage {}; accepted: a scene with that stage",
                        trajectory.path.string(), frame, of_frames[frame]));
      stages[now].scene.begin = state.begin;
      state.begin = io::begin_after(stages[now].scene, steps[frame - 1], stages[next].scene);
    }
  return state;
}

io::StageBegin EarlierRun::enter(std::vector<io::Stage> stages) {
  auto const* const stored = checkpoint ? &checkpoint->header() : nullptr;
  auto const begin_now = [&](io::StageBegin const& begin) {
    return in_units_of(stages, begin, scene_as_run());
  };
  auto const of_checkpoint = stored ? begin_now(stored->stage) : io::StageBegin{};
  if (trajectory && trajectory->header.stage)
    trajectory->header.stage = begin_now(*trajectory->header.stage);
  auto const in_file =
      trajectory && trajectory->header.stage ? *trajectory->header.stage : of_checkpoint;
  if (stages.size() == 1) {
    bool const has_left = in_file.stage > 0 || (trajectory && !trajectory->frame_stages.empty() &&
                                                trajectory->frame_stages.back() > 0);
    return has_left ? io::StageBegin{} : in_file;
  }
  auto state = trajectory ? last_frame(*trajectory, stages) : LastFrame{};
  bool const has_frame = state.step >= 0;
  auto const use_checkpoint = [&] {
    if (has_frame && of_checkpoint.stage != state.begin.stage) trajectory->frames = 0;
    state = {of_checkpoint, stored->step};
  };
  bool from_checkpoint = stored && (!has_frame || std::pair(stored->stage.stage, stored->step) >
                                                      std::pair(state.begin.stage, state.step));
  if (from_checkpoint) use_checkpoint();
  auto const at = [&]() -> io::Stage& {
    if (state.begin.stage < 0 || state.begin.stage >= std::ssize(stages))
      throw UsageError(fmt::format("{}: it is in stage {}; accepted: a scene with that stage",
                                   path.string(), state.begin.stage));
    auto& stage = stages[static_cast<std::size_t>(state.begin.stage)];
    stage.scene.begin = state.begin;
    return stage;
  };
  auto const has_ended = [&] {
    auto const& stage = at();
    return stage.relax ? !from_checkpoint : state.step >= io::end_of(stage);
  };
  bool const ended = has_ended();
  // The method's memory may be older than the last frame, and belong to an earlier stage.
  if (!ended && !from_checkpoint && stored && stored->stage.stage < state.begin.stage &&
      remembers(at().scene, find_variant(at().scene))) {
    from_checkpoint = true;
    use_checkpoint();
  }
  auto const next = static_cast<std::size_t>(state.begin.stage) + 1;
  if (ended && next < stages.size()) {
    at_begin = true;
    if (!from_checkpoint) checkpoint.reset();
    return io::begin_after(at().scene, state.step, stages[next].scene);
  }
  if (!from_checkpoint && stored && stored->stage.stage != state.begin.stage) checkpoint.reset();
  at_begin = state.begin.stage > 0 && state.step == state.begin.step;
  return at().scene.begin;
}

void require_same_vacancies(std::filesystem::path const& path, io::SiteBox const& box,
                            std::vector<unsigned char> const& occupied,
                            std::span<double const> spins) {
  for (std::size_t site = 0; site < spins.size() / 3; ++site) {
    auto const* const m = &spins[3 * site];
    bool const is_vacant = m[0] == 0 && m[1] == 0 && m[2] == 0;
    if (is_vacant == (!occupied.empty() && !occupied[site])) continue;
    auto const [nx, ny, nz] = box.extent;
    auto const number = static_cast<std::int64_t>(site);
    throw UsageError(fmt::format(
        "{}: its site ({}, {}, {}) {}, that of the scene's lattice.occupied {}; accepted: {}",
        path.string(), box.begin[0] + number % nx, box.begin[1] + number / nx % ny,
        box.begin[2] + number / (nx * ny), is_vacant ? "is vacant" : "holds a spin",
        is_vacant ? "holds a spin" : "is vacant", of_this_lattice));
  }
}

Restart::Restart(EarlierRun from, io::Scene const& scene, Plan const& plan, Precision precision,
                 std::int64_t end)
    : from_(std::move(from)) {
  auto const refuse = [&](std::string const& wrong, std::string const& accepted) {
    throw UsageError(fmt::format("{}: {}; accepted: {}", from_.path.string(), wrong, accepted));
  };
  auto const* const checkpoint = from_.checkpoint_header();
  auto const* const trajectory = from_.trajectory ? &*from_.trajectory : nullptr;
  auto const ran = parsed(from_.scene_as_run(), scene);
  auto const before = same_stage(ran, scene.begin);
  auto& changes = changes_;
  if (before) {
    changes = io::changed_keys(before->text, scene.text);
    std::erase_if(changes, is_of_one_run);
  }
  // A scene that cannot be read counts as equal.
  bool const alike =
      !before || (ran_alike(*before, scene, plan) && std::ranges::none_of(changes, changes_motion));
  bool const needs_memory = alike && !from_.at_begin && remembers(scene, plan);
  bool const has_frame = trajectory && trajectory->frames > 0;
  uses_checkpoint_ = checkpoint && (!has_frame || needs_memory ||
                                    checkpoint->step > trajectory->frame_steps.back());
  if (!uses_checkpoint_ && !has_frame) refuse("it holds no frame", "a file with one");

  auto const& shape = uses_checkpoint_ ? checkpoint->shape : trajectory->header.shape;
  auto const cell_sites = uses_checkpoint_ ? checkpoint->cell_sites : trajectory->header.cell_sites;
  auto const& stored = uses_checkpoint_ ? checkpoint->precision : trajectory->header.precision;
  double const time = uses_checkpoint_ ? checkpoint->time : trajectory->frame_times.back();
  step_ = uses_checkpoint_ ? checkpoint->step : trajectory->frame_steps.back();
  if (shape != scene.lattice.shape || cell_sites != std::ssize(scene.lattice.basis))
    refuse(fmt::format("its lattice is {}", cells_text(shape, cell_sites)), of_this_lattice);
  auto const& units = scene.units;
  bool const is_si = trajectory ? trajectory->header.units.si : checkpoint->si;
  if (is_si != units.si)
    refuse(units.si ? "it is in reduced units" : "it is in SI units", "the units of the scene");
  if (before)
    if (auto const key = other_lattice_key(*before, scene); !key.empty())
      refuse(fmt::format("its {} differs from the scene's", key),
             "the lattice that it was run with");
  if (stored != to_string(precision))
    refuse(fmt::format("its spins are in {} precision", stored),
           fmt::format("--precision {}", stored));
  // Times are computed as for the file, so that those of the same scene are bitwise equal.
  double const dt = scene.integrator.dt * units.time;
  auto const is_at = [&](std::int64_t step) {
    double const round_off = 8 * std::numeric_limits<double>::epsilon() * time;
    return std::abs(time - plan.times.at(step) * units.time) <= 1e-9 * dt + round_off;
  };
  if (!is_at(step_)) {
    // Noise depends on the number of the step, so a run with noise must keep its step numbers.
    auto const step = std::llround(std::min(time / dt, 1e15));
    if (alike || scene.begin != io::StageBegin{} || is_thermal(scene) || !is_at(step))
      refuse(
          fmt::format("its step {} is at t = {:.12g}{}, not at that many steps of dt = {:.12g}{}",
                      step_, time, units.si ? " s" : "", dt, units.si ? " s" : ""),
          is_thermal(scene) ? "the dt it was run with"
                            : "the dt it was run with, or one of which t is a multiple");
    step_ = step;
  }
  if (step_ >= end && !from_.at_begin)
    refuse(fmt::format("it ends at step {}, the scene at step {}", step_, end),
           "a scene that ends later");
  if (needs_memory && !uses_checkpoint_)
    refuse("the run needs more than its frames to continue exactly, and " +
               io::checkpoint_beside(from_.path).string() + " is not there",
           from_.is_ensemble
               ? "a file with its checkpoint"
               : "a file with its checkpoint, or initial.file in place of a restart: a run that "
                 "starts from the last frame");
  restores_memory_ = uses_checkpoint_ && alike && !from_.at_begin;
  if (restores_memory_) memory_ = from_.checkpoint.get();
  auto const& follow = scene.lattice.follow;
  if (ran && ran->lattice.follow && follow && ran->lattice.follow->axis == follow->axis) {
    double shift = 0;
    if (uses_checkpoint_)
      from_.checkpoint->number("follow.shift", shift);
    else if (!trajectory->frame_shifts.empty())
      shift = static_cast<double>(trajectory->frame_shifts.back());
    shift_ = static_cast<std::int64_t>(shift);
  }
  if (!ran)
    warning_ = from_.path.string() +
               ": its scene cannot be read; it is assumed to be the same as this one";
  else if (!changes.empty())
    warning_ = fmt::format("{}: these keys differ from its scene: {}{}", from_.path.string(),
                           fmt::join(changes, ", "),
                           !alike && remembers(scene, plan) ? "; the method starts anew" : "");
}

std::vector<double> Restart::spins(io::Scene const& scene, io::SiteBox const& box) const {
  auto spins = uses_checkpoint_ ? from_.checkpoint->field("spins", box)
                                : io::read_spins(from_.path, from_.trajectory->header.shape, box,
                                                 from_.trajectory->header.cell_sites);
  if (scene.system.kind == io::SystemKind::llg)
    require_same_vacancies(from_.path, box, io::occupied(scene, box), spins);
  return spins;
}

std::vector<double> Restart::spins(io::Scene const& scene) const {
  return spins(scene, {{0, 0, 0}, scene.lattice.shape});
}

bool Restart::differs_in(std::string const& key) const {
  return std::ranges::find(changes_, key) != changes_.end();
}

std::vector<std::filesystem::path> Restart::files() const {
  std::vector files{from_.path};
  if (from_.checkpoint) files.push_back(from_.checkpoint->path());
  return files;
}

}  // namespace cayspin::simulation
