// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ladder.hpp"

#include <algorithm>
#include <cmath>

namespace cayspin::program::trade {
namespace {

constexpr double finer_by = 1.5;  // ratio of the numbers of steps of successive rungs

// Rounds up to a whole number of steps, at least four, so that there is some motion to observe.
std::int64_t whole(double steps) {
  return static_cast<std::int64_t>(std::max<double>(4, std::ceil(steps)));
}

double amount(Rung const& rung, bool of_evaluations) {
  return of_evaluations ? static_cast<double>(rung.evaluations) : rung.seconds;
}

// Returns the cost of reaching an error that this rung meets. That is the rung's own cost or, if
// the previous rung misses the error, a lower cost interpolated logarithmically between the two.
double interpolated(Rung const* before, Rung const& rung, double error, bool of_evaluations) {
  double const last = amount(rung, of_evaluations);
  if (!before || !(before->error > error) || !(rung.error > 0)) return last;
  double const share = std::log(before->error / error) / std::log(before->error / rung.error);
  double const first = amount(*before, of_evaluations);
  return std::min(last, first * std::pow(last / first, share));
}

double least(Ladder const& ladder, double error, bool of_evaluations, Ladder* around = nullptr) {
  double best = infinite;
  Rung const* before = nullptr;
  for (auto const& rung : ladder.rungs) {
    double const now =
        rung.error > error ? best : interpolated(before, rung, error, of_evaluations);
    if (now < best) {
      best = now;
      if (around) around->rungs = before ? std::vector{*before, rung} : std::vector{rung};
    }
    before = &rung;
  }
  return best;
}

}  // namespace

Steps coarsest_steps(Pilot const& pilot, Candidate const& candidate, double horizon,
                     std::int64_t own_steps) {
  if (candidate.method->adaptive) return {0, 0.1};
  // Takes fewer steps than an explicit adaptive method at a coarse tolerance, but enough to be
  // stable.
  auto const parts = static_cast<double>(4 * std::max<std::int64_t>(1, candidate.substeps));
  double const few = candidate.method->stiff ? 0 : static_cast<double>(own_steps) / parts;
  auto plain = candidate;
  plain.isotropy = io::Isotropy::zero;
  plain.sigma = 0;  // slow growth due to sigma is no reason to start with finer steps
  auto const plan = pilot.plan(plain, horizon, {4, 0});
  double const stable =
      plan.stable_dt > 0 && std::isfinite(plan.stable_dt) ? horizon / plan.stable_dt : 0;
  // An explicit method without a known limit, such as ab2, may become unstable only after a horizon
  // if the scene is damped and its steps turn spins far.
  auto const& system = pilot.scene().system;
  bool const is_damped = system.damping != 0 || system.dampings.there();
  bool const may_grow = is_damped && !candidate.method->stiff && !std::isfinite(plan.stable_dt) &&
                        plan.variant.evaluations;
  constexpr double most_turn = 2;  // of a spin in a step, as dt_warning has it
  double const followed = may_grow ? 4 * plan.turn / most_turn : 0;
  return {whole(std::max({few, stable, followed, horizon / pilot.longest_step()})), 0};
}

Steps finer(Candidate const& candidate, Steps const& steps) {
  if (candidate.method->adaptive) return {0, steps.tolerance / std::sqrt(10.0)};
  return {whole(finer_by * static_cast<double>(steps.count)), 0};
}

Ladder climb(Pilot const& pilot, Candidate const& candidate, Reference const& reference,
             std::vector<Ladder> const& others, LadderLimits const& limits) {
  Ladder ladder{candidate, {}};
  int worse = 0;
  double best = infinite;
  Steps steps =
      coarsest_steps(pilot, candidate, reference.horizon.time, reference.horizon.own_steps);
  for (int i = 0; i < limits.rungs; ++i, steps = finer(candidate, steps)) {
    if (candidate.method->adaptive && steps.tolerance < candidate.least_tolerance()) break;
    if (limits.progress) limits.progress->show(limits.share, candidate.name());
    auto const run = reference.solution.measure(candidate, steps, false, measured_well);
    double const dt =
        candidate.method->adaptive ? 0 : reference.horizon.time / static_cast<double>(steps.count);
    double const error = run.error;
    if (std::isfinite(error)) ladder.rungs.push_back({run, dt});
    worse = error < 0.9 * best ? 0 : worse + 1;
    best = std::min(best, error);
    double most = infinite;
    for (auto const& other : others)
      most = std::min(most, limits.far_behind * seconds_to(other, error));
    // The error is small enough, the run takes too long, or finer steps no longer reduce the error.
    if (error < limits.least_error || run.seconds > std::min(limits.seconds, most) ||
        (worse > 2 && best < 1e-3) || worse > 12)
      break;
  }
  return ladder;
}

void mark_front(std::vector<Ladder>& ladders) {
  for (auto& ladder : ladders)
    for (auto& rung : ladder.rungs)
      rung.on_front = std::ranges::none_of(ladders, [&](Ladder const& other) {
        return std::ranges::any_of(other.rungs, [&](Rung const& it) {
          return it.error <= rung.error && it.seconds < rung.seconds;
        });
      });
}

double seconds_to(Ladder const& ladder, double error) { return least(ladder, error, false); }

double evaluations_to(Ladder const& ladder, double error) { return least(ladder, error, true); }

Ladder around(Ladder const& ladder, double error) {
  Ladder some{ladder.candidate, {}};
  least(ladder, error, false, &some);
  return some;
}

}  // namespace cayspin::program::trade
