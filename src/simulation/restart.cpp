// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "restart.hpp"

#include "dear_method.hpp"
#include "failure.hpp"
#include "io/changes.hpp"
#include "io/relax.hpp"
#include "text.hpp"

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
    before.field.own = scene.field.own;  // no text has it
    return before;
  } catch (io::SceneError const&) {
    return std::nullopt;
  }
}

// Did the scene run by the same method as the plan's?
bool ran_alike(io::Scene const& before, io::Scene const& scene, Plan const& plan) {
  return io::has_integrator(before) && !before.integrator.method->automatic &&
         &find_variant(before) == &plan.variant &&
         before.integrator.energy_control == scene.integrator.energy_control &&
         before.integrator.substeps == scene.integrator.substeps &&
         has_dear_field(before) == has_dear_field(scene);
}

// The key of the lattice that is another in the file; empty where none is, or that cannot be told.
std::string other_lattice_key(io::Scene const& before, io::Scene const& scene) {
  try {
    return io::changed_lattice_key(before, scene);
  } catch (io::SceneError const&) {
    return {};
  }
}

// What a run that goes on may have for itself: its start, its end and its output.
bool is_of_one_run(std::string const& key) {
  return key.starts_with("output") || key.starts_with("initial") || key.starts_with("lattice.") ||
         key == "integrator.steps" || key == "integrator.end";
}

// Do steps before mean nothing after a change of this key?
bool changes_motion(std::string const& key) {
  return key == "integrator.dt" || key == "units" ||
         !(key.starts_with("integrator") || key.starts_with("thermal"));
}

constexpr auto of_this_lattice = "the scene's lattice";

}  // namespace

bool remembers(io::Scene const& scene, Plan const& plan) {
  return plan.variant.remembers || scene.integrator.energy_control ||
         scene.integrator.until_torque.has_value() || has_dear_field(scene);
}

EarlierRun::EarlierRun(std::filesystem::path of_run) : path(std::move(of_run)) {
  if (io::is_checkpoint(path)) {
    checkpoint = std::make_unique<io::CheckpointReader>(path);
    return;
  }
  trajectory = io::read_info(path);
  auto const beside = io::checkpoint_beside(path);
  std::error_code ignored;
  if (!std::filesystem::exists(beside, ignored)) return;
  checkpoint = std::make_unique<io::CheckpointReader>(beside);
  if (checkpoint->header().scene_text != trajectory->header.scene_text)
    throw UsageError(
        fmt::format("{}: {} is of another scene; accepted: the checkpoint of the same run, or none",
                    path.string(), beside.string()));
}

std::string const& EarlierRun::scene_text() const {
  return trajectory ? trajectory->header.scene_text : checkpoint->header().scene_text;
}

std::string const& EarlierRun::resolved_scene() const {
  return trajectory ? trajectory->header.resolved_scene : checkpoint->header().resolved_scene;
}

std::string const& EarlierRun::scene_as_run() const {
  return resolved_scene().empty() ? scene_text() : resolved_scene();
}

Restart::Restart(EarlierRun from, io::Scene const& scene, Plan const& plan, Precision precision,
                 std::int64_t end)
    : from_(std::move(from)) {
  auto const refuse = [&](std::string const& wrong, std::string const& accepted) {
    throw UsageError(fmt::format("{}: {}; accepted: {}", from_.path.string(), wrong, accepted));
  };
  auto const* const checkpoint = from_.checkpoint ? &from_.checkpoint->header() : nullptr;
  auto const* const trajectory = from_.trajectory ? &*from_.trajectory : nullptr;
  auto const before = parsed(from_.scene_as_run(), scene);
  std::vector<std::string> changes;
  if (before) {
    changes = io::changed_keys(from_.scene_as_run(), scene.text);
    std::erase_if(changes, is_of_one_run);
  }
  // A scene that cannot be read counts as the same.
  bool const alike =
      !before || (ran_alike(*before, scene, plan) && std::ranges::none_of(changes, changes_motion));
  bool const needs_memory = alike && remembers(scene, plan);
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
      refuse(fmt::format("its {} is another than the scene's", key),
             "the lattice that it was run with");
  if (stored != to_string(precision))
    refuse(fmt::format("its spins are in {} precision", stored),
           fmt::format("--precision {}", stored));
  // As the file's times were made, so that those of the same scene are equal to the bit.
  double const dt = scene.integrator.dt * units.time;
  auto const is_at = [&](std::int64_t step) {
    return std::abs(time - static_cast<double>(step) * scene.integrator.dt * units.time) <=
           1e-9 * dt;
  };
  if (!is_at(step_)) {
    // Noise is drawn by the number of the step.
    auto const step = std::llround(std::min(time / dt, 1e15));
    if (alike || scene.thermal || !is_at(step))
      refuse(
          fmt::format("its step {} is at t = {:.12g}{}, not at that many steps of dt = {:.12g}{}",
                      step_, time, units.si ? " s" : "", dt, units.si ? " s" : ""),
          scene.thermal ? "the dt it was run with"
                        : "the dt it was run with, or one of which t is a multiple");
    step_ = step;
  }
  if (step_ >= end)
    refuse(fmt::format("it ends at step {}, the scene at step {}", step_, end),
           "a scene that goes on");
  if (needs_memory && !uses_checkpoint_)
    refuse("the run needs more than its frames to go on with the same bits, and " +
               io::checkpoint_beside(from_.path).string() + " is not there",
           "a file with its checkpoint, or initial.file in place of a restart: a run that starts "
           "from the last frame");
  if (uses_checkpoint_ && alike) memory_ = from_.checkpoint.get();
  if (!before)
    warning_ = from_.path.string() + ": its scene cannot be read, and is taken for this one";
  else if (!changes.empty())
    warning_ = fmt::format("{}: other than in its scene: {}{}", from_.path.string(),
                           fmt::join(changes, ", "),
                           !alike && remembers(scene, plan) ? "; the method begins again" : "");
}

std::vector<double> Restart::spins(io::Scene const& scene, io::SiteBox const& box) const {
  auto spins = uses_checkpoint_ ? from_.checkpoint->field("spins", box)
                                : io::read_spins(from_.path, from_.trajectory->header.shape, box,
                                                 from_.trajectory->header.cell_sites);
  if (scene.system.kind != io::SystemKind::llg) return spins;
  auto const occupied = io::occupied(scene, box);
  for (std::size_t site = 0; site < spins.size() / 3; ++site) {
    auto const* const m = &spins[3 * site];
    bool const is_vacant = m[0] == 0 && m[1] == 0 && m[2] == 0;
    if (is_vacant == (!occupied.empty() && !occupied[site])) continue;
    auto const [nx, ny, nz] = box.extent;
    auto const number = static_cast<std::int64_t>(site);
    throw UsageError(fmt::format(
        "{}: its site ({}, {}, {}) {}, that of the scene's lattice.occupied {}; accepted: {}",
        from_.path.string(), box.begin[0] + number % nx, box.begin[1] + number / nx % ny,
        box.begin[2] + number / (nx * ny), is_vacant ? "is vacant" : "holds a spin",
        is_vacant ? "holds a spin" : "is vacant", of_this_lattice));
  }
  return spins;
}

std::vector<double> Restart::spins(io::Scene const& scene) const {
  return spins(scene, {{0, 0, 0}, scene.lattice.shape});
}

std::vector<std::filesystem::path> Restart::files() const {
  std::vector files{from_.path};
  if (from_.checkpoint) files.push_back(from_.checkpoint->path());
  return files;
}

}  // namespace cayspin::simulation
