// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "fine_solution.hpp"

#include <algorithm>
#include <limits>

namespace cayspin::program::trade {
namespace {

// Its error follows its tolerance.
Candidate tsit5() {
  return {{.method = io::find_method("tsit5"), .generator = io::Generator::tangent}};
}

Looks looks_of(Candidate const& candidate, Steps const& steps) {
  bool const adaptive = candidate.method->adaptive;
  std::int64_t const count = adaptive ? FineSolution::parts : steps.count;
  Looks looks{adaptive ? count : 1, {1}};
  for (auto const time : FineSolution::times) {
    auto const whole = time * (count / FineSolution::parts);
    auto const rest = time * (count % FineSolution::parts);
    auto const step = whole + (rest + FineSolution::parts - 1) / FineSolution::parts;
    if (step > looks.steps.back()) looks.steps.push_back(step);
  }
  return looks;
}

}  // namespace

FineSolution::FineSolution(Pilot const& pilot, double horizon, double error)
    : pilot_(pilot), horizon_(horizon), error_(std::numeric_limits<double>::infinity()) {
  auto const by = tsit5();
  double const least = by.least_tolerance();
  auto const run = [&](double tolerance) {
    tolerance_ = tolerance;
    auto stretch = this->stretch(by, {0, tolerance});
    stretch.guarded = false;
    return pilot.run(by, stretch, {0, tolerance});
  };
  auto coarser = run(std::max(error / 10, 10 * least));
  do {
    solution_ = run(tolerance_ / 10);
    error_ = distance(coarser, solution_) / 9;
    coarser = solution_;
  } while (!solution_.failure && error_ > error / 30 && tolerance_ >= 10 * least);
}

Stretch FineSolution::stretch(Candidate const& candidate, Steps const& steps) const {
  return {0, horizon_, pilot_.start(), looks_of(candidate, steps), true};
}

double FineSolution::distance_of(Outcome const& outcome, Candidate const& candidate,
                                 Steps const& steps) const {
  auto const looks = looks_of(candidate, steps);
  if (outcome.failure || outcome.states.size() != looks.steps.size())
    return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t i = 0; i < looks.steps.size(); ++i)
    largest = std::max(
        largest, distance(outcome.states[i],
                          at(looks.steps[i], candidate.method->adaptive ? parts : steps.count)));
  return largest;
}

// From the last of its times before that step on.
std::vector<double> FineSolution::at(std::int64_t step, std::int64_t steps) const {
  auto const of = [&](std::int64_t time) {
    return static_cast<double>(time) / static_cast<double>(parts);
  };
  double const share = static_cast<double>(step) / static_cast<double>(steps);
  auto const after = std::ranges::upper_bound(times, share, {}, of);
  bool const first = after == times.begin();
  auto const last = static_cast<std::size_t>(after - times.begin()) - 1;
  auto const& state = first ? pilot_.start() : solution_.states[last];
  double const begin = first ? 0 : of(times[last]);
  if (share == begin) return state;
  auto const by = tsit5();
  auto const rest = pilot_.run(
      by, {begin * horizon_, (share - begin) * horizon_, state, {1, {1}}, false}, {0, tolerance_});
  if (rest.failure) return std::vector(state.size(), std::numeric_limits<double>::infinity());
  return rest.states.front();
}

}  // namespace cayspin::program::trade
