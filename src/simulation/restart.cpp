// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "restart.hpp"

#include "dear_method.hpp"
#include "failure.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

namespace cayspin::simulation {
namespace {

// Did the scene run by the same method as the plan's? One that cannot be read counts as such.
bool ran_alike(std::string const& scene_as_run, io::Scene const& scene, Plan const& plan) {
  try {
    auto before = io::parse_scene(scene_as_run, scene.path, {}, scene.given);
    before.field.own = scene.field.own;  // no text has it
    return !before.integrator.method->automatic && &find_variant(before) == &plan.variant &&
           before.integrator.energy_control == scene.integrator.energy_control &&
           before.integrator.substeps == scene.integrator.substeps &&
           has_dear_field(before) == has_dear_field(scene);
  } catch (io::SceneError const&) {
    return true;
  }
}

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
  bool const alike = ran_alike(from_.scene_as_run(), scene, plan);
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
    refuse(fmt::format("its lattice is {}", cells_text(shape, cell_sites)), "the scene's lattice");
  if (stored != to_string(precision))
    refuse(fmt::format("its spins are in {} precision", stored),
           fmt::format("--precision {}", stored));
  auto const& units = scene.units;
  bool const is_si = trajectory ? trajectory->header.units.si : checkpoint->si;
  if (is_si != units.si)
    refuse(units.si ? "it is in reduced units" : "it is in SI units", "the units of the scene");
  // As the file's times were made, so that those of the same scene are equal to the bit.
  double const dt = scene.integrator.dt * units.time;
  if (std::abs(time - static_cast<double>(step_) * scene.integrator.dt * units.time) > 1e-9 * dt)
    refuse(fmt::format("its step {} is at t = {:.12g}{}, not at that many steps of dt = {:.12g}{}",
                       step_, time, units.si ? " s" : "", dt, units.si ? " s" : ""),
           "the dt it was run with");
  if (step_ >= end)
    refuse(fmt::format("it ends at step {}, the scene at step {}", step_, end),
           "a scene that goes on");
  if (needs_memory && !uses_checkpoint_)
    refuse("the run needs more than its frames to go on with the same bits, and " +
               io::checkpoint_beside(from_.path).string() + " is not there",
           "a file with its checkpoint, or initial.file in place of a restart: a run that starts "
           "from the last frame");
  if (uses_checkpoint_ && alike) memory_ = from_.checkpoint.get();
}

std::vector<double> Restart::spins(io::SiteBox const& box) const {
  return uses_checkpoint_ ? from_.checkpoint->field("spins", box)
                          : io::read_spins(from_.path, from_.trajectory->header.shape, box,
                                           from_.trajectory->header.cell_sites);
}

std::vector<double> Restart::spins() const {
  return spins(
      {{0, 0, 0},
       uses_checkpoint_ ? from_.checkpoint->header().shape : from_.trajectory->header.shape});
}

std::vector<std::filesystem::path> Restart::files() const {
  std::vector files{from_.path};
  if (from_.checkpoint) files.push_back(from_.checkpoint->path());
  return files;
}

}  // namespace cayspin::simulation
