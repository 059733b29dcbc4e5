// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "advice.hpp"

#include "fine_solution.hpp"
#include "simulation/dear_method.hpp"
#include "simulation/failure.hpp"
#include "simulation/text.hpp"

#include <Kokkos_Timer.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cayspin::program::trade {
namespace {

constexpr double aim = 0.85;      // of the error asked for
constexpr double seconds = 5;     // that a coarse run of the scene may take
constexpr double near = 4;        // error over error asked for, from where to predict
constexpr double far = 30;        // the same, where the order is as expected
constexpr double most_finer = 4;  // cost over that of the try before
constexpr int tries = 12;         // of one candidate
constexpr int all_tries = 200;
constexpr int all_finer = 30;  // beyond the coarsest steps, where those are refused
constexpr int horizons = 20;   // tried, each half of the one before

// Of the time of a search, roughly.
constexpr double share_of_coarsest = 0.3;
constexpr double share_of_judging = 0.4;

struct Try {
  Steps steps;
  double seconds;
  double error;  // estimated
};

/// What is known of a candidate. Resolution: its number of steps, or 1 / tolerance.
struct Prospect {
  Candidate candidate;
  double order;       // of the error in the resolution
  double cost_order;  // of the cost
  std::vector<Try> tried;
  Steps coarsest, next;
  int attempts = 0;
  bool dropped = false;

  double resolution(Steps const& steps) const {
    return candidate.method->adaptive ? 1 / steps.tolerance : static_cast<double>(steps.count);
  }
  Steps steps_of(double resolution) const {
    if (candidate.method->adaptive) return {0, std::min(1 / resolution, coarsest.tolerance)};
    auto const per_look = std::ceil(resolution / Pilot::looks - 1e-9);
    return {std::max(static_cast<std::int64_t>(per_look) * Pilot::looks, coarsest.count), 0};
  }

  bool can_take(Steps const& steps) const {
    return !candidate.method->adaptive || steps.tolerance >= candidate.least_tolerance();
  }
  Try const& last() const { return tried.back(); }
  /// Of the coarsest steps that ran.
  double least_seconds() const {
    return tried.empty() ? std::numeric_limits<double>::infinity() : tried.front().seconds;
  }
  bool is_judged() const { return tried.size() > 1; }
  /// From the last two tries; the method's own where they do not say.
  double seen_order() const {
    auto const &a = tried[tried.size() - 2], &b = tried.back();
    double const seen =
        std::log(a.error / b.error) / std::log(resolution(b.steps) / resolution(a.steps));
    return std::isfinite(seen) ? seen : order;
  }
  Steps needed(double error) const {
    double const most = last().error < near * error ? order + 1 : order;
    return needed(error, std::clamp(seen_order(), 0.5 * order, most));
  }
  Steps needed(double error, double order_used) const {
    double const resolved = resolution(last().steps);
    double const by_order = resolved * std::pow(last().error / error, 1 / order_used);
    return steps_of(std::max(by_order, finer_than_failures(error)));
  }
  /// Tries that fell short bound it, wherever the order leads: where steps become unstable, errors
  /// fall all at once.
  double finer_than_failures(double error) const {
    for (auto i = tried.size() - 1; i > 0; --i) {
      auto const &coarse = tried[i - 1], &fine = tried[i];
      if (coarse.error <= error || fine.error > error) continue;
      double const from = resolution(coarse.steps), to = resolution(fine.steps);
      double const slope = std::log(coarse.error / fine.error) / std::log(to / from);
      return slope > order + 1 ? to : from * std::pow(coarse.error / error, 1 / slope);
    }
    return 0;
  }
  double seconds_of(Steps const& steps) const {
    for (auto const& one : tried)
      if (resolution(one.steps) == resolution(steps)) return one.seconds;
    return last().seconds * std::pow(resolution(steps) / resolution(last().steps), cost_order);
  }
  /// Is it near enough to predict the rest?
  bool is_settled(double error) const {
    double const off = std::abs(seen_order() - order);
    return last().error < near * error || (last().error < far * error && off < 0.3 * order);
  }
};

class Search {
 public:
  Search(Pilot const& pilot, Reference const& horizon, FineSolution const& fine,
         AdviceRequest const& request)
      : pilot_(pilot),
        horizon_(horizon),
        fine_(fine),
        error_(aim * request.error),
        on_try_(request.on_try) {
    double const error = request.error;
    for (auto const& candidate : candidates(pilot.scene(), request.precision))
      if (candidate.least_error() < error) add(candidate);
  }

  /// Best first, until the cheapest one is near enough.
  void run() {
    double const count = static_cast<double>(prospects_.size());
    for (auto& prospect : prospects_) {
      while (!prospect.dropped && prospect.tried.empty()) attempt(prospect);
      share_ += share_of_coarsest / count;
    }
    std::ranges::stable_sort(prospects_, {}, &Prospect::least_seconds);
    for (auto& prospect : prospects_) {
      auto const* best = cheapest();
      if (best && best->is_settled(error_) &&
          best->seconds_of(best->needed(error_)) < prospect.least_seconds())
        break;  // nothing that follows takes less
      while (!prospect.dropped && !prospect.is_judged()) attempt(prospect);
      share_ += share_of_judging / count;
    }
    share_ = share_of_coarsest + share_of_judging;
    std::erase_if(prospects_, [](Prospect const& one) { return !one.is_judged(); });
    for (int i = 0; i < all_tries; ++i) {
      auto* best = cheapest();
      if (best && best->is_settled(error_)) best = hope_against(*best);
      if (!best) return;
      attempt(*best);
    }
  }

  std::vector<Advice> all_advice() const {
    std::vector<Advice> all;
    for (auto const& prospect : prospects_) {
      if (prospect.dropped) continue;
      auto const steps = prospect.needed(error_);
      if (!prospect.can_take(steps)) continue;
      Advice advice{prospect.candidate, steps, 0, error_, prospect.seconds_of(steps), 0};
      double const parts = pilot_.end() / horizon_.horizon;
      advice.seconds *= parts;
      if (!prospect.candidate.method->adaptive) {
        advice.steps.count =
            static_cast<std::int64_t>(std::ceil(static_cast<double>(steps.count) * parts));
        advice.dt = pilot_.end() / static_cast<double>(advice.steps.count);
      }
      advice.memory = pilot_.plan(prospect.candidate, horizon_.horizon, steps).memory.total();
      all.push_back(advice);
    }
    std::ranges::sort(all, {}, &Advice::seconds);
    return all;
  }

 private:
  void add(Candidate const& candidate) {
    auto coarsest = coarsest_steps(pilot_, candidate, horizon_.horizon, horizon_.own_steps);
    for (int i = 0; is_refused(candidate, coarsest); ++i) {
      if (i == all_finer) return;
      coarsest = finer(candidate, coarsest);
    }
    auto const& variant = pilot_.plan(candidate, horizon_.horizon, coarsest).variant;
    double const order = candidate.substeps > 0 ? order_around_dear(variant) : variant.order;
    bool const adaptive = candidate.method->adaptive;
    // An adaptive method's error is not far from its tolerance, and its cost depends little on it.
    Steps const first = adaptive ? Steps{0, std::min(coarsest.tolerance, 30 * error_)} : coarsest;
    prospects_.push_back(
        {candidate, adaptive ? 1 : order, adaptive ? 1 / order : 1, {}, coarsest, first});
  }

  bool is_refused(Candidate const& candidate, Steps const& steps) const {
    return pilot_.scene().integrator.refuse_unstable &&
           dt_warning(pilot_.plan(candidate, horizon_.horizon, steps));
  }

  Prospect* cheapest() {
    Prospect* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (auto& prospect : prospects_) {
      if (prospect.dropped || !prospect.is_judged() || !prospect.can_take(prospect.needed(error_)))
        continue;
      double const now = prospect.seconds_of(prospect.needed(error_));
      if (now < least) {
        least = now;
        best = &prospect;
      }
    }
    return best;
  }

  // One that would be cheaper by a fifth, should its error fall as its order says.
  Prospect* hope_against(Prospect const& best) {
    Prospect* hope = nullptr;
    double least = 0.8 * best.seconds_of(best.needed(error_));
    for (auto& prospect : prospects_) {
      if (prospect.dropped || prospect.is_settled(error_)) continue;
      double const seconds = prospect.seconds_of(prospect.needed(error_, prospect.order));
      if (seconds < least) {
        least = seconds;
        hope = &prospect;
      }
    }
    return hope;
  }

  void attempt(Prospect& prospect) {
    auto const steps = prospect.next;
    if (on_try_) on_try_(share_, prospect.candidate.name());
    auto const& candidate = prospect.candidate;
    auto const outcome = pilot_.run(candidate, fine_.stretch(candidate, steps), steps,
                                    candidate.method->adaptive ? 1 : 3);
    ++prospect.attempts;
    double const now = prospect.resolution(steps);
    if (outcome.failure) {
      prospect.coarsest = prospect.next = prospect.steps_of(1.5 * now);
    } else {
      // The many looks at an adaptive run take time of their own.
      double const taken = candidate.method->adaptive
                               ? pilot_.run(candidate, horizon_.horizon, steps, 3).seconds()
                               : outcome.seconds();
      prospect.tried.push_back({steps, taken, fine_.distance_of(outcome, candidate, steps)});
      judge(prospect);
      auto const at_cost = [&](double factor) {
        return now * std::pow(factor, 1 / prospect.cost_order);
      };
      double goal = at_cost(1.5);
      if (prospect.is_judged())
        goal = std::clamp(prospect.resolution(prospect.needed(2 * error_)), at_cost(1.3),
                          at_cost(most_finer));
      prospect.next = prospect.steps_of(goal);
    }
    prospect.dropped = prospect.attempts >= tries || !prospect.can_take(prospect.next) ||
                       (prospect.is_judged() && is_round_off(prospect));
  }

  // Finer steps that change the result by no less.
  bool is_round_off(Prospect const& prospect) const {
    return prospect.tried.size() > 2 && prospect.last().error > error_ &&
           prospect.last().error < 100 * prospect.candidate.least_tolerance() &&
           prospect.seen_order() < 0.2 * prospect.order;
  }

  // The fine solution tells the error of the last try, up to its own. Below that, the order does.
  void judge(Prospect& prospect) {
    auto& tried = prospect.tried;
    auto& now = tried.back();
    double const unknown = fine_.error();
    if (tried.size() > 1 && now.error < 5 * unknown) {
      auto const& before = tried[tried.size() - 2];
      double const ratio = std::pow(
          prospect.resolution(now.steps) / prospect.resolution(before.steps), -prospect.order);
      now.error = std::clamp(before.error * ratio, now.error - unknown, now.error + unknown);
    }
    now.error = std::max(now.error, 1e-16);
  }

  Pilot const& pilot_;
  Reference const& horizon_;
  FineSolution const& fine_;
  double error_;
  OnTry on_try_;
  double share_ = 0;  // of the search that is done, roughly
  std::vector<Prospect> prospects_;
};

// Up to the horizon, which is halved until there is one.
FineSolution fine_solution(Pilot const& pilot, Reference& horizon, double error) {
  for (int i = 0; i < horizons; ++i) {
    FineSolution fine(pilot, horizon.horizon, error);
    if (fine.error() < error / 5) return fine;
    horizon.why_shorter = fine.failure().value_or(
        fmt::format("two runs of tsit5 differ by {:.1e} at t = {}", 9 * fine.error(),
                    time_text(pilot.scene().units, horizon.horizon, 6)));
    horizon.horizon /= 2;
    horizon.own_steps /= 2;
  }
  throw NumbersFailed("there is no solution to compare with: " + horizon.why_shorter);
}

}  // namespace

Advised advise(Pilot const& pilot, AdviceRequest const& request) {
  Kokkos::Timer const clock;
  auto horizon = horizon_alone(pilot, seconds);
  auto const fine = fine_solution(pilot, horizon, request.error);
  Search search(pilot, horizon, fine, request);
  search.run();
  Advised advised;
  advised.others = search.all_advice();
  advised.horizon = horizon.horizon;
  advised.why_shorter = horizon.why_shorter;
  if (!advised.others.empty() &&
      !(request.budget && advised.others.front().seconds > *request.budget))
    advised.choice = advised.others.front();
  advised.seconds = clock.seconds();
  return advised;
}

}  // namespace cayspin::program::trade
