// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "problem.hpp"

#include <cayspin/field/slow_field.hpp>
#include <cayspin/stepper/multirate.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

/// The reversal of standard problem 4 with its demagnetising field as a SlowField.
class MultirateProblem4 {
 public:
  using Problem = StandardProblem4;
  using Spins = cayspin::SpinField<double>;
  using SlowTerm =
      cayspin::SlowField<Spins, cayspin::HostField<Spins, cayspin::DemagnetizingField<double>>>;
  static constexpr int looks_per_nanosecond = 50;

  /// Call problem.relax() first: runs start at that equilibrium.
  MultirateProblem4(Problem const& problem, Problem::Vector const& millitesla, int nanoseconds)
      : problem_(problem),
        nanoseconds_(nanoseconds),
        spins_("spins", problem.film()),
        slow_(spins_, problem.demag()),
        generator_(problem.generator(slow_, millitesla)) {}

  struct Run {
    std::vector<Problem::Vector> m;  // at each sample
    double largest_rise = 0;         // of the energy between two samples
    double fall = 0, round_off = 0;  // of the energy: in the whole run; in one value
    std::int64_t multirate = 0;      // evaluations of the demagnetising field by steps
    double seconds = 0;              // of steps only

    bool energy_never_rises() const { return largest_rise <= round_off; }
    double apart(Run const& other) const {
      double largest = 0;
      for (std::size_t i = 0; i < m.size(); ++i) {
        auto const d = m[i] - other.m[i];
        largest = std::max({largest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      }
      return largest;
    }
  };

  /// Every stage evaluates the demagnetising field.
  Run rkmk4(int steps) { return run(cayspin::Rkmk4<Spins>(spins_), steps); }
  template <class Tableau>
  Run adaptive(double tolerance) {
    return run(
        cayspin::AdaptiveRkmk<Spins, Tableau>(spins_, cayspin::StepOptions{.tolerance = tolerance}),
        looks());
  }
  /// Each step but the first takes one evaluation of the demagnetising field, and twice `substeps`
  /// steps of RKMK4 for everything else.
  template <int Order>
  Run multirate(int steps, int substeps) {
    return run(cayspin::Multirate<cayspin::Rkmk4<Spins>, SlowTerm, Order>(
                   spins_, cayspin::Rkmk4<Spins>(spins_), slow_, {.substeps = substeps}),
               steps);
  }
  int looks() const { return looks_per_nanosecond * nanoseconds_; }

 private:
  template <class Stepper>
  Run run(Stepper stepper, int steps) {
    cayspin::copy_from_host(problem_.at_rest(), spins_);
    Run run;
    std::int64_t by_looks = 0;
    double before = std::numeric_limits<double>::infinity(), first = 0;
    auto const look = [&](auto const& exec, cayspin::Step const& step, auto const& spins) {
      auto const evaluations = slow_.evaluations_done();
      auto const now = cayspin::sample(exec, generator_, step, spins);
      by_looks += slow_.evaluations_done() - evaluations;
      if (step.number == 0) first = now.energy.value;
      if (step.number > 0) run.m.push_back(now.magnetization);
      run.largest_rise = std::max(run.largest_rise, now.energy.value - before);
      run.round_off = 64 * std::numeric_limits<double>::epsilon() * now.energy.magnitude;
      run.fall = first - now.energy.value;
      before = now.energy.value;
    };
    auto const evaluations = slow_.evaluations_done();
    double const dt = nanoseconds_ * problem_.nanosecond() / steps;
    auto const summary = cayspin::integrate(Problem::Exec(), stepper, generator_, spins_,
                                            {0, dt, steps}, cayspin::Every(steps / looks(), look));
    run.multirate = slow_.evaluations_done() - evaluations - by_looks;
    run.seconds = summary.step_seconds;
    return run;
  }

  Problem const& problem_;
  int nanoseconds_;
  Spins spins_;
  SlowTerm slow_;
  decltype(std::declval<Problem const&>().generator(std::declval<SlowTerm const&>(),
                                                    Problem::Vector())) generator_;
};

/// Prints a run next to the converged one. Returns false for an error above `limit`, or a rise of
/// the energy.
inline bool report(char const* what, MultirateProblem4::Run const& run,
                   MultirateProblem4::Run const& converged, double limit) {
  double const error = run.apart(converged);
  std::printf("%-34s %6lld evaluations, %5.1f s, <m> apart %.1e, energy %s\n", what,
              static_cast<long long>(run.multirate), run.seconds, error,
              run.energy_never_rises() ? "never rises" : "RISES");
  std::fflush(stdout);
  return error < limit && run.energy_never_rises();
}
