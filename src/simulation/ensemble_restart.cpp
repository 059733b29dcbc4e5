// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The start of an ensemble from files of an earlier run, and its checkpoints.
#include "ensemble_run.hpp"
#include "failure.hpp"
#include "io/ensemble_checkpoint.hpp"
#include "io/notes.hpp"
#include "plan.hpp"
#include "restart.hpp"
#include "text.hpp"
#include "turn.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

namespace cayspin::simulation {
namespace {

std::vector<double> spins_of(std::vector<io::ReplicaState> const& states) {
  std::vector<double> spins;
  for (auto const& state : states) {
    auto const found = state.fields.find("spins");
    if (found != state.fields.end())
      spins.insert(spins.end(), found->second.begin(), found->second.end());
  }
  return spins;
}

// Returns the noise of the hottest replica; that of the scene itself if no temperature is varied.
std::optional<io::Thermal> hottest_noise(io::Scene const& scene) {
  for (auto const& [key, values] : scene.ensemble.vary)
    if (key == "thermal.temperature")
      return io::replica_of(scene, std::ranges::max_element(values) - values.begin()).thermal;
  return scene.thermal;
}

}  // namespace

io::Scene EnsembleRun::scene_of_first() const {
  if (share_.own.first == 0) return first().scene();
  return io::with_shape_of_start(io::replica_of(scene_, 0));
}

std::optional<std::string> EnsembleRun::continue_from(std::filesystem::path const& file) {
  Turn::Reserved const turn;
  std::optional<io::EnsembleInfo> info;
  if (io::is_ensemble(file)) info = io::read_ensemble_info(file);
  auto const checkpoint = info ? io::checkpoint_beside(file) : file;
  std::error_code ignored;
  std::optional<io::EnsembleCheckpointInfo> stored;
  if (info ? std::filesystem::exists(checkpoint, ignored) : io::is_ensemble_checkpoint(file))
    stored = io::read_ensemble_checkpoint(checkpoint);
  if (!info && !stored) {
    auto const kind = io::kind_of_other_file(file);
    throw UsageError(fmt::format("{}: it is {}; accepted: the file of an ensemble", file.string(),
                                 kind.empty() ? "of a scene without [ensemble]" : kind));
  }
  auto const require_replicas = [&](std::filesystem::path const& of, std::int64_t found) {
    if (found != scene_.ensemble.replicas)
      throw UsageError(fmt::format("{}: it has {}, and the scene has {}; accepted: the same number",
                                   of.string(), counted(found, "replica"),
                                   scene_.ensemble.replicas));
  };
  if (info) require_replicas(file, info->ensemble.replicas);
  if (stored) require_replicas(checkpoint, stored->replicas());
  auto const of_first = scene_of_first();
  auto const plan = make_plan(of_first, settings_.precision);
  auto const end =
      scene_.integrator.steps > 0 ? plan.times.steps : std::numeric_limits<std::int64_t>::max();
  // Times are in the units of the ensemble's first replica, as in the file. These units differ from
  // those of the ensemble's own scene if, for example, the damping is varied.
  auto scene = scene_;
  scene.units = of_first.units;
  scene.integrator.dt = of_first.integrator.dt;
  scene.thermal = hottest_noise(scene_);
  Restart const restart({file, info ? &*info : nullptr, stored ? &stored->header : nullptr}, scene,
                        plan, settings_.precision, end);
  bool const in_checkpoint = restart.uses_checkpoint();
  auto const states = in_checkpoint ? io::read_replica_states(checkpoint, *stored, share_.own)
                                    : std::vector<io::ReplicaState>();
  if (restart.restores_memory() && restart.differs_in("integrator.until_torque") &&
      std::ranges::any_of(states, &io::ReplicaState::has_ended))
    throw UsageError(
        fmt::format("{}: some of its replicas have ended early; accepted: the "
                    "until_torque that it was run with",
                    file.string()));
  auto const is_ahead = [&](io::ReplicaState const& state) {
    return !state.has_ended && state.step != stored->header.step;
  };
  if (!restart.restores_memory() && std::ranges::any_of(states, is_ahead))
    throw UsageError(
        fmt::format("{}: it was interrupted, and the replicas in {} are at different "
                    "steps; accepted: the scene that it was run with, or no such file",
                    file.string(), checkpoint.string()));
  auto const spins =
      in_checkpoint ? spins_of(states) : io::read_ensemble_spins(file, *info, share_.own);
  auto const size = static_cast<std::size_t>(3 * io::sites(first().scene()));
  if (spins.size() != size * replicas())
    throw UsageError(
        fmt::format("{}: it has the spins of another lattice; accepted: the lattice "
                    "of the scene",
                    file.string()));
  require_vacancies(file, spins);
  steps_ = restart.step();
  at_rest_.assign(replicas(), false);
  samples_.clear();
  if (columns_) columns_->continue_from(steps_, spins);
  for (std::size_t number = 0; number < runs_.size(); ++number) {
    auto const begin = spins.begin() + static_cast<std::ptrdiff_t>(size * number);
    runs_[number]->continue_from(steps_, {begin, begin + static_cast<std::ptrdiff_t>(size)});
  }
  if (restart.restores_memory()) restore(states);
  return restart.warning();
}

void EnsembleRun::require_vacancies(std::filesystem::path const& file,
                                    std::vector<double> const& spins) const {
  auto const& scene = first().scene();
  if (scene.system.kind != io::SystemKind::llg) return;
  io::SiteBox const all{{0, 0, 0}, scene.lattice.shape};
  auto const occupied = io::occupied(scene, all);
  auto const size = static_cast<std::size_t>(3 * io::sites(scene));
  for (std::size_t begin = 0; begin < spins.size(); begin += size)
    require_same_vacancies(file, all, occupied, std::span(spins).subspan(begin, size));
}

void EnsembleRun::restore(std::vector<io::ReplicaState> const& states) {
  // The replicas of a lattice of columns are at the same step.
  auto const differs = [&](io::ReplicaState const& state) {
    return state.step != states.front().step;
  };
  if (columns_ && std::ranges::any_of(states, differs)) leave_columns();
  if (columns_) {
    columns_->restore(states);
    return;
  }
  for (std::size_t number = 0; number < runs_.size(); ++number) {
    auto state = states[number];
    runs_[number]->continue_from(state.step, state.fields.at("spins"));
    runs_[number]->exchange_with(state);
    at_rest_[number] = state.has_ended;
  }
}

std::int64_t EnsembleRun::furthest() const {
  Turn::Reserved const turn;
  if (columns_) return std::max(steps(), columns_->furthest());
  auto most = steps();
  for (std::size_t number = 0; number < runs_.size(); ++number)
    if (!at_rest_[number]) most = std::max(most, runs_[number]->steps());
  return most;
}

std::size_t EnsembleRun::states_at_once() const {
  constexpr std::int64_t bytes = 4 << 20;
  if (columns_) return replicas();
  return static_cast<std::size_t>(
      std::clamp<std::int64_t>(bytes / (24 * io::sites(first().scene())), 1, share_.own.count));
}

std::vector<io::ReplicaState> EnsembleRun::states(std::size_t begin) {
  Turn::Reserved const turn;
  std::vector<io::ReplicaState> states;
  if (columns_) {
    if (begin > 0) return states;
    auto guards = guards_;  // copies, as in SceneRun: a checkpoint must not change later checks
    check_columns();
    guards_ = std::move(guards);
    return columns_->states();
  }
  auto const end = std::min(replicas(), begin + states_at_once());
  for (auto number = begin; number < end; ++number) {
    auto& run = *runs_[number];
    try {
      run.judged_sample();
    } catch (NumbersFailed const& failure) {
      throw NumbersFailed(fmt::format("replica {}: {}", number_of(number), failure.what()));
    }
    auto& state = states.emplace_back();
    state.step = run.steps();
    state.has_ended = at_rest_[number];
    run.exchange_with(state);
  }
  return states;
}

}  // namespace cayspin::simulation
