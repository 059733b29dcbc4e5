// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/callers_memory.hpp>
#include <cayspin/detail/execution.hpp>

#include <Kokkos_Timer.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

/// Steps of length dt, up to step number `steps`; step n ends at time begin + (n - origin) * dt.
/// The run starts at the end of step `first`, which is 0 unless it continues another run.
struct Times {
  double begin = 0, dt = 0;
  std::int64_t steps = 0;
  std::int64_t first = 0;
  bool continues = false;   // keep what the stepper remembers of the previous run
  std::int64_t origin = 0;  // the step that ends at time begin

  double at(std::int64_t step) const { return begin + static_cast<double>(step - origin) * dt; }
};

/// Statistics of an integration.
struct Summary {
  std::int64_t steps = 0;
  std::int64_t evaluations = 0;  // generator evaluations
  double step_seconds = 0;       // wall-clock time of the steps, without observers
  bool stopped = false;          // by an observer, before the last step
  std::int64_t own_steps = 0;    // accepted steps of an adaptive method
  std::int64_t rejected = 0;     // rejected steps of an adaptive method
};

/// Observer that calls another one at steps whose number is a multiple of `period`, including 0
/// (the initial state), and at the last step. If the other one has a due(Step), that must also be
/// true. If the observer is a variable, Every holds a reference to it, and the variable must
/// outlive Every. A temporary is moved into Every.
///   Every(10, control)             refers to `control`
///   Every(10, Record(field, to))
template <class Observer>
class Every {
 public:
  static constexpr bool changes_spins = detail::changes_spins<Observer>;
  static constexpr bool begins_step = detail::begins_step<Observer>;

  /// Throws std::invalid_argument for a period below 1.
  Every(std::int64_t period, Observer&& observer)
      : period_(period), observer_(std::forward<Observer>(observer)) {
    if (period < 1) throw std::invalid_argument("cayspin::Every: the period must be at least 1");
  }

  bool due(Step const& step) const {
    return (step.last || step.number % period_ == 0) && detail::is_due(observer_, step);
  }

  template <class Exec, class Spins>
  auto operator()(Exec const& exec, Step const& step, Spins const& spins) {
    return observer_(exec, step, spins);
  }

 private:
  std::int64_t period_;
  Observer observer_;  // a reference type for a named observer
};

template <class Observer>
Every(std::int64_t, Observer&&) -> Every<Observer>;

namespace detail {

/// A stepper that can take several steps in a single kernel launch if there are few spins.
template <class Stepper, class Exec, class Generator, class Spins>
concept has_batches =
    requires(Stepper& stepper, Exec const& exec, Generator const& generator, Spins& spins) {
      stepper.takes_batches(exec, generator, spins);
      stepper.batch(exec, generator, spins, 0.0, 0.0, std::int64_t{1});
    };

/// A stepper that can skip writing the spins at times when no observer reads them.
template <class Stepper, class Exec, class Generator, class Spins>
concept has_steps_towards =
    requires(Stepper& stepper, Exec const& exec, Generator const& generator, Spins& spins) {
      stepper.step_towards(exec, generator, spins, 0.0, 0.0, 0.0);
      { stepper.has_reached(0.0, 0.0) } -> std::same_as<bool>;
    };

template <class Exec, class Observer, class Spins>
Next observe(Exec const& exec, Observer& observer, Step const& step, Spins const& spins) {
  static_assert(std::is_invocable_v<Observer&, Exec const&, Step const&, Spins const&>,
                "An observer is called as observer(exec, Step, spins).");
  if (!is_due(observer, step)) return Next::proceed;
  using Result = std::invoke_result_t<Observer&, Exec const&, Step const&, Spins const&>;
  if constexpr (std::is_same_v<Result, Next>) {
    return observer(exec, step, spins);
  } else {
    static_assert(std::is_void_v<Result>,
                  "An observer returns nothing, or cayspin::Next to say whether to go on.");
    observer(exec, step, spins);
    return Next::proceed;
  }
}

/// Returns true if an observer that may stop the run comes after one with begins_step in the
/// argument list.
template <class Exec, class Spins, class... Observers>
constexpr bool may_stop_in_a_step() {
  bool begun = false, stops = false;
  [[maybe_unused]] auto const next = [&](bool begins, bool may_stop) {
    stops = stops || (begun && may_stop);
    begun = begun || begins;
  };
  (next(
       begins_step<Observers>,
       requires(Observers& one, Exec const& exec, Step const& step, Spins const& spins) {
         { one(exec, step, spins) } -> std::same_as<Next>;
       }),
   ...);
  return stops;
}

/// Throws when a term or generator, or a part of it, was made for spins of another lattice.
template <class Term, class Spins>
void check_spins_of_parts(Term const& term, Spins const& spins) {
  check_spins(term, spins);
  auto const check = [&](auto const& part) {
    check_spins_of_parts(part, spins);
    return true;
  };
  if constexpr (requires { term.all_parts(check); }) term.all_parts(check);
}

/// A type-erased integration, so that the loop is compiled once.
class Integration {
 public:
  virtual void fence(char const* label) = 0;
  virtual bool is_due(Step const& step) = 0;  // true if any observer is due
  virtual Next observe(Step const& step) = 0;
  /// Takes one or more steps after step `number`, at most up to step `due`, and returns how many.
  /// If it reaches step `due`, the spins are those after that step; otherwise they may be those of
  /// an earlier time.
  virtual std::int64_t take_steps(Times const& times, std::int64_t number, std::int64_t due) = 0;

  /// `looks_ahead`: take_steps can make use of a `due` that is more than one step away.
  Summary run(Times const& times, bool looks_ahead) {
    Summary summary;
    fence("cayspin::integrate: begin");
    Kokkos::Timer clock;
    for (std::int64_t number = times.first, due = number;;) {
      Step const now{number, times.at(number), times.dt, number == times.steps};
      if (number == due && (now.last || is_due(now))) {
        fence("cayspin::integrate: observers");
        summary.step_seconds += clock.seconds();
        bool const stop = observe(now) == Next::stop;
        if (now.last || stop) {
          summary.stopped = stop && !now.last;
          return summary;
        }
        clock.reset();
      }
      due = looks_ahead ? next_due(times, number, due) : number + 1;
      std::int64_t const steps = take_steps(times, number, due);
      number += steps;
      summary.steps += steps;
    }
  }

 protected:
  ~Integration() = default;

 private:
  /// Returns the next step after `number` at which an observer is due, or the last step, but at
  /// most number + 1000, so that observers whose due() depends on more than the step are soon asked
  /// again. `known`: the previous result. If it is after `number`, only step number + 1 is asked
  /// about.
  std::int64_t next_due(Times const& times, std::int64_t number, std::int64_t known) {
    bool const is_known = known > number;
    std::int64_t const last = is_known ? known : std::min(times.steps, number + 1000);
    std::int64_t const asked = is_known ? std::min(known, number + 2) : last;
    for (std::int64_t next = number + 1; next < asked; ++next)
      if (is_due({next, times.at(next), times.dt, false})) return next;
    return last;
  }
};

template <class Exec, class Stepper, class Generator, class Spins, class... Observers>
class IntegrationOf final : public Integration {
 public:
  IntegrationOf(Exec const& exec, Stepper& stepper, Generator const& generator, Spins& spins,
                Observers&... observers)
      : exec_(exec),
        stepper_(stepper),
        generator_(generator),
        spins_(spins),
        observers_(observers...) {}

  void fence(char const* label) override { exec_.fence(label); }
  bool is_due(Step const& step) override {
    return std::apply([&](auto&... one) { return (detail::is_due(one, step) || ...); }, observers_);
  }
  Next observe(Step const& step) override {
    Step now = step;
    std::apply(
        [&](auto&... one) {
          ((now.stops = detail::observe(exec_, one, now, spins_) == Next::stop || now.stops), ...);
        },
        observers_);
    return now.stops ? Next::stop : Next::proceed;
  }
  std::int64_t take_steps(Times const& times, std::int64_t number, std::int64_t due) override {
    double const t = times.at(number), dt = times.dt;
    if constexpr (has_steps_towards<Stepper, Exec, Generator, Spins>) {
      auto const end = [&](std::int64_t step) { return times.at(step - 1) + dt; };
      stepper_.step_towards(exec_, generator_, spins_, t, dt, end(due));
      std::int64_t reached = number + 1;
      while (reached < due && stepper_.has_reached(end(reached + 1), dt)) ++reached;
      return reached - number;
    }
    if constexpr (has_batches<Stepper, Exec, Generator, Spins>) {
      if (due > number + 1) {
        stepper_.batch(exec_, generator_, spins_, t, dt, due - number);
        return due - number;
      }
    }
    stepper_.step(exec_, generator_, spins_, t, dt);
    return 1;
  }

 private:
  Exec const& exec_;
  Stepper& stepper_;
  Generator const& generator_;
  Spins& spins_;
  std::tuple<Observers&...> observers_;
};

/// Like integrate(), but the spins may end up in memory of the stepper.
template <class Exec, class Stepper, class Generator, class Spins, class... Observers>
Summary integrate_in_any_memory(Exec const& exec, Stepper& stepper, Generator const& generator,
                                Spins& spins, Times const& times, Observers&&... observers) {
  static_assert(std::is_same_v<std::remove_const_t<Spins>, typename Stepper::spins_type>,
                "The stepper was made for another type of spin field.");
  static_assert(
      cayspin::Stepper<Stepper>,
      "A stepper needs step(exec, generator, spins, t, dt), and either a static constexpr "
      "int evaluations (of the generator, per step) or evaluations_done().");
  static_assert(
      !(AdaptiveStepper<Stepper> && (changes_spins<std::remove_cvref_t<Observers>> || ...)),
      "An observer that changes spins (EnergyControl, Normalize) does not go with an "
      "adaptive stepper, which goes on from a state of its own.");
  static_assert(!may_stop_in_a_step<Exec, Spins, std::remove_reference_t<Observers>...>(),
                "ThermalNoise's before_steps() and between_steps() come after every observer that "
                "may stop the run.");
  check_access<Exec, typename Spins::memory_space>();
  if (!std::isfinite(times.dt) || !std::isfinite(times.begin))
    throw std::invalid_argument("cayspin::integrate: begin and dt must be finite");
  if (times.first < 0)
    throw std::invalid_argument("cayspin::integrate: the first step has a negative number");
  if (times.steps < times.first)
    throw std::invalid_argument("cayspin::integrate: steps is " + std::to_string(times.steps) +
                                "; it must be at least first, which is " +
                                std::to_string(times.first));
  // These checks come before an observer sees the spins, and are made even if there are no steps to
  // take.
  if constexpr (requires { stepper.check_spins(spins); }) stepper.check_spins(spins);
  check_spins_of_parts(generator, spins);

  if constexpr (requires { stepper.reset(); }) {
    if (!times.continues) stepper.reset();
  }
  std::int64_t evaluations_before = 0, first_evaluations = 0;
  if constexpr (counts_evaluations<Stepper>)
    evaluations_before = stepper.evaluations_done();
  else
    first_evaluations = evaluations_of_next_step(stepper);
  std::pair<std::int64_t, std::int64_t> own_before;
  if constexpr (AdaptiveStepper<Stepper>)
    own_before = {stepper.accepted_steps(), stepper.rejected_steps()};
  bool looks_ahead = has_steps_towards<Stepper, Exec, Generator, Spins>;
  if constexpr (has_batches<Stepper, Exec, Generator, Spins>)
    looks_ahead = stepper.takes_batches(exec, generator, spins);
  IntegrationOf<Exec, Stepper, Generator, Spins, std::remove_reference_t<Observers>...> integration(
      exec, stepper, generator, spins, observers...);
  Summary summary = integration.run(times, looks_ahead);
  if constexpr (counts_evaluations<Stepper>)
    summary.evaluations = stepper.evaluations_done() - evaluations_before;
  else if (summary.steps > 0)
    summary.evaluations =
        first_evaluations + (summary.steps - 1) * evaluations_per_step<Stepper>().value_or(0);
  if constexpr (AdaptiveStepper<Stepper>) {
    summary.own_steps = stepper.accepted_steps() - own_before.first;
    summary.rejected = stepper.rejected_steps() - own_before.second;
  }
  return summary;
}

}  // namespace detail

/// Advances `spins` over `times`, and returns statistics. Observers are called with the state
/// before the first step and after each one. Steppers that remember steps forget those of previous
/// runs, unless times.continues is true; then a run in pieces is bitwise identical to a single run.
///
/// On return the work has finished, and `spins` holds the final state. With every method this state
/// is in the original memory of `spins`, so that copies of the handle see it, too. Lengths of spins
/// are not checked: call require_unit_spins for your own spins.
///
/// Throws std::invalid_argument when begin or dt is not finite, times.first is negative,
/// times.steps is below times.first, or the stepper or a term of the field was made for another
/// lattice than that of the spins. These checks come before the first call of an observer, and are
/// made even if there are no steps to take.
template <class Exec, class Stepper, class Generator, class Spins, class... Observers>
Summary integrate(Exec const& exec, Stepper& stepper, Generator const& generator, Spins& spins,
                  Times const& times, Observers&&... observers) {
  static_assert(!std::is_const_v<Spins>,
                "integrate takes spins that are not const: a step may exchange their memory.");
  auto const run = [&] {
    return detail::integrate_in_any_memory(exec, stepper, generator, spins, times, observers...);
  };
  if constexpr (requires(void (*visit)(Spins&)) { stepper.visit_exchanged(visit); }) {
    detail::check_access<Exec, typename Spins::memory_space>();
    detail::CallersMemory const memory(exec, stepper, spins);
    return run();
  } else {
    return run();
  }
}

}  // namespace cayspin::inline v0_2
