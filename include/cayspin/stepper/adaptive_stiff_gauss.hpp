// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/scalars.hpp>
#include <cayspin/stepper/step_control.hpp>
#include <cayspin/stepper/stiff_gauss.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <utility>

namespace cayspin::inline v0_2 {

/// StiffGauss2 with adaptive steps, which become long as spins approach equilibrium. The error of a
/// step is an angle, the largest over all spins: dt^3 / 12 times the third derivative of a spin,
/// which is the error for a spin that precesses. The third derivative is estimated by a divided
/// difference of the changes of the spins over three steps. This divided difference is multiplied
/// by (1 + b * K)^-1 (see StiffGauss), which suppresses what is left of spin waves that are too
/// short for dt. If the generator is not stationary, the rate at the end of the step replaces the
/// earliest of the three changes. Corrections use K + c in place of K, where c is the mean of A.m
/// over the sites, but at least 0, and 0 without precession.
///
/// `step(.., t, dt)` takes internal steps until they reach t + dt, and computes the spins at t +
/// dt; within an internal step A is interpolated linearly. The internal steps do not depend on dt,
/// except that dt is the default first step if no spin turns at the start. The stepper remembers
/// its state: `spins` and t must be those at the end of the previous call of `step`. Otherwise call
/// `reset` first.
template <class Spins>
class AdaptiveStiffGauss2 : public StiffGauss<Spins, 2>, public detail::OwnSteps {
  using Base = StiffGauss<Spins, 2>;

 public:
  using typename Base::Real;
  static constexpr int work_fields = Base::work_fields + 2;

  /// Throws std::invalid_argument for invalid options, for example a tolerance below 32 times the
  /// epsilon of the precision, and for a lattice with replicas.
  explicit AdaptiveStiffGauss2(Spins const& like, StepOptions const& options = {})
      : Base(name, like, {}),
        OwnSteps(options, Base::order + 1, StepOptions::least_tolerance<Real>(),
                 std::string("cayspin::") + name),
        now_(std::string(name) + "::now", like.lattice()),
        before_(std::string(name) + "::before", like.lattice()) {
    this->solving_.tolerance =
        std::max(share_of_corrections * controller_.step_tolerance(), 16 * Base::epsilon);
    this->solving_.iterations = 10;
  }

  /// Forgets the run so far: the next step starts from the t and spins that it is given.
  void reset() {
    Base::reset();
    OwnSteps::reset();
  }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    Base::visit_memory(visit);
    if (!visit_steps(visit)) return;
    this->history_.visit_times(visit);
    visit("local", this->local_);
    visit("local_dt", local_dt_);
    visit("extrapolated", this->extrapolated_);
    visit("begin_spins", this->start_);
    visit("end_spins", now_);
    visit("spins_before", before_);
  }

  /// Advances `spins` from t to t + dt under `generator`. Waits for each internal step. Throws
  /// StepTooSmall when no step is small enough, and std::invalid_argument like StiffGauss, when dt
  /// is negative, or when options.end is before t + dt.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    step_towards(exec, generator, spins, t, dt, t + dt);
  }

  /// Like `step`, but changes `spins` only if the internal steps, which continue until they reach t
  /// + dt, also reach `wanted`, a time at or after t + dt. `spins` are then those at `wanted`.
  /// Throws like `step`.
  template <class Exec, class Generator>
  void step_towards(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt,
                    double wanted) {
    auto const region = this->begin_step(exec, spins);
    for (Spins const* own : {&now_, &before_}) this->require_other_memory(spins, *own);
    go_on_to(
        t, dt, [&](double from) { begin(exec, generator, is_running() ? now_ : spins, from, dt); },
        [&] { take_step(exec, generator); });
    if (has_reached(wanted, dt)) deliver(exec, spins, wanted);
  }

 private:
  static constexpr auto name = "AdaptiveStiffGauss2";
  static constexpr double share_of_corrections =
      0.05;                                 // (error that corrections may leave) / (step tolerance)
  static constexpr double most_growth = 2;  // largest (next dt) / dt at which extrapolation works
  static constexpr double fast_enough = 0.4;  // desired convergence factor of corrections
  // If (error of a step) / (step tolerance) is below this, the first estimate in the next step is A
  // at the stage of the last step, without extrapolation.
  static constexpr double hardly_changes = 0.1;

  template <class Exec, class Generator>
  void begin(Exec const& exec, Generator const& generator, Spins const& spins, double t,
             double asked) {
    this->make_ready(exec, generator, spins, t);
    this->history_.forget();
    Kokkos::deep_copy(exec, now_.allocation(), spins.allocation());
    ++this->evaluations_done_;
    begin_run(t, largest_rate(exec, generator, now_, t), asked);
    dt_ = next_dt_;
    local_dt_ = 0;
  }

  /// Takes the next internal step.
  template <class Exec, class Generator>
  void take_step(Exec const& exec, Generator const& generator) {
    double error = 0;
    take_own_step([&](double t, double dt) -> Try {
      this->history_.rescale(dt / dt_);
      this->contraction_ *= std::max(1.0, dt / dt_);
      dt_ = dt;
      if (dt > 1.5 * local_dt_) measure_local(exec, generator, t);
      if (!this->template solve<true>(exec, generator, now_, t, dt, &this->history_))
        return {.is_solved = false};
      error = error_of(exec, generator, t, dt);
      return {error, std::clamp(fast_enough / this->contraction_, 0.9, most_growth)};
    });
    this->extrapolated_ = error < hardly_changes * controller_.step_tolerance() ? 1 : 3;
    this->history_.remember(this->x_);
    swap(before_, this->start_);
    swap(this->start_, now_);
    swap(now_, this->end_);
  }

  /// Returns the error of a solved step, an angle. If the generator is stationary, the error is
  /// taken as 0 in the first two steps, which are short or start at equilibrium.
  template <class Exec, class Generator>
  double error_of(Exec const& exec, Generator const& generator, double t, double dt) {
    // The midpoint of a step may miss changes of the field with time, so the rate at the end of the
    // step is used, too.
    bool const looks_at_end = !detail::is_stationary(generator, exec, now_);
    if (!looks_at_end && this->history_.known() < 2) return 0;
    auto const weights = this->history_.second_difference(looks_at_end);
    detail::SecondDifference<Real> kernel{};
    kernel.spins[0] = this->end_.array();
    kernel.spins[1] = kernel.spins[2] = kernel.spins[3] = now_.array();
    if (this->history_.known() > 0) kernel.spins[2] = this->start_.array();
    if (this->history_.known() > 1) kernel.spins[3] = before_.array();
    for (std::size_t i = 0; i < 3; ++i) kernel.weights[i] = weights[i];
    kernel.stage = this->stage_[0].array();
    kernel.difference = this->part_of_residual(0);
    if (looks_at_end)
      with_end(exec, generator, t, dt, kernel);
    else
      detail::for_each_site<Real>(exec, difference_label_, this->residual_.layout(), kernel);
    std::complex<double> const step(dt * this->exchange_.damping, -dt * this->exchange_.precession);
    this->solver_.solve(exec, 0.5 * step, this->residual_, this->stage_[0], this->solution_[0]);
    double const square = detail::reduce_sites<detail::Maximum, 1>(
        exec, error_label_, this->residual_.layout(),
        detail::LargestSolution<Real>{this->solution_[0].array(), this->stage_[0].array()})[0];
    return std::sqrt(square) / 6;
  }

  template <class Exec, class Generator>
  void with_end(Exec const& exec, Generator const& generator, double t, double dt,
                detail::SecondDifference<Real> const& kernel) {
    auto prepared = detail::prepare_term(generator, exec, this->end_, t + dt);
    detail::for_each_site<Real>(
        exec, difference_label_, this->residual_.layout(),
        detail::SecondDifferenceWithEnd<decltype(prepared), Real>{
            std::move(prepared), kernel, this->end_.array(), dt * kernel.weights[2]});
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
    double const share = end_time_ > t ? 1 - (end_time_ - t) / dt_ : 1;
    if (share >= 1 - 1e-9) {
      Kokkos::deep_copy(exec, spins.allocation(), now_.allocation());
      return;
    }
    auto kernel = this->history_.dense_output(dt_, share);
    kernel.begin = this->start_.array();
    kernel.out = spins.output(false);
    detail::for_each_site<Real>(exec, dense_label_, spins.layout(), kernel);
  }

  std::string local_label_ = this->label("::local_field"),
              difference_label_ = this->label("::difference"),
              error_label_ = this->label("::error"), dense_label_ = this->label("::dense_output");
  Spins now_, before_;   // at the end of the last step, and at the start of the second-to-last
  double local_dt_ = 0;  // dt when local_ was measured
};

}  // namespace cayspin::inline v0_2
