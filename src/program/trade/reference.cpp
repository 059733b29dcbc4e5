// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "reference.hpp"

#include "simulation/failure.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cayspin::program::trade {
namespace {

constexpr double enough = 1e-10;
constexpr double tightest = 1e-13;
constexpr int most_halvings = 20;
constexpr int most_fewer = 4;   // by which the number of halvings falls from one run to the next
constexpr int most_short = 10;  // a run of at most this many steps is never too long

// Returns a method that computes the reference.
Candidate by(char const* method) { return {{.method = io::find_method(method)}}; }

Looks looks_of(Candidate const& candidate, Steps const& steps,
               std::vector<std::int64_t> const& times) {
  bool const adaptive = candidate.method->adaptive;
  std::int64_t const count = adaptive ? FineSolution::parts : steps.count;
  Looks looks{adaptive ? count : 1, {1}};
  for (auto const time : times) {
    auto const whole = time * (count / FineSolution::parts);
    auto const rest = time * (count % FineSolution::parts);
    auto const step = whole + (rest + FineSolution::parts - 1) / FineSolution::parts;
    if (step > looks.steps.back()) looks.steps.push_back(step);
  }
  return looks;
}

}  // namespace

std::vector<std::int64_t> times_of_looks(TimeFeatures const& features, double horizon) {
  constexpr std::size_t most_events = 16;
  constexpr auto parts = FineSolution::parts;
  std::vector<double> events;
  for (auto const& bound : features.bounds)
    if (bound.max_dt == 0) events.push_back(bound.end);
  if (auto const& shortest = features.shortest) events.push_back(shortest->time + shortest->length);
  std::erase_if(events, [&](double t) { return t >= horizon; });
  std::vector<std::int64_t> times{1, 4, 16, 64, 128, 256, 384, 512, 640, 768, 896, parts};
  auto const stride = (events.size() + most_events - 1) / most_events;
  for (std::size_t i = 0; i < events.size(); i += stride)
    times.push_back(static_cast<std::int64_t>(std::ceil(events[i] / horizon * parts)));
  std::erase_if(times, [](std::int64_t time) { return time < 1 || time > parts; });
  std::ranges::sort(times);
  times.erase(std::ranges::unique(times).begin(), times.end());
  return times;
}

FineSolution::FineSolution(Pilot const& pilot, double horizon, Candidate const& by,
                           double tolerance)
    : pilot_(&pilot),
      by_(by),
      horizon_(horizon),
      tolerance_(tolerance),
      times_(times_of_looks(pilot.features(), horizon)) {
  Steps const steps{0, tolerance};
  solution_ = pilot.run(by, {0, horizon, pilot.start(), looks_of(by, steps, times_)}, steps);
}

void FineSolution::continue_by(Candidate const& method, double error) {
  constexpr std::int64_t fewest = 64, most = 8 * parts;
  for (auto count = fewest; count <= most; count *= 2) {
    Looks looks{1, {}};
    std::vector<std::size_t> compared;
    for (std::size_t i = 0; i < times_.size(); ++i) {
      if (times_[i] * count % parts != 0) continue;
      looks.steps.push_back(times_[i] * count / parts);
      compared.push_back(i);
    }
    auto const outcome =
        pilot_->run(method, {0, horizon_, pilot_->start(), std::move(looks)}, {count, 0});
    double largest = outcome.failure ? infinite : 0;
    for (std::size_t i = 0; i < outcome.states.size(); ++i)
      largest = std::max(largest, distance(outcome.states[i], solution_.states[compared[i]]));
    if (largest > error) continue;
    by_ = method;
    equal_steps_ = count;
    return;
  }
}

Try FineSolution::measure(Candidate const& candidate, Steps const& steps, bool guarded,
                          Repeats const& repeats) const {
  bool const adaptive = candidate.method->adaptive;
  auto const looks = looks_of(candidate, steps, times_);
  Stretch const stretch{0, horizon_, pilot_->start(), looks, guarded};
  auto const outcome = pilot_->run(candidate, stretch, steps, adaptive ? Repeats{} : repeats);
  Try measured{steps, infinite, outcome.seconds(), outcome.summary.evaluations};
  if (outcome.failure) return measured;
  measured.error = 0;
  for (std::size_t i = 0; i < looks.steps.size(); ++i)
    measured.error =
        std::max(measured.error,
                 distance(outcome.states[i], at(looks.steps[i], adaptive ? parts : steps.count)));
  // Storing many states takes time, on large lattices most of the time of an adaptive run, which is
  // therefore timed separately.
  if (adaptive) measured.seconds = pilot_->run(candidate, horizon_, steps, repeats).seconds();
  return measured;
}

// Returns the state after `step` of `steps` steps to the horizon: the stored one, or one continued
// from the last stored time before it.
std::vector<double> FineSolution::at(std::int64_t step, std::int64_t steps) const {
  auto const of = [&](std::int64_t time) {
    return static_cast<double>(time) / static_cast<double>(parts);
  };
  double const share = static_cast<double>(step) / static_cast<double>(steps);
  auto const after = std::ranges::upper_bound(times_, share, {}, of);
  bool const first = after == times_.begin();
  auto const last = static_cast<std::size_t>(after - times_.begin()) - 1;
  auto const& state = first ? pilot_->start() : solution_.states[last];
  double const begin = first ? 0 : of(times_[last]);
  if (share == begin) return state;
  Steps const continued{
      static_cast<std::int64_t>(std::ceil((share - begin) * static_cast<double>(equal_steps_))),
      equal_steps_ > 0 ? 0 : tolerance_};
  Looks const end{1, {std::max<std::int64_t>(1, continued.count)}};
  Stretch const rest{begin * horizon_, (share - begin) * horizon_, state, end};
  auto const outcome = pilot_->run(by_, rest, continued);
  if (outcome.failure) return std::vector(state.size(), infinite);
  return outcome.states.front();
}

void Horizon::halve(std::string why) {
  time /= 2;
  own_steps /= 2;
  seconds /= 2;
  why_shorter = std::move(why);
}

Candidate fine_tsit5() {
  auto candidate = by("tsit5");
  candidate.generator = io::Generator::tangent;
  return candidate;
}

Horizon horizon_within(Pilot const& pilot, double seconds) {
  Horizon longest;
  // Starts with a short horizon and increases it, so that nothing runs much longer than allowed.
  for (int halvings = most_halvings;;) {
    double const time = std::ldexp(pilot.end(), -halvings);
    auto const tried = pilot.run(fine_tsit5(), time, {0, 1e-2});
    if (tried.failure)
      throw NumbersFailed(fmt::format("{}: {}", pilot.scene().path.string(), *tried.failure));
    auto const own_steps = tried.summary.own_steps;
    bool const too_long = tried.seconds() > seconds && own_steps > most_short;
    if (!too_long || halvings == most_halvings) longest = {time, own_steps, tried.seconds()};
    if (too_long) {
      longest.why_shorter = fmt::format("a coarse run to the end takes {:.2g} s",
                                        std::ldexp(tried.seconds(), halvings));
      break;
    }
    if (halvings == 0) break;
    double const longer = std::log2(seconds / std::max(tried.seconds(), 1e-9));
    int const fewer = own_steps < 3 ? most_fewer : static_cast<int>(longer) / 2;
    halvings -= std::clamp(fewer, 1, std::min(halvings, most_fewer));
  }
  return longest;
}

Reference converged_reference(Pilot const& pilot, double seconds) {
  auto horizon = horizon_within(pilot, seconds / 10);
  for (int halving = 0; halving < most_halvings; ++halving) {
    FineSolution first(pilot, horizon.time, by("tsit5"), tightest);
    double const uncertainty =
        first.distance_to(FineSolution(pilot, horizon.time, by("dp5"), tightest));
    if (uncertainty < enough) {
      first.continue_by(by("rkmk8"), enough);
      horizon.own_steps = pilot.run(fine_tsit5(), horizon.time, {0, 1e-2}).summary.own_steps;
      return {horizon, std::move(first), uncertainty};
    }
    horizon.halve(fmt::format("two methods at a tolerance of {:g} differ by {:.1e} at t = {}",
                              tightest, uncertainty,
                              time_text(pilot.scene().units, horizon.time, 6)));
  }
  throw NumbersFailed(fmt::format("{}: there is no reference solution: {}",
                                  pilot.scene().path.string(), horizon.why_shorter));
}

}  // namespace cayspin::program::trade
