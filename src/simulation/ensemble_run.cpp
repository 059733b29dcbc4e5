// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ensemble_run.hpp"

#include "failure.hpp"
#include "guard.hpp"
#include "plan.hpp"
#include "run_files.hpp"
#include "scene_minimizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <span>
#include <utility>

namespace cayspin::simulation {
namespace {

void require_memory_of_all(io::Scene const& scene, io::Scene const& replica, Precision precision,
                           bool relaxes) {
  auto const plan =
      relaxes ? make_plan_to_relax(replica, precision) : make_plan(replica, precision);
  require_memory(scene, plan, static_cast<int>(scene.ensemble.replicas));
}

}  // namespace

EnsembleRun::EnsembleRun(io::Scene const& scene, RunSettings const& settings, bool relaxes) {
  for (std::int64_t number = 0; number < scene.ensemble.replicas; ++number) {
    auto const replica =
        relaxes ? io::replica_to_relax(scene, number) : io::replica_of(scene, number);
    if (number == 0) require_memory_of_all(scene, replica, settings.precision, relaxes);
    try {
      runs_.push_back(SceneRun::open(replica, settings));
    } catch (io::SceneError const& error) {
      throw io::SceneError(fmt::format("replica {}: {}", number, error.what()));
    }
  }
  at_rest_.assign(runs_.size(), false);
}

double EnsembleRun::time() const {
  double latest = 0;
  for (auto const& run : runs_) latest = std::max(latest, run->time());
  return latest;
}

std::int64_t EnsembleRun::evaluations() const {
  std::int64_t all = 0;
  for (auto const& run : runs_) all += run->evaluations();
  return all;
}

double EnsembleRun::step_seconds() const {
  double all = 0;
  for (auto const& run : runs_) all += run->step_seconds();
  return all;
}

bool EnsembleRun::is_at_rest() const {
  return std::ranges::all_of(at_rest_, [](bool rests) { return rests; });
}

Looks EnsembleRun::looks(bool until_torque, std::function<bool()> interrupted) const {
  auto const& scene = runs_.front()->scene();
  bool const may_end = until_torque && scene.integrator.until_torque;
  return {.period = may_end ? Guard::period_of(io::sites(scene)) : 100,
          .until_torque = until_torque,
          .interrupted = std::move(interrupted),
          .at_end = true};
}

Advanced EnsembleRun::advance(std::int64_t count, Looks const& looks) {
  std::vector<SceneRun*> moving;
  std::vector<std::size_t> numbers;
  for (std::size_t number = 0; number < runs_.size(); ++number) {
    if (at_rest_[number]) continue;
    moving.push_back(runs_[number].get());
    numbers.push_back(number);
  }
  auto const outcomes = SceneRun::advance_all(moving, count, looks);
  bool interrupted = false;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    auto const& [advanced, error] = outcomes[i];
    try {
      if (error) std::rethrow_exception(error);
    } catch (NumbersFailed const& failure) {
      throw NumbersFailed(fmt::format("replica {}: {}", numbers[i], failure.what()));
    }
    interrupted = interrupted || advanced == Advanced::interrupted;
    at_rest_[numbers[i]] = advanced == Advanced::at_rest;
  }
  if (interrupted) return Advanced::interrupted;
  for (auto const& run : runs_) steps_ = std::max(steps_, run->steps());
  return is_at_rest() ? Advanced::at_rest : Advanced::whole;
}

std::vector<Minimum> EnsembleRun::relax(RelaxSettings const& settings) {
  std::vector<SceneRun*> all;
  for (auto const& run : runs_) all.push_back(run.get());
  std::vector<Minimum> found;
  for (auto const& [minimum, error] : SceneRun::relax_all(all, settings)) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (NumbersFailed const& failure) {
      throw NumbersFailed(fmt::format("replica {}: {}", found.size(), failure.what()));
    }
    found.push_back(minimum);
  }
  return found;
}

std::vector<io::Scalars> EnsembleRun::scalars() {
  std::vector<io::Scalars> all;
  for (auto const& run : runs_) all.push_back(as_scalars(run->sample(), {}));  // in its units
  return all;
}

std::vector<std::byte> EnsembleRun::spins() {
  std::vector<std::byte> all;
  auto const add = [&](auto const& numbers) {
    auto const bytes = std::as_bytes(std::span(numbers));
    all.insert(all.end(), bytes.begin(), bytes.end());
  };
  for (auto const& run : runs_) {
    auto const lent = run->spins();
    if (run->precision() == Precision::double_precision)
      add(packed<double>(lent.vectors));
    else
      add(packed<float>(lent.vectors));
  }
  return all;
}

}  // namespace cayspin::simulation
