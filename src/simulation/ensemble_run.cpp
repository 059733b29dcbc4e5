// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ensemble_run.hpp"

#include "ensemble_plan.hpp"
#include "failure.hpp"
#include "io/notes.hpp"
#include "run_files.hpp"
#include "scene_minimizer.hpp"
#include "text.hpp"
#include "turn.hpp"
#include "warning_of_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace cayspin::simulation {
namespace {

void require_memory_of_all(io::Scene const& scene, io::Scene const& replica, Precision precision,
                           bool relaxes, std::int64_t replicas,
                           std::optional<std::int64_t> available = {}) {
  auto const plan =
      relaxes ? make_plan_to_relax(replica, precision) : make_plan(replica, precision);
  require_memory_of_replicas(scene, memory_of_replicas(replica, plan, precision, replicas),
                             available);
}

}  // namespace

EnsembleRun::EnsembleRun(io::Scene const& scene, RunSettings const& settings, bool relaxes,
                         ReplicaShare const& share)
    : scene_(scene), settings_(settings), share_(share) {
  auto const replicas = static_cast<std::size_t>(share.own.count);
  at_rest_.assign(replicas, false);
  runs_.reserve(replicas);  // no reallocation, because other threads read the first run
  for (std::size_t number = 0; number < replicas; ++number) {
    auto const at = number_of(number);
    auto const replica = relaxes ? io::replica_to_relax(scene, at) : io::replica_of(scene, at);
    // Columns need less memory, and are tried first.
    if (number == 1 || (replicas == 1 && share.on_this_machine > 1))
      require_memory_of_all(scene, replica, settings.precision, relaxes, share.on_this_machine,
                            share.available);
    try {
      runs_.push_back(SceneRun::open(replica, settings));
    } catch (io::SceneError const& error) {
      throw io::SceneError(fmt::format("replica {}: {}", at, error.what()));
    }
    if (number > 0 || relaxes) continue;
    columns_ = ReplicaColumns::open(scene, replica, settings, share);
    if (columns_) break;
  }
  if (!columns_) return;
  auto const epsilon = settings.precision == Precision::double_precision
                           ? std::numeric_limits<double>::epsilon()
                           : static_cast<double>(std::numeric_limits<float>::epsilon());
  guards_.assign(replicas, Guard(first().scene(), epsilon));
  auto of_replica = first().scene();
  auto const& values = columns_->values();
  if (values.temperatures.empty() && values.dampings.empty()) return;
  for (std::size_t number = 0; number < replicas; ++number) {
    values.put(number, of_replica);
    guards_[number] = Guard(of_replica, epsilon);
  }
}

std::optional<std::string> EnsembleRun::warning() const {
  Turn::Reserved const turn;
  auto const named = [&](std::size_t number, std::string const& text) {
    return fmt::format("replica {}: {}", number_of(number), text);
  };
  if (columns_) {
    auto const& one = first().scene();
    auto const found = warning_of_columns(one, columns_->values(), settings_.precision);
    if (!found) return std::nullopt;
    auto const warning = named(found->column, found->text);
    if (one.integrator.refuse_unstable) throw io::SceneError(warning);
    return warning;
  }
  for (std::size_t number = 0; number < runs_.size(); ++number) {
    try {
      if (auto const warning = runs_[number]->warning()) return named(number, *warning);
    } catch (io::SceneError const& error) {
      throw io::SceneError(named(number, error.what()));
    }
  }
  return std::nullopt;
}

std::int64_t EnsembleRun::evaluations() const {
  Turn::Reserved const turn;
  if (columns_) return columns_->evaluations();
  std::int64_t all = 0;
  for (auto const& run : runs_) all += run->evaluations();
  return all;
}

double EnsembleRun::step_seconds() const {
  Turn::Reserved const turn;
  if (columns_) return columns_->step_seconds();
  double all = seconds_of_columns_;
  for (auto const& run : runs_) all += run->step_seconds();
  return all;
}

bool EnsembleRun::is_at_rest() const {
  Turn::Reserved const turn;
  return std::ranges::all_of(at_rest_, [](bool rests) { return rests; });
}

Looks EnsembleRun::looks(bool until_torque, std::function<bool()> interrupted) const {
  auto const& scene = first().scene();
  bool const may_end = until_torque && scene.integrator.until_torque;
  return {.period = may_end ? Guard::period_of(io::sites(scene)) : 100,
          .until_torque = until_torque,
          .interrupted = std::move(interrupted),
          .at_end = true};
}

Advanced EnsembleRun::advance(std::int64_t count, Looks const& looks) {
  Turn::Reserved const turn;
  auto const target = steps_ + count;
  if (!looks.until_torque) at_rest_.assign(replicas(), false);
  return columns_ ? advance_columns(target, looks) : advance_runs(target, looks);
}

std::int64_t EnsembleRun::steps_of_all() const {
  auto least = std::numeric_limits<std::int64_t>::max(), most = steps_.load();
  for (std::size_t number = 0; number < runs_.size(); ++number) {
    auto const steps = runs_[number]->steps();
    most = std::max(most, steps);
    if (!at_rest_[number]) least = std::min(least, steps);
  }
  return std::min(least, most);
}

Advanced EnsembleRun::advance_runs(std::int64_t target, Looks const& looks) {
  std::vector<SceneRun*> moving;
  std::vector<std::size_t> numbers;
  for (std::size_t number = 0; number < runs_.size(); ++number) {
    if (at_rest_[number]) continue;
    moving.push_back(runs_[number].get());
    numbers.push_back(number);
  }
  auto const outcomes = SceneRun::advance_all(moving, target, looks);
  bool interrupted = false;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    interrupted = interrupted || outcomes[i].advanced == Advanced::interrupted;
    at_rest_[numbers[i]] = outcomes[i].advanced == Advanced::at_rest;
  }
  steps_ = steps_of_all();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (!outcomes[i].error) continue;
    try {
      std::rethrow_exception(outcomes[i].error);
    } catch (NumbersFailed const& failure) {
      throw NumbersFailed(fmt::format("replica {}: {}", number_of(numbers[i]), failure.what()));
    }
  }
  if (interrupted) return Advanced::interrupted;
  return is_at_rest() ? Advanced::at_rest : Advanced::whole;
}

Advanced EnsembleRun::advance_columns(std::int64_t target, Looks const& looks) {
  // Separate runs, too, check the state from which they start.
  if (target > steps_ && guards_.front().last_look() < 0) check_columns();
  samples_.clear();
  auto const ended = columns_->advance(target, looks);
  steps_ = columns_->steps();
  if (ended.error) {
    // A lattice of columns does not tell which of its replicas failed; separate runs of the
    // replicas do.
    for (auto const failed : ended.failed) {
      auto const number = share_.own.first + failed;
      auto const run = SceneRun::open(io::replica_of(scene_, number), settings_);
      columns_->continue_in(*run, failed);
      try {
        run->advance(target - run->steps(), looks);
      } catch (NumbersFailed const& failure) {
        throw NumbersFailed(fmt::format("replica {}: {}", number, failure.what()));
      }
    }
    check_columns();  // an energy that rose before the step from which these runs continued
    try {
      std::rethrow_exception(ended.error);
    } catch (NumbersFailed const& failure) {
      throw NumbersFailed(fmt::format("replicas {} to {}: {}",
                                      share_.own.first + ended.failed.front(),
                                      share_.own.first + ended.failed.back(), failure.what()));
    }
  }
  if (ended.interrupted) return Advanced::interrupted;
  if (looks.at_end) check_columns();
  return Advanced::whole;
}

void EnsembleRun::check_columns() {
  auto const& units = first().scene().units;
  if (samples_.empty()) samples_ = columns_->samples();
  for (std::size_t number = 0; number < samples_.size(); ++number) {
    auto const& [step, time, energy, defect, m, rate] = samples_[number];
    auto const failure = guards_[number].judge(
        {step, time / units.time, 0, false},
        {energy.value / units.energy, energy.magnitude / units.energy}, defect);
    if (failure)
      throw NumbersFailed(
          fmt::format("replica {}: {}: {}", number_of(number), scene_.path.string(), *failure));
  }
}

void EnsembleRun::leave_columns() {
  require_memory_of_all(scene_, first().scene(), settings_.precision, false,
                        share_.on_this_machine);
  // If an exception is thrown here, the columns stay in use. The first run is not replaced, because
  // other threads read it.
  std::vector<std::unique_ptr<SceneRun>> others;
  for (std::size_t number = 1; number < replicas(); ++number) {
    others.push_back(SceneRun::open(io::replica_of(scene_, number_of(number)), settings_));
    columns_->continue_in(*others.back(), static_cast<std::int64_t>(number));
  }
  columns_->continue_in(*runs_.front(), 0);
  for (auto& run : others) runs_.push_back(std::move(run));
  seconds_of_columns_ = columns_->step_seconds();
  columns_.reset();
}

std::vector<Minimum> EnsembleRun::relax(RelaxSettings const& settings) {
  Turn::Reserved const turn;
  first().require_relaxable(settings);
  at_rest_.assign(replicas(), false);
  if (columns_) leave_columns();
  std::vector<SceneRun*> all;
  for (auto const& run : runs_) all.push_back(run.get());
  std::vector<Minimum> found;
  for (auto const& [minimum, error] : SceneRun::relax_all(all, settings)) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (NumbersFailed const& failure) {
      throw NumbersFailed(fmt::format("replica {}: {}", number_of(found.size()), failure.what()));
    }
    found.push_back(minimum);
  }
  return found;
}

std::vector<io::Scalars> EnsembleRun::scalars() {
  Turn::Reserved const turn;
  std::vector<io::Scalars> all;
  if (columns_) {
    if (samples_.empty()) samples_ = columns_->samples();
    for (auto const& sample : samples_) all.push_back(as_scalars(sample, {}));  // in scene units
    return all;
  }
  for (auto const& run : runs_) all.push_back(as_scalars(run->sample(), {}));  // in scene units
  return all;
}

std::vector<std::byte> EnsembleRun::spins() {
  Turn::Reserved const turn;
  std::vector<std::byte> all;
  bool const in_double = first().precision() == Precision::double_precision;
  all.reserve(replicas() * static_cast<std::size_t>(3 * io::sites(first().scene())) *
              (in_double ? sizeof(double) : sizeof(float)));
  auto const add = [&](auto const& numbers) {
    auto const bytes = std::as_bytes(std::span(numbers));
    all.insert(all.end(), bytes.begin(), bytes.end());
  };
  if (columns_) {
    in_double ? add(columns_->spins<double>()) : add(columns_->spins<float>());
    return all;
  }
  for (auto const& run : runs_) {
    auto const lent = run->spins();
    in_double ? add(packed<double>(lent.vectors)) : add(packed<float>(lent.vectors));
  }
  return all;
}

}  // namespace cayspin::simulation
