// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/field/multirate_weights.hpp>
#include <cayspin/field/slow_field.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stepper/field_history.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

/// Options of Multirate.
struct MultirateOptions {
  std::int64_t substeps = 1;  ///< steps of the inner method in each step
};

/// A stepper that divides each step into substeps of a one-step method. One expensive term of the
/// field (SlowField) is evaluated only once per step: during the substeps it is interpolated in
/// time. The order is Order, or that of the method if it is lower.
///
/// A step has two passes through its substeps. In the first, the expensive field is extrapolated
/// from its last values; at the end of this pass it is evaluated. The second pass repeats the
/// substeps from the start of the step, with the field interpolated through the new value and the
/// last ones. The new value is kept for the next step. Without the second pass, feedback through
/// the field amplifies short waves at any dt.
///
/// Orders 2 and 3 interpolate by the polynomials through the last Order - 1 values (first pass) and
/// Order values (second pass). Order 4 uses polynomials chosen for stability
/// (multirate_weights.hpp), from 4 and 5 values. In its first steps and after unequal steps it
/// interpolates at most 3 and 4 values instead. Consider a mode that precesses on a circle, with
/// the angular frequency w, because of the expensive field only. In each step its amplitude changes
/// by a small fraction of its value. With x = w * dt, it grows by about x^4 / 4 at order 2, falls
/// by about 3/8 * x^4 at order 3, and falls by about x^6 at order 4.
///
/// Let D be the largest eigenvalue of the linear map from the spins to the expensive field. At
/// order 4, no linear mode grew up to dt * D = 0.05, 0.24, 0.35, 0.5 at damping 0.002, 0.008, 0.02,
/// 0.1. At order 3 these limits are 0.02, 0.08, 0.14, 0.4. Without damping, short waves gain energy
/// slowly.
///
/// The first step evaluates the expensive field in each stage of its substeps. Steps may change
/// their length, but a step that is more than twice as long as the last one, or has the opposite
/// sign, is a first step again. Work memory in addition to that of the method: past_fields + 1
/// fields, and the field in SlowField. This is a predictor-corrector form of the multirate methods
/// of Gear and Wells (BIT 24, 1984).
template <class Stepper, class SlowTerm, int Order = 4>
class Multirate : public detail::StepperBase<typename Stepper::spins_type> {
  using Base = detail::StepperBase<typename Stepper::spins_type>;
  static_assert(2 <= Order && Order <= 4, "Multirate interpolates to order 2, 3 or 4.");
  static_assert(
      !requires(Stepper& inner) { inner.reset(); },
      "Multirate needs a method that remembers no steps: neither a multistep, an adaptive nor a "
      "compensated one.");

 public:
  using Spins = typename Stepper::spins_type;
  using typename Base::Real;
  static_assert(std::is_same_v<Spins, typename SlowTerm::spins_type>,
                "Multirate's method and its expensive field were made for different spins.");
  static constexpr int order = std::min(Order, Stepper::order);
  static constexpr std::size_t past_fields = Order < 4 ? Order : detail::most_multirate_values;
  static constexpr int work_fields = static_cast<int>(past_fields) + 2 + Stepper::work_fields;
  static constexpr int ghosts = detail::ghosts_of<Stepper>;

  /// `slow`: the SlowField that the generator's field contains. Throws std::invalid_argument when
  /// the number of substeps is below 1, or `slow` was made for another lattice.
  Multirate(Spins const& like, Stepper stepper, SlowTerm slow, MultirateOptions const& options = {})
      : Base("Multirate", like.lattice(), ghosts),
        stepper_(std::move(stepper)),
        slow_(std::move(slow)),
        substeps_(options.substeps),
        begin_("Multirate::begin", like.lattice()),
        past_("Multirate::slow_field", like.lattice()) {
    if (substeps_ < 1)
      throw std::invalid_argument("cayspin::Multirate: the number of substeps is below 1");
    slow_.check_spins(like);
  }

  /// Returns the number of generator evaluations by the inner method so far.
  std::int64_t evaluations_done() const { return evaluations_done_; }
  /// Returns how often steps have evaluated the expensive field so far: once per step. A first step
  /// also evaluates it at its start and in each stage of its substeps.
  std::int64_t slow_evaluations_done() const { return slow_evaluations_done_; }
  std::size_t work_bytes() const {
    return stepper_.work_bytes() + (past_fields + 2) * begin_.bytes();
  }

  /// Forgets the previous steps, so that the next step is a first step. Call this after changing
  /// the spins or the generator. cayspin::integrate calls it at the start of each run that does not
  /// continue the previous one.
  void reset() {
    past_.forget();
    knows_begin_ = false;
  }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    past_.visit_memory(visit);
    visit("knows_begin", knows_begin_);
    if (knows_begin_) visit("begin", past_.following());
    visit("evaluations", evaluations_done_);
    visit("slow_evaluations", slow_evaluations_done_);
  }

  /// Visits the fields whose memory a step may swap with that of the spins, for cayspin::integrate.
  template <class Visit>
  void visit_exchanged(Visit const& visit)
    requires requires(Stepper& inner) { inner.visit_exchanged(visit); }
  {
    stepper_.visit_exchanged(visit);
  }

  /// Advances `spins` from t to t + dt under `generator`. `spins` must be those at the end of the
  /// previous step. A step may swap the memory of `spins` with that of the inner method. If a term
  /// of the field throws, `spins` are those before the step, and the next step is a first step.
  /// Throws std::invalid_argument when `spins` is not on the lattice given at construction and,
  /// except in a first step, when the generator's field does not contain the SlowField.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    if (dt == 0) return;
    auto const evaluations_before = slow_.evaluations_done();
    if (knows_begin_ && !past_.is_followed_by(dt)) reset();
    Kokkos::deep_copy(exec, begin_.allocation(), spins.allocation());
    try {
      if (knows_begin_)
        go_on(exec, generator, spins, t, dt);
      else
        start(exec, generator, spins, t, dt);
    } catch (...) {
      Kokkos::deep_copy(exec, spins.allocation(), begin_.allocation());
      reset();
      throw;
    }
    slow_evaluations_done_ += slow_.evaluations_done() - evaluations_before;
  }

 private:
  template <class Exec, class Generator>
  void start(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    past_.forget();
    slow_.evaluate(exec, spins, t, past_.following());
    past_.remember(dt);
    take_substeps(exec, generator, spins, t, dt);
    slow_.evaluate(exec, spins, t + dt, past_.following());
    knows_begin_ = true;
  }

  template <class Exec, class Generator>
  void go_on(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    past_.remember(dt);
    // The value at the end of the step is unknown in the first pass, which therefore leaves out
    // entry 0 of nodes and values.
    auto nodes = past_.times(dt);
    std::array<Spins, past_fields> values;
    std::size_t known = std::min(past_.known(), past_fields - 1);
    for (std::size_t i = 0; i <= known; ++i) {
      nodes[i] += 1;
      values[i] = i == 0 ? past_.following() : past_[i - 1];
    }
    typename SlowTerm::Weights predict = detail::interpolating_weights, correct = predict;
    if constexpr (Order == 4) {
      if (known == past_fields - 1 && are_equal_steps(nodes)) {
        predict = detail::damping_predictor;
        correct = detail::damping_corrector;
      } else {
        known = std::min(known, std::size_t{3});
      }
    }
    take_substeps_between(exec, generator, spins, t, dt, {values.data() + 1, known},
                          {nodes.data() + 1, known}, predict);
    slow_.evaluate(exec, spins, t + dt, past_.following());
    Kokkos::deep_copy(exec, spins.allocation(), begin_.allocation());
    take_substeps_between(exec, generator, spins, t, dt, {values.data(), known + 1},
                          {nodes.data(), known + 1}, correct);
  }

  /// Returns true if the nodes are 1, 0, -1, ..: all steps between them have the same length.
  static bool are_equal_steps(std::array<double, past_fields> const& nodes) {
    for (std::size_t i = 0; i < past_fields; ++i)
      if (std::abs(nodes[i] - (1 - static_cast<double>(i))) > 1e-9) return false;
    return true;
  }

  /// Takes the substeps with the expensive field interpolated from these values.
  template <class Exec, class Generator>
  void take_substeps_between(Exec const& exec, Generator const& generator, Spins& spins, double t,
                             double dt, std::span<Spins const> values,
                             std::span<double const> nodes, typename SlowTerm::Weights weights) {
    typename SlowTerm::Interpolated const interpolated(slow_, values, nodes, t, dt, weights);
    take_substeps(exec, generator, spins, t, dt);
    if (!interpolated.was_read())
      throw std::invalid_argument(
          this->label("::step: the generator's field does not have the expensive term that this "
                      "stepper was made with"));
  }

  template <class Exec, class Generator>
  void take_substeps(Exec const& exec, Generator const& generator, Spins& spins, double t,
                     double dt) {
    double const substep = dt / static_cast<double>(substeps_);
    std::int64_t before = 0;
    if constexpr (detail::counts_evaluations<Stepper>) before = stepper_.evaluations_done();
    if constexpr (requires { stepper_.batch(exec, generator, spins, t, substep, substeps_); }) {
      if (stepper_.takes_batches(exec, generator, spins))
        stepper_.batch(exec, generator, spins, t, substep, substeps_);
      else
        take_one_by_one(exec, generator, spins, t, substep);
    } else {
      take_one_by_one(exec, generator, spins, t, substep);
    }
    if constexpr (detail::counts_evaluations<Stepper>)
      evaluations_done_ += stepper_.evaluations_done() - before;
    else
      evaluations_done_ += substeps_ * Stepper::evaluations;
  }
  template <class Exec, class Generator>
  void take_one_by_one(Exec const& exec, Generator const& generator, Spins& spins, double t,
                       double substep) {
    for (std::int64_t k = 0; k < substeps_; ++k)
      stepper_.step(exec, generator, spins, t + static_cast<double>(k) * substep, substep);
  }

  Stepper stepper_;
  SlowTerm slow_;
  std::int64_t substeps_;
  Spins begin_;  // the spins at the start of a step
  detail::FieldHistory<Spins, past_fields> past_;
  // If true, past_.following() is the expensive field at the start of the next step.
  bool knows_begin_ = false;
  std::int64_t evaluations_done_ = 0, slow_evaluations_done_ = 0;
};

}  // namespace cayspin::inline v0_2
