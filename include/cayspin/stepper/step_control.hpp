// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/text.hpp>
#include <cayspin/stepper/step_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2 {

/// Thrown when an adaptive step would have to be shorter than min_dt or than the resolution of t.
/// In the second case the values are not finite, or the field is not smooth. The spins are those
/// before the step; under integrate() they are those of the last time at which an observer was due,
/// or of a later time. The next step starts a new run from the spins that it is given.
class StepTooSmall : public std::runtime_error {
 public:
  StepTooSmall(std::string const& message, double start, double length, double least)
      : std::runtime_error(message), t_(start), dt_(length), min_dt_(least) {}

  /// Return the start and the length of the step that would have been needed.
  double t() const { return t_; }
  double dt() const { return dt_; }
  /// Returns the smallest step that the options allow.
  double min_dt() const { return min_dt_; }

 private:
  double t_, dt_, min_dt_;
};

/// Options for the steps of an adaptive method.
struct StepOptions {
  double tolerance = 1e-6;  ///< desired bound on the error of a run: the largest angle between a
                            ///< spin and its exact direction, in radians
  double first_dt = 0;      ///< 0: chosen from the largest rate and the tolerance
  double min_dt = 0;  ///< if the tolerance needs a shorter step, StepTooSmall is thrown; other
                      ///< steps are shorter only to end at `end`, or as `bounds` require
  double max_dt = std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();  ///< no stage is evaluated after this time
  /// Intervals in which the field jumps, or changes so fast that steps may miss the change between
  /// their stages. Ascending and disjoint.
  std::vector<StepBound> bounds = {};

  /// The smallest tolerance: below it, round-off hides the error of a step.
  template <class Real>
  static constexpr double least_tolerance() {
    return 32 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  }
};

namespace detail {

/// A proportional-integral controller (Hairer and Wanner, Solving ODEs II, IV.2): computes the next
/// dt from the errors of this step and the previous one. It uses plain host arithmetic on a maximum
/// over sites, so that the steps are equal on every host space.
class StepController {
 public:
  /// `error_order`: the error estimate is proportional to this power of dt.
  StepController(StepOptions const& options, int error_order, double least_tolerance,
                 std::string const& region)
      : options_(options), exponent_(1.0 / error_order) {
    auto const refuse = [&](char const* what) { throw std::invalid_argument(region + what); };
    if (!(options.tolerance >= least_tolerance) || !(options.tolerance <= 1))
      refuse(": the tolerance must be between 32 epsilon of the precision and 1");
    if (!(options.min_dt >= 0) || !(options.max_dt > 0) || options.min_dt > options.max_dt)
      refuse(": 0 <= min_dt <= max_dt and max_dt > 0 must hold");
    if (!(options.first_dt >= 0)) refuse(": first_dt must not be negative");
  }

  /// Returns the largest allowed error of one step, in radians. It is smaller than the tolerance of
  /// the run, because errors add up, and smallest for low orders, which take more steps. The
  /// factors were calibrated on switching spins, films and Heisenberg lattices
  /// (docs/reference/methods.md).
  double step_tolerance() const {
    return options_.tolerance * (exponent_ < 0.25 ? 1.0 / 12 : 1.0 / 160);
  }

  /// Returns the first dt, between min_dt and max_dt: that of the options if it is not 0, otherwise
  /// one for spins that turn by at most `rate` per unit of time, or `asked` if none turns.
  double first_dt(double rate, double asked) const {
    double const angle = 0.5 * std::pow(step_tolerance(), exponent_);
    bool const turns = rate > 0 && std::isfinite(rate);
    double const dt = options_.first_dt > 0 ? options_.first_dt : turns ? angle / rate : asked;
    return std::min(std::max(dt, options_.min_dt), largest_dt());
  }

  bool accepts(double error) const { return error <= step_tolerance(); }

  /// Returns the next dt after a step of dt with this error. An error of NaN counts as far too
  /// large.
  double next_dt(double dt, double error) {
    double const ratio = error / step_tolerance();
    if (!(ratio <= 1)) {
      rejected_ = true;
      double const factor = safety * std::pow(ratio, -exponent_);
      return dt * (factor > smallest ? factor : smallest);
    }
    double const least = 1e-8;  // smaller ratios count as this one
    double const now = std::max(ratio, least);
    double factor = safety * std::pow(now, -0.7 * exponent_) * std::pow(before_, 0.4 * exponent_);
    factor = std::clamp(factor, smallest, rejected_ ? 1.0 : largest);
    before_ = now;
    rejected_ = false;
    return std::min(dt * factor, largest_dt());
  }

  void reset() {
    before_ = 1;
    rejected_ = false;
  }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("error_before", before_);
    visit("after_rejection", rejected_);
  }

 private:
  static constexpr double safety = 0.9, smallest = 0.1, largest = 5;

  // Steps grow near equilibrium, but stay finite.
  double largest_dt() const { return std::min(options_.max_dt, 1e100); }

  StepOptions options_;
  double exponent_;
  double before_ = 1;  // error / tolerance of the last accepted step
  bool rejected_ = false;
};

/// The internal steps of an adaptive method. They do not depend on the requested times, with one
/// exception: if no spin turns at the start, the first requested dt is the default first step.
class OwnSteps {
 public:
  std::int64_t accepted_steps() const { return accepted_; }
  std::int64_t rejected_steps() const { return rejected_; }
  /// Returns the dt of the next internal step.
  double next_dt() const { return next_dt_; }
  /// Forgets the run so far: the next step starts from the t and spins that it is given.
  void reset() { running_ = false; }
  /// Returns true if the internal steps have reached t, to within 1e-9 * |dt| + 4 * epsilon * |t|.
  /// dt is the length of the requested step that ends at t.
  bool has_reached(double t, double dt) const { return end_time_ >= t - slack(t, dt); }

 protected:
  /// Outcome of an attempted step. The error is an angle.
  struct Try {
    double error = 0;
    double most_growth = std::numeric_limits<double>::infinity();  // largest (next dt) / dt
    bool is_solved = true;  // if false, `error` is not used, and dt is halved
  };

  OwnSteps(StepOptions const& options, int error_order, double least_tolerance,
           std::string const& region)
      : options_(options),
        controller_(options, error_order, least_tolerance, region),
        bounds_(options.bounds, region),
        region_(region) {}

  /// Calls begin(start) unless a run is in progress; `start` is t, or the end of a jump at t. Then
  /// calls take_step() until an internal step ends at t + dt or later. If one ends at the start of
  /// a jump, begin(end of the jump) is called again; it starts from the spins at the end of that
  /// step. An exception from begin or take_step ends the run: the next step starts from the t and
  /// spins that it is given. Throws std::invalid_argument when dt is negative or options.end is
  /// before t + dt.
  template <class Begin, class TakeStep>
  void go_on_to(double t, double dt, Begin const& begin, TakeStep const& take_step) {
    double const asked = t + dt;
    if (!(dt >= 0) || !(asked <= options_.end + slack(asked, dt)))
      throw std::invalid_argument(
          region_ + "::step: dt must not be negative, nor t + dt beyond the end of the options");
    try {
      if (!running_) begin(bounds_.after_jump(t));
      while (!has_reached(asked, dt)) {
        if (double const after = bounds_.after_jump(end_time_); after > end_time_) begin(after);
        take_step();
      }
    } catch (...) {
      reset();
      throw;
    }
  }

  bool is_running() const { return running_; }

  /// Starts a run at t, for spins that turn by at most `rate` per unit of time. `asked`: the
  /// requested dt, which is the default first step if no spin turns.
  void begin_run(double t, double rate, double asked) {
    controller_.reset();
    next_dt_ = controller_.first_dt(rate, asked);
    end_time_ = t;
    running_ = next_dt_ > 0;  // next_dt_ is 0 for spins at equilibrium and dt = 0
  }

  /// Takes the next internal step: try_step(t, dt) returns a Try. Throws StepTooSmall.
  template <class TryStep>
  void take_own_step(TryStep const& try_step) {
    double const t = end_time_;
    while (true) {
      auto const [dt, end] = bounds_.step(t, next_dt_, options_.end);
      if (!(t + dt > t)) give_up(t, dt);  // t + dt rounds to t
      Try const now = try_step(t, dt);
      next_dt_ = now.is_solved ? controller_.next_dt(dt, now.error) : 0.5 * dt;
      if (now.is_solved && controller_.accepts(now.error)) {
        next_dt_ = std::max(options_.min_dt, std::min(next_dt_, now.most_growth * dt));
        end_time_ = end;
        dt_ = dt;
        ++accepted_;
        return;
      }
      ++rejected_;
      double const least = 16 * std::numeric_limits<double>::epsilon() * std::abs(t);
      if (!(next_dt_ >= std::max(options_.min_dt, least)) || next_dt_ == 0) give_up(t, next_dt_);
    }
  }

  /// For cayspin::serialize. Returns true if a run is in progress.
  template <class Visit>
  bool visit_steps(Visit const& visit) {
    visit("accepted", accepted_);
    visit("rejected", rejected_);
    visit("running", running_);
    if (!running_) return false;
    controller_.visit_memory(visit);
    visit("end_time", end_time_);
    visit("dt", dt_);
    visit("next_dt", next_dt_);
    return true;
  }

  StepOptions options_;
  StepController controller_;
  double end_time_ = 0, dt_ = 0, next_dt_ = 0;  // the last internal step ends at end_time_

 private:
  // Times that are computed in different ways, such as t + dt and the sum of internal steps, differ
  // by round-off.
  static double slack(double t, double dt) {
    return 1e-9 * std::abs(dt) + 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
  }

  StepBounds bounds_;
  [[noreturn]] void give_up(double t, double dt) const {
    throw StepTooSmall(
        region_ + "::step: from t = " + to_text(t) + " the tolerance needs a step below " +
            to_text(dt) +
            (options_.min_dt > dt ? ", and the smallest allowed is " + to_text(options_.min_dt)
                                  : "; the numbers are not finite, or the field is not smooth"),
        t, dt, options_.min_dt);
  }

  std::string region_;
  std::int64_t accepted_ = 0, rejected_ = 0;
  bool running_ = false;
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
