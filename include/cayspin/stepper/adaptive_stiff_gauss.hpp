// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/scalars.hpp>
#include <cayspin/stepper/step_control.hpp>
#include <cayspin/stepper/stiff_gauss.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_1 {

/// StiffGauss2 with steps of its own: long ones where spins come to rest. The error of a step is
/// the largest angle of any spin that the second derivative of A stands for: a divided difference
/// over the stages of three steps, multiplied by (1 + b K)^-1 as corrections are, so that what is
/// left of short spin waves does not count. Where the field depends on t, the end of the step
/// stands for the earliest of the three. Corrections have K + c, where c is the mean of A.m.
/// `step(.., t, dt)` returns the spins at t + dt, within an own step by a linear A. The method's
/// own steps do not depend on dt. It remembers its state: `spins` and t must be those at the end of
/// the step before. Otherwise call `reset`.
template <class Spins>
class AdaptiveStiffGauss2 : public StiffGauss<Spins, 2> {
  using Base = StiffGauss<Spins, 2>;

 public:
  using typename Base::Real;
  static constexpr int work_fields = Base::work_fields + 1;

  /// Throws std::invalid_argument for invalid options, for example a tolerance below 32 epsilon of
  /// the precision.
  explicit AdaptiveStiffGauss2(Spins const& like, StepOptions const& options = {})
      : Base(name, like, {}),
        options_(options),
        controller_(options, Base::order + 1, StepOptions::least_tolerance<Real>(),
                    std::string("cayspin::") + name),
        now_(std::string(name) + "::now", like.lattice()) {
    this->solving_.tolerance =
        std::max(share_of_corrections * controller_.step_tolerance(), 16 * Base::epsilon);
    this->solving_.iterations = 10;
  }

  std::int64_t accepted_steps() const { return accepted_; }
  std::int64_t rejected_steps() const { return rejected_; }
  /// The dt of the next own step.
  double next_dt() const { return next_dt_; }

  /// Forgets the run so far: the next step begins at its own t and spins.
  void reset() {
    Base::reset();
    running_ = false;
  }

  /// For cayspin::exchange_memory.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    Base::visit_memory(visit);
    visit("accepted", accepted_);
    visit("rejected", rejected_);
    visit("running", running_);
    if (!running_) return;
    this->history_.visit_times(visit);
    controller_.visit_memory(visit);
    visit("local", this->local_);
    visit("local_dt", local_dt_);
    visit("extrapolated", this->extrapolated_);
    visit("end_time", end_time_);
    visit("dt", dt_);
    visit("next_dt", next_dt_);
    visit("begin_spins", this->start_);
    visit("end_spins", now_);
  }

  /// Brings `spins` from t to t + dt under `generator`. Waits.
  /// Throws StepTooSmall when no step is small enough, and std::invalid_argument as StiffGauss
  /// does, when dt is negative, or when options.end is before t + dt.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    this->require_other_memory(spins, now_);
    double const asked = t + dt, slack = 1e-9 * std::abs(dt);
    if (!(dt >= 0) || !(asked <= options_.end + slack))
      throw std::invalid_argument(
          this->label("::step: dt must not be negative, nor t + dt beyond the end of the options"));
    if (!running_) begin(exec, generator, spins, t, dt);
    while (end_time_ < asked - slack) take_step(exec, generator);
    deliver(exec, spins, asked);
  }

 private:
  static constexpr auto name = "AdaptiveStiffGauss2";
  static constexpr double share_of_corrections = 0.05;  // of the error of a step
  static constexpr double most_growth = 2;    // beyond it, earlier steps tell nothing of the next
  static constexpr double fast_enough = 0.4;  // convergence of corrections
  static constexpr double hardly_changes = 0.1;  // error / tolerance, where A is not extrapolated

  template <class Exec, class Generator>
  void begin(Exec const& exec, Generator const& generator, Spins const& spins, double t,
             double asked) {
    this->make_ready(exec, generator, spins, t);
    this->history_.forget();
    Kokkos::deep_copy(exec, now_.allocation(), spins.allocation());
    ++this->evaluations_done_;
    controller_.reset();
    next_dt_ = controller_.first_dt(largest_rate(exec, generator, now_, t), asked);
    end_time_ = t;
    dt_ = next_dt_;
    local_dt_ = 0;
    running_ = true;
  }

  /// The next own step, from the end of the last one.
  template <class Exec, class Generator>
  void take_step(Exec const& exec, Generator const& generator) {
    double const t = end_time_;
    while (true) {
      double const dt = detail::step_within(options_.end - t, next_dt_);
      if (!(t + dt > t)) give_up(t, dt);  // t + dt rounds to t
      this->history_.rescale(dt / dt_);
      this->contraction_ *= std::max(1.0, dt / dt_);
      dt_ = dt;
      if (dt > 1.5 * local_dt_) measure_local(exec, generator, t);
      bool const solved = this->template solve<true>(exec, generator, now_, t, dt, &this->history_);
      double const error =
          solved ? error_of(exec, generator, t, dt) : std::numeric_limits<double>::infinity();
      if (solved && controller_.accepts(error)) return accept(error);
      ++rejected_;
      next_dt_ = solved ? controller_.next_dt(dt, error) : 0.5 * dt;
      if (!(next_dt_ >= detail::least_step(options_, t)) || next_dt_ == 0) give_up(t, next_dt_);
    }
  }

  void accept(double error) {
    this->extrapolated_ = error < hardly_changes * controller_.step_tolerance() ? 1 : 3;
    double const growth = std::clamp(fast_enough / this->contraction_, 0.9, most_growth);
    next_dt_ = std::max(options_.min_dt, std::min(controller_.next_dt(dt_, error), growth * dt_));
    this->history_.remember(this->x_);
    swap(this->start_, now_);
    swap(now_, this->end_);
    end_time_ += dt_;
    ++accepted_;
  }

  /// Of a step that has been solved: an angle. 0 for the first two, which are short, or at rest.
  template <class Exec, class Generator>
  double error_of(Exec const& exec, Generator const& generator, double t, double dt) {
    // The middles of steps may miss what a field does between them.
    bool const looks_at_end = !detail::is_stationary(generator, exec, now_);
    if (!looks_at_end && this->history_.known() < 2) return 0;
    auto kernel = this->history_.second_difference(this->x_[0], looks_at_end);
    kernel.stage = this->stage_[0].array();
    kernel.difference = this->part_of_residual(0);
    if (looks_at_end)
      with_end(exec, generator, t + dt, kernel);
    else
      detail::for_each_site<Real>(exec, difference_label_, this->residual_.layout(), kernel);
    std::complex<double> const step(dt * this->exchange_.damping, -dt * this->exchange_.precession);
    this->solver_.solve(exec, 0.5 * step, this->residual_, this->stage_[0], this->solution_[0],
                        false);
    double const square = detail::reduce_sites<detail::Maximum, 1>(
        exec, error_label_, this->residual_.layout(),
        detail::LargestSolution<Real>{this->solution_[0].array(), this->stage_[0].array()})[0];
    return dt * std::sqrt(square) / 6;
  }

  template <class Exec, class Generator>
  void with_end(Exec const& exec, Generator const& generator, double t,
                detail::SecondDifference<Real> const& kernel) {
    auto prepared = detail::prepare_term(generator, exec, this->end_, t);
    detail::for_each_site<Real>(exec, difference_label_, this->residual_.layout(),
                                detail::SecondDifferenceWithEnd<decltype(prepared), Real>{
                                    std::move(prepared), kernel, this->end_.array()});
    ++this->evaluations_done_;
  }

  template <class Exec, class Generator>
  void measure_local(Exec const& exec, Generator const& generator, double t) {
    auto prepared = detail::prepare_term(generator, exec, now_, t);
    double const sum = detail::reduce_sites<detail::Sum, 1>(
        exec, local_label_, now_.layout(),
        detail::SumAlongSpins<decltype(prepared), Real>{std::move(prepared), now_.array()})[0];
    ++this->evaluations_done_;
    this->local_ =
        std::max(0.0, this->exchange_.precession * sum / static_cast<double>(now_.sites()));
    local_dt_ = dt_;
  }

  template <class Exec>
  void deliver(Exec const& exec, Spins const& spins, double t) const {
    double const share = 1 - (end_time_ - t) / dt_;
    if (share >= 1 - 1e-9) {
      Kokkos::deep_copy(exec, spins.allocation(), now_.allocation());
      return;
    }
    auto kernel = this->history_.dense_output(dt_, share);
    kernel.begin = this->start_.array();
    kernel.out = spins.output(false);
    detail::for_each_site<Real>(exec, dense_label_, spins.layout(), kernel);
  }

  [[noreturn]] void give_up(double t, double dt) {
    detail::throw_step_too_small(this->label(""), t, dt);
  }

  std::string local_label_ = this->label("::local_field"),
              difference_label_ = this->label("::difference"),
              error_label_ = this->label("::error"), dense_label_ = this->label("::dense_output");
  StepOptions options_;
  detail::StepController controller_;
  Spins now_;
  double end_time_ = 0, dt_ = 0, next_dt_ = 0;  // the last own step ends there
  double local_dt_ = 0;                         // when local_ was measured
  std::int64_t accepted_ = 0, rejected_ = 0;
  bool running_ = false;
};

}  // namespace cayspin::inline v0_1
