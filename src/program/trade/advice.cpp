// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "advice.hpp"

#include "prospect.hpp"
#include "resolved.hpp"
#include "simulation/failure.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/text.hpp"

#include <Kokkos_Timer.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cayspin::program::trade {
namespace {

// The time limit of a search: this fraction of the duration of the run, but at least this many
// seconds.
constexpr double most_share = 0.1, least_limit = 2;
// Approximate fractions of that limit: the time for a coarse run, the time for the fine solution,
// and the times at which the first trials and all trials end.
constexpr double coarse_share = 1.0 / 40, fine_share = 0.4, first_share = 0.65, try_share = 0.9;

constexpr double accepted = 0.95;  // limit of (error + uncertainty) / requested error
constexpr double aim = 0.9;  // fraction of the accepted error that predicted steps should have
// Candidates with more than this many times the fewest expected evaluations are tried last.
constexpr double unlikely = 16;
constexpr double hope = 0.8;  // smallest ratio of an actual time to its prediction
constexpr double doubt = 6;   // ratio of a time to the best one; a larger ratio is not due to noise
constexpr double contender = 1.7;  // candidates within this ratio of the best time are timed again
constexpr int rounds = 3;          // number of rounds of repeated timing
constexpr int tries = 12;          // largest number of trials of a candidate
constexpr int all_finer = 30;      // largest number of times that refused steps are made finer
constexpr int refinements = 4;     // most trials of advised steps; failing ones are shortened
constexpr int horizons = 20;       // number of horizons to try, each half of the previous one

constexpr Repeats quick{1, 2e-3};

/// Returns the number of steps of a run with the advised dt, which frames and samples may increase.
double whole_steps(Pilot const& pilot, Advice const& advice) {
  return static_cast<double>(resolve(pilot.scene(), advice).steps);
}

/// A fine solution and its estimated error.
struct Known {
  FineSolution solution;
  double error;  // estimated from a solution at ten times the tolerance
};

class Search {
 public:
  Search(Pilot const& pilot, Horizon const& horizon, Known const& fine,
         AdviceRequest const& request, Kokkos::Timer const& clock, double limit)
      : pilot_(pilot),
        horizon_(horizon),
        fine_(fine),
        request_(request),
        clock_(clock),
        limit_(limit),
        is_representative_(pilot.is_representative(horizon.time)),
        error_(accepted * request.error - fine.error),
        goal_(aim * error_) {
    for (auto const& candidate : candidates(pilot.scene(), request.precision, request.in_parts))
      if (candidate.least_error() < request.error) add(candidate);
    std::ranges::stable_sort(prospects_, {}, &Prospect::expected_evaluations);
  }

  /// Tries each likely candidate once, then repeatedly the one predicted to be the cheapest, until
  /// none promises an improvement; then repeats this with all candidates. Stops early when the time
  /// is up, but not before a trial of one candidate has succeeded.
  void run() {
    if (prospects_.empty()) return;
    double const least = prospects_.front().expected_evaluations();
    for (double const factor : {unlikely, infinite}) {
      try_each(factor * least);
      refine();
    }
    time_again();
  }

  /// Tries candidates until one meets the error, however long that takes. Returns false if none
  /// does.
  bool find_any() {
    for (auto& prospect : prospects_)
      while (!prospect.is_dropped()) {
        attempt(prospect);
        if (prospect.passing(error_)) return true;
      }
    return false;
  }

  /// Returns all advice, cheapest first. Leaves out candidates that are only predicted to be faster
  /// than the best one whose trial met the error.
  std::vector<Advice> all_advice() const {
    std::vector<Advice> all;
    double const least = least_seconds();
    for (auto const& prospect : prospects_) {
      if (!runs(prospect)) continue;
      auto const* const passing = prospect.passing(error_);
      auto const steps = passing ? passing->steps : prospect.needed(goal_);
      double const seconds = passing ? passing->seconds : prospect.seconds_of(steps);
      if (!passing && (prospect.is_dropped() || !prospect.allows(steps) ||
                       (std::isfinite(least) && seconds < least)))
        continue;
      all.push_back(
          to_the_end(prospect.candidate(), steps, passing ? passing->error : goal_, seconds));
      all.back().measured = passing != nullptr;
    }
    std::ranges::sort(all, {}, &Advice::seconds);
    return all;
  }

 private:
  static bool has_run(Try const& one) { return std::isfinite(one.error); }
  static bool runs(Prospect const& prospect) {
    return std::ranges::any_of(prospect.tries(), has_run);
  }

  void add(Candidate const& candidate) {
    if (!pilot_.fits(candidate)) return;
    // Only adaptive steps can resolve features of the field that come after the horizon.
    if (!candidate.method->adaptive && !is_representative_) return;
    auto coarsest = coarsest_steps(pilot_, candidate, horizon_.time, horizon_.own_steps);
    // A run takes at least the steps that its frames and samples ask for.
    if (!candidate.method->adaptive)
      coarsest.count = std::max(
          coarsest.count,
          static_cast<std::int64_t>(
              std::ceil(whole_steps(pilot_, {candidate, {}, pilot_.end()}) / parts() - 1e-9)));
    if (pilot_.scene().integrator.refuse_unstable && !candidate.method->adaptive) {
      // Starts at the stable dt, because a larger dt is the usual reason for a refusal. Without
      // refuse_unstable the stable dt is not needed, and with a sigma it takes long to compute.
      double const stable = pilot_.plan(candidate, horizon_.time, coarsest).stable_dt;
      if (!(stable > 0)) return;
      coarsest.count =
          std::max(coarsest.count, static_cast<std::int64_t>(std::ceil(horizon_.time / stable)));
    }
    for (int i = 0; is_refused(candidate, coarsest); ++i) {
      if (i == all_finer) return;
      coarsest = finer(candidate, coarsest);
    }
    auto const scene = with(pilot_.scene(), candidate, horizon_.time, 1, coarsest);
    auto const& variant = find_variant(scene);
    double const order =
        candidate.substeps > 0 ? order_with_multirate(scene, variant) : variant.order;
    bool const adaptive = candidate.method->adaptive;
    // The error of an adaptive method is close to its tolerance, and its cost depends little on the
    // tolerance.
    auto first = coarsest;
    if (adaptive) first.tolerance = std::min(coarsest.tolerance, 30 * goal_);
    constexpr double of_iterations = 20, error_of_own_steps = 1e-2;
    double const own = static_cast<double>(horizon_.own_steps) *
                       std::pow(error_of_own_steps / request_.error, 1 / order);
    prospects_.emplace_back(candidate, coarsest, first, adaptive ? 1 : order,
                            adaptive ? 1 / order : 1,
                            std::max(own, static_cast<double>(coarsest.count)) *
                                variant.evaluations.value_or(adaptive ? 6 : of_iterations));
  }

  bool is_refused(Candidate const& candidate, Steps const& steps) const {
    return pilot_.scene().integrator.refuse_unstable &&
           dt_warning(pilot_.plan(candidate, horizon_.time, steps), pilot_.scene().units);
  }

  double parts() const { return pilot_.end() / horizon_.time; }

  bool is_over(double share) const {
    double const of_best = most_share * parts() * least_seconds();
    return clock_.seconds() > share * std::clamp(of_best, least_limit, limit_);
  }

  // Returns the time of the coarsest trial that meets the error; infinite if no trial meets it.
  double seconds_of_passing(Prospect const& prospect) const {
    auto const* const passing = prospect.passing(error_);
    return passing ? passing->seconds : infinite;
  }
  double least_seconds() const {
    double least = infinite;
    for (auto const& one : prospects_) least = std::min(least, seconds_of_passing(one));
    return least;
  }
  bool anything_runs() const { return std::ranges::any_of(prospects_, runs); }

  void try_each(double most_evaluations) {
    for (auto& prospect : prospects_) {
      if (prospect.expected_evaluations() > most_evaluations) return;
      if (is_over(first_share) && anything_runs()) return;
      while (!prospect.is_dropped() && !runs(prospect)) attempt(prospect);
    }
  }

  void refine() {
    while (!is_over(try_share))
      if (auto* const promising = most_promising())
        attempt(*promising);
      else if (!time_doubtful())
        return;
  }

  // Returns the candidate predicted to be the cheapest; null if none is likely to be cheaper than
  // the best trial that meets the error.
  Prospect* most_promising() {
    Prospect* promising = nullptr;
    double least = least_seconds() / hope;
    for (auto& one : prospects_) {
      if (one.is_dropped() || !runs(one) || one.is_settled(error_, goal_)) continue;
      double const seconds = one.seconds_of(one.needed(goal_));
      if (seconds >= least) continue;
      least = seconds;
      promising = &one;
    }
    return promising;
  }

  void attempt(Prospect& prospect) {
    auto const steps = prospect.next(goal_);
    auto const& candidate = prospect.candidate();
    if (!prospect.allows(steps)) return prospect.drop();
    if (request_.progress) request_.progress->show(clock_.seconds() / limit_, candidate.name());
    prospect.add(fine_.solution.measure(candidate, steps, true, quick), fine_.error);
    if (prospect.tries().size() >= tries || prospect.is_round_off(error_)) prospect.drop();
  }

  // Repeats timings that noise may have lengthened. Returns true if it has repeated any.
  bool time_doubtful() {
    bool any = false;
    double const most = doubt * least_seconds();
    for (auto& prospect : prospects_) {
      if (prospect.is_dropped() || !runs(prospect) || prospect.is_timed_twice() ||
          prospect.is_settled(error_, goal_))
        continue;
      if (prospect.seconds_of(prospect.needed(goal_)) > most || is_over(try_share)) continue;
      auto const steps = std::ranges::find_if(prospect.tries(), has_run)->steps;
      prospect.add_time(steps,
                        pilot_.run(prospect.candidate(), horizon_.time, steps, quick).seconds());
      any = true;
    }
    return any;
  }

  // Times the best candidates again, in turns, so that noise affects all equally.
  void time_again() {
    for (int round = 0; round < rounds; ++round) {
      double const most = (round == 0 ? doubt : contender) * least_seconds();
      for (auto& prospect : prospects_) {
        auto const* const passing = prospect.passing(error_);
        if (!passing || prospect.seconds_of(passing->steps) > most) continue;
        if (is_over(1)) return;
        auto const steps = passing->steps;
        auto const again = pilot_.run(prospect.candidate(), horizon_.time, steps, quick);
        prospect.add_time(steps, again.seconds());
      }
    }
  }

  Advice to_the_end(Candidate const& candidate, Steps const& steps, double error,
                    double seconds) const {
    Advice advice{candidate, steps, 0, error, seconds * parts(), 0};
    if (!candidate.method->adaptive) {
      advice.steps.count =
          static_cast<std::int64_t>(std::ceil(static_cast<double>(steps.count) * parts()));
      advice.dt = pilot_.end() / static_cast<double>(advice.steps.count);
      advice.seconds *= whole_steps(pilot_, advice) / static_cast<double>(advice.steps.count);
    }
    return advice;
  }

  Pilot const& pilot_;
  Horizon const& horizon_;
  Known const& fine_;
  AdviceRequest const& request_;
  Kokkos::Timer const& clock_;
  double limit_;  // in seconds
  bool is_representative_;
  double error_, goal_;  // error accepted; error to aim for
  std::vector<Prospect> prospects_;
};

// Returns the time limit of a search, estimated from a coarse run of a part of the scene.
double limit_of(Pilot const& pilot) {
  auto const part = horizon_within(pilot, coarse_share * least_limit);
  return std::max(least_limit, most_share * part.seconds * pilot.end() / part.time);
}

// Returns a solution up to the horizon, which is halved until the solution's error is below a
// fraction of `error` and the solution is expected to take at most `seconds`. Throws NumbersFailed
// after twenty halvings.
Known fine_solution(Pilot const& pilot, Horizon& horizon, double error, double seconds) {
  auto const by = fine_tsit5();
  double const tightest = by.least_tolerance();
  for (int i = 0; i < horizons; ++i) {
    FineSolution coarser(pilot, horizon.time, by, std::max(error / 10, 10 * tightest));
    std::string why;
    while (why.empty()) {
      if (2 * coarser.seconds() > seconds) {
        why = fmt::format("a fine solution takes more than {:.2g} s", 2 * coarser.seconds());
        break;
      }
      FineSolution solution(pilot, horizon.time, by, coarser.tolerance() / 10);
      double const unknown = coarser.distance_to(solution) / 9;
      bool const is_tightest = solution.tolerance() < 10 * tightest;
      if (unknown <= error / 30 || (is_tightest && unknown < error / 5))
        return {std::move(solution), unknown};
      if (solution.failure())
        why = *solution.failure();
      else if (is_tightest)
        why = fmt::format("two runs of tsit5 differ by {:.1e} at t = {}", 9 * unknown,
                          time_text(pilot.scene().units, horizon.time, 6));
      coarser = std::move(solution);
    }
    horizon.halve(why);
  }
  throw NumbersFailed(pilot.scene().path.string() +
                      ": there is no solution to compare with: " + horizon.why_shorter);
}

// Returns true if the steps of the actual run meet the error. Tries these steps if their error was
// only extrapolated, because it may be far off. Also tries constant steps in a field that depends
// on t: then the error depends on the times of the steps, which the times of the scene's frames may
// have moved. Shortens steps that miss the error a few times before it returns false.
bool holds(Pilot const& pilot, Horizon const& horizon, Known const& fine, double error,
           Advice& advice) {
  bool const adaptive = advice.candidate.method->adaptive;
  if (advice.measured && (adaptive || !io::depends_on_time(pilot.scene().field))) return true;
  constexpr double shorter = 1.5, closer = 4;
  for (int i = 0; i < refinements; ++i) {
    auto steps = advice.steps;
    double const whole = whole_steps(pilot, advice);
    if (!adaptive) steps.count = std::llround(whole * horizon.time / pilot.end());
    auto const tried = fine.solution.measure(advice.candidate, steps, true, {});
    advice.error = tried.error;
    advice.measured = true;
    if (tried.error + fine.error <= error) return true;
    if (adaptive) {
      advice.steps.tolerance /= closer;
      if (advice.steps.tolerance < advice.candidate.least_tolerance()) return false;
    } else {
      advice.steps.count = std::llround(whole * shorter);
      advice.dt = pilot.end() / static_cast<double>(advice.steps.count);
    }
    advice.seconds *= adaptive ? shorter : whole_steps(pilot, advice) / whole;
  }
  return false;
}

}  // namespace

Advised advise(Pilot const& pilot, AdviceRequest const& request) {
  Kokkos::Timer const clock;
  double const limit = limit_of(pilot);
  if (request.progress) request.progress->announce(limit);
  auto horizon = horizon_within(pilot, coarse_share * limit);
  auto const fine = fine_solution(pilot, horizon, request.error, fine_share * limit);
  Search search(pilot, horizon, fine, request, clock, limit);
  search.run();
  Advised advised;
  // If an error was only extrapolated, holds() tries the steps. That could take arbitrarily long,
  // so advice whose trial would exceed the limit is dropped.
  double const part = horizon.time / pilot.end();
  auto const is_too_long = [&](Advice const& one) {
    return !one.measured && one.seconds * part > limit;
  };
  for (bool again : {false, true}) {
    if (again && !(advised.others.empty() && search.find_any())) break;
    auto& others = advised.others = search.all_advice();
    while (!others.empty() && !others.front().holds) {
      auto& first = others.front();
      first.holds = !is_too_long(first) && holds(pilot, horizon, fine, request.error, first);
      if (!first.holds) others.erase(others.begin());
      // holds() may have refined the steps, so that another method is now the cheapest.
      std::ranges::stable_sort(others, {}, &Advice::seconds);
    }
  }
  if (!pilot.is_representative(horizon.time))
    horizon.why_shorter += "; the field changes later, so only adaptive methods are tried";
  advised.horizon = horizon.time;
  advised.why_shorter = horizon.why_shorter;
  if (!advised.others.empty() &&
      !(request.budget && advised.others.front().seconds > *request.budget))
    advised.choice = advised.others.front();
  if (auto& choice = advised.choice)
    choice->memory = pilot.plan(choice->candidate, pilot.end(), choice->steps).memory.total();
  advised.seconds = clock.seconds();
  return advised;
}

}  // namespace cayspin::program::trade
