// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "fine_solution.hpp"

#include <algorithm>
#include <cmath>

namespace cayspin::program::trade {
namespace {

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

FineSolution::FineSolution(Pilot const& pilot, double horizon, Candidate const& by,
                           double tolerance)
    : pilot_(&pilot), by_(by), horizon_(horizon), tolerance_(tolerance) {
  Steps const steps{0, tolerance};
  solution_ = pilot.run(by, {0, horizon, pilot.start(), looks_of(by, steps)}, steps);
}

void FineSolution::continue_by(Candidate const& method, double error) {
  constexpr std::int64_t fewest = 64, most = 8 * parts;
  for (auto count = fewest; count <= most; count *= 2) {
    Looks looks{1, {}};
    std::vector<std::size_t> compared;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] * count % parts != 0) continue;
      looks.steps.push_back(times[i] * count / parts);
      compared.push_back(i);
    }
    auto const outcome =
        pilot_->run(method, {0, horizon_, pilot_->start(), std::move(looks)}, {count, 0});
    double largest = outcome.failure ? std::numeric_limits<double>::infinity() : 0;
    for (std::size_t i = 0; i < outcome.states.size(); ++i)
      largest = std::max(largest, distance(outcome.states[i], solution_.states[compared[i]]));
    if (largest > error) continue;
    by_ = method;
    equal_steps_ = count;
    return;
  }
}

Measured FineSolution::measure(Candidate const& candidate, Steps const& steps, bool guarded,
                               Repeats const& repeats) const {
  bool const adaptive = candidate.method->adaptive;
  auto const looks = looks_of(candidate, steps);
  Stretch const stretch{0, horizon_, pilot_->start(), looks, guarded};
  auto const outcome = pilot_->run(candidate, stretch, steps, adaptive ? Repeats{} : repeats);
  Measured measured{outcome.failure, std::numeric_limits<double>::infinity(), outcome.seconds(),
                    outcome.summary.evaluations};
  if (outcome.failure) return measured;
  measured.error = 0;
  for (std::size_t i = 0; i < looks.steps.size(); ++i)
    measured.error =
        std::max(measured.error,
                 distance(outcome.states[i], at(looks.steps[i], adaptive ? parts : steps.count)));
  // The many looks at an adaptive run take time of their own.
  constexpr double long_enough = 0.3;
  if (adaptive && measured.seconds < long_enough)
    measured.seconds = pilot_->run(candidate, horizon_, steps, repeats).seconds();
  return measured;
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
  auto const& state = first ? pilot_->start() : solution_.states[last];
  double const begin = first ? 0 : of(times[last]);
  if (share == begin) return state;
  Steps const continued{
      static_cast<std::int64_t>(std::ceil((share - begin) * static_cast<double>(equal_steps_))),
      equal_steps_ > 0 ? 0 : tolerance_};
  Looks const end{1, {std::max<std::int64_t>(1, continued.count)}};
  Stretch const rest{begin * horizon_, (share - begin) * horizon_, state, end};
  auto const outcome = pilot_->run(by_, rest, continued);
  if (outcome.failure) return std::vector(state.size(), std::numeric_limits<double>::infinity());
  return outcome.states.front();
}

}  // namespace cayspin::program::trade
