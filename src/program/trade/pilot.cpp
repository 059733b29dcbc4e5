// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "pilot.hpp"

#include "files/available_memory.hpp"
#include "reference.hpp"
#include "simulation/guard.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/text.hpp"
#include "simulation/thermal.hpp"

#include <Kokkos_Timer.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace cayspin::program::trade {
namespace {

template <class Real, class Space>
class KeepStates : public RunObserver<Space, SpinField<Real, typename Space::memory_space>> {
  using Spins = SpinField<Real, typename Space::memory_space>;

 public:
  KeepStates(std::vector<std::int64_t> const& steps, SceneGenerator<Spins> const& generator,
             std::optional<Guard> guard, Outcome& outcome)
      : steps_(steps), generator_(generator), guard_(std::move(guard)), outcome_(outcome) {}

  bool due(Step const& step) const override {
    return is_look(step) || (guard_ && guard_->due(step));
  }
  Next operator()(Space const& exec, Step const& step, Spins const& spins) override {
    if (is_look(step) && !keep(spins)) {
      outcome_.failure = "the spins are not finite";
    } else if (guard_) {
      auto const now = sample_scene(exec, generator_, step, spins);
      outcome_.failure = guard_->judge(step, now.energy, now.norm_defect);
    }
    return outcome_.failure ? Next::stop : Next::proceed;
  }

 private:
  bool is_look(Step const& step) const {
    auto const kept = outcome_.states.size();
    return kept < steps_.size() && step.number == steps_[kept];
  }
  // Keeps the spins; returns true if all are finite.
  bool keep(Spins const& spins) {
    auto const numbers = copy_to_host(spins);
    outcome_.states.emplace_back(numbers.begin(), numbers.end());
    return std::ranges::all_of(numbers, [](Real number) { return std::isfinite(number); });
  }

  std::vector<std::int64_t> const& steps_;
  SceneGenerator<Spins> const& generator_;
  std::optional<Guard> guard_;
  Outcome& outcome_;
};

template <class Real, class Space>
Outcome run_on(io::Scene const& scene, Plan const& plan, Stretch const& stretch, bool guarded) {
  Simulation<Real, Space> simulation(scene, plan.lattice, plan.times, stretch.start);
  Outcome outcome;
  std::optional<Guard> guard;
  constexpr double margin = 8;  // how much stricter than in a run, whose steps may differ
  if (guarded) guard.emplace(scene, std::numeric_limits<Real>::epsilon() / margin);
  KeepStates<Real, Space> keep(stretch.looks.steps, simulation.generator, guard, outcome);
  auto const method = open_method(scene, plan, &simulation);
  auto const ending = simulation.advance(*method, keep);
  outcome.summary = ending.summary;
  if (ending.failure) outcome.failure = ending.failure;
  return outcome;
}

}  // namespace

double distance(std::vector<double> const& a, std::vector<double> const& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); i += 3)
    largest = std::max(largest, std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  return largest;
}

double distance(Outcome const& a, Outcome const& b) {
  if (a.failure || b.failure || a.states.size() != b.states.size()) return infinite;
  double largest = 0;
  for (std::size_t look = 0; look < a.states.size(); ++look)
    largest = std::max(largest, distance(a.states[look], b.states[look]));
  return largest;
}

Pilot::Pilot(io::Scene scene, std::string space, double error)
    : scene_(std::move(scene)),
      space_(std::move(space)),
      error_(error),
      features_(features_of(scene_, error)),
      available_(io::available_memory()) {
  if (!(end() > 0))
    throw io::scene_error(scene_, "integrator.steps",
                          "a scene without steps has no errors; accepted: at least one step");
  if (is_thermal(scene_))
    throw io::scene_error(scene_, "thermal.temperature",
                          "trajectories at a temperature are random: there is nothing to compare; "
                          "accepted: temperature = 0");
  if (auto const needed = bytes(fine_tsit5()); needed > available_)
    throw io::scene_error(scene_, "lattice.shape",
                          fmt::format("trying methods needs {} of memory, and {} is available; "
                                      "accepted: a smaller lattice",
                                      bytes_text(needed), bytes_text(available_)));
  start_ = io::initial_spins(scene_);
}

double Pilot::end() const {
  return static_cast<double>(scene_.integrator.steps) * scene_.integrator.dt;
}

double Pilot::longest_step() const {
  double const most = scene_.integrator.max_dt;
  return features_->shortest ? std::min(most, features_->shortest->length) : most;
}

bool Pilot::is_representative(double horizon) const {
  if (horizon >= end() || !io::depends_on_time(scene_.field)) return true;
  auto part_of_scene = scene_;
  part_of_scene.integrator.dt *= horizon / end();
  auto const part = features_of(part_of_scene, error_);
  auto const shortest_bound = [](TimeFeatures const& features) {
    double least = infinite;
    for (auto const& bound : features.bounds)
      if (bound.max_dt > 0) least = std::min(least, bound.max_dt);
    return least;
  };
  constexpr double alike = 0.9;
  for (std::size_t i = 0; i < part->largest.size(); ++i)
    if (part->largest[i].second < alike * features_->largest[i].second) return false;
  return part->jumps == features_->jumps && shortest_bound(*part) <= 2 * shortest_bound(*features_);
}

std::int64_t Pilot::bytes(Candidate const& candidate) const {
  auto const steps = candidate.method->adaptive ? Steps{0, 0.1} : Steps{4, 0};
  // Two fine solutions, a trial and the start are in memory at once.
  auto const states = 3 * std::ssize(times_of_looks(*features_, end())) + 4;
  return plan(candidate, end(), steps).memory.simulation() + states * 24 * io::sites(scene_);
}

bool Pilot::fits(Candidate const& candidate) const { return bytes(candidate) <= available_; }

Plan Pilot::plan(Candidate const& candidate, double horizon, Steps const& steps) const {
  return make_plan(with(scene_, candidate, horizon, 1, steps), candidate.precision, features_);
}

Outcome Pilot::run(Candidate const& candidate, double horizon, Steps const& steps,
                   Repeats const& repeats) const {
  std::int64_t const last = candidate.method->adaptive ? 1 : steps.count;
  return run(candidate, {0, horizon, start_, {1, {last}}}, steps, repeats);
}

Outcome Pilot::run(Candidate const& candidate, Stretch const& stretch, Steps const& steps,
                   Repeats const& repeats) const {
  auto const scene = with(scene_, candidate, stretch.length, stretch.looks.intervals, steps);
  // Plans without the sigma, because the stable dt with a sigma takes long to compute, and no run
  // here needs it.
  auto planned = scene;
  if (candidate.isotropy == io::Isotropy::constant)
    planned.integrator.isotropy = io::Isotropy::zero;
  planned.integrator.sigma = 0;
  auto plan = make_plan(planned, candidate.precision, features_);
  plan.options.sigma = candidate.sigma;
  plan.times.begin = stretch.begin;
  if (candidate.method->adaptive) plan.options.steps.end = plan.times.at(plan.times.steps);
  constexpr int most = 100;
  constexpr double long_enough = 0.3;
  Kokkos::Timer const clock;
  Outcome best;
  for (int i = 0; i < repeats.least || (i < most && clock.seconds() < repeats.seconds); ++i) {
    auto outcome = in_space(space_, candidate.precision, [&]<class Real, class Space>() {
      return run_on<Real, Space>(scene, plan, stretch, stretch.guarded && i == 0);
    });
    if (i == 0 || outcome.seconds() < best.seconds()) std::swap(best, outcome);
    if (best.failure || best.seconds() > long_enough) break;
  }
  return best;
}

}  // namespace cayspin::program::trade
