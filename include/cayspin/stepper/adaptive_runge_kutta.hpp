// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/batch.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/detail/text.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stage/pass.hpp>
#include <cayspin/stage/update.hpp>
#include <cayspin/stepper/adaptive_memory.hpp>
#include <cayspin/stepper/adaptive_stage.hpp>
#include <cayspin/stepper/staged_stepper.hpp>
#include <cayspin/stepper/step_control.hpp>
#include <cayspin/stepper/tableau.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {
template <class Spins, class Embedded, class Update, class Isotropy>
using AdaptiveStages = StagedStepper<Spins, tableau::FirstSameAsLast<Embedded>, Update, Isotropy,
                                     AdaptiveMemory<Spins, tableau::FirstSameAsLast<Embedded>>>;
}  // namespace detail

/// An embedded Runge-Kutta method that chooses its own steps, called internal steps. The error of
/// an internal step is an angle: the largest, over all spins, between the spin at the end of the
/// step and the embedded solution for that spin. This error is kept below a fraction of the
/// tolerance, because the tolerance is meant for the error of a whole run.
///
/// `step(.., t, dt)` takes internal steps until they reach t + dt, and computes the spins at that
/// time by the tableau's dense output, a polynomial in time for the coordinates by which the update
/// moves spins. The internal steps do not depend on dt, except that dt is the default first step if
/// no spin turns at the start. The stepper remembers its state: `spins` and t must be those at the
/// end of the previous call of `step`. Otherwise call `reset` first.
template <class Spins, class Embedded, class Update, class Isotropy = isotropy::Zero>
class AdaptiveRungeKutta : public detail::AdaptiveStages<Spins, Embedded, Update, Isotropy>,
                           public detail::OwnSteps {
  using Base = detail::AdaptiveStages<Spins, Embedded, Update, Isotropy>;
  using Tableau = tableau::FirstSameAsLast<Embedded>;

 public:
  using typename Base::Real;
  static constexpr int order = Embedded::order;

  /// Throws std::invalid_argument for invalid options, for example a tolerance below 32 times the
  /// epsilon of the precision.
  AdaptiveRungeKutta(std::string const& name, Spins const& like, StepOptions const& options,
                     Isotropy isotropy = {})
      : Base(name, like, isotropy, {name, like.lattice()}),
        OwnSteps(options, Embedded::embedded_order + 1, StepOptions::least_tolerance<Real>(),
                 "cayspin::" + name) {}

  /// Returns the number of generator evaluations so far.
  std::int64_t evaluations_done() const { return evaluations_done_; }

  /// Visits the last internal step and the step size control, for cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("evaluations", evaluations_done_);
    if (!visit_steps(visit)) return;
    visit("begin_time", begin_time_);
    memory_.visit(visit);
  }

  /// Advances `spins` from t to t + dt under `generator`. Waits for each internal step. Throws
  /// StepTooSmall when no step is small enough, and std::invalid_argument when `spins` is not on
  /// the lattice given at construction, dt is negative or options.end is before t + dt.
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
    go_on_to(
        t, dt,
        [&](double from) { begin(exec, generator, is_running() ? memory_.end : spins, from, dt); },
        [&] { take_step(exec, generator, wanted); });
    if (!has_reached(wanted, dt)) return;
    // An earlier call wanted a later time, so the last step left out its increments: take it again.
    if (!has_increments_ && ends_beyond(wanted, end_time_, dt_)) {
      try_step(exec, generator, begin_time_, dt_, begin_time_);
      detail::update_ghosts(exec, this->lattice_, memory_.end, memory_.last);
    }
    deliver(exec, spins, wanted);
  }

 private:
  using Base::stages, Base::labels_, Base::isotropy_, Base::memory_;
  static constexpr std::make_integer_sequence<int, stages - 2> stages_between{};

  template <class Exec, class Generator>
  void begin(Exec const& exec, Generator const& generator, Spins const& spins, double t,
             double asked) {
    auto const& start = memory_.end;
    Kokkos::deep_copy(exec, start.allocation(), spins.allocation());
    auto prepared = detail::prepare_term(generator, exec, start, t);
    detail::for_each_site<Real>(exec, begin_label_, start.layout(),
                                detail::FirstGeneratorStage<Isotropy, decltype(prepared), Real>{
                                    std::move(prepared), isotropy_, start.array(),
                                    memory_.last.output(false), memory_.square.output(false)});
    // The generator may be wrong at ghosts, because a term may store its field only for this part's
    // own rows.
    detail::update_ghosts(exec, this->lattice_, memory_.last);
    ++evaluations_done_;
    begin_run(t, std::sqrt(largest_square(exec)), asked);
    begin_time_ = t;
    has_increments_ = true;  // there is no step yet, so there is none to take again
  }

  /// Takes the next internal step. `wanted`: the next time at which spins are needed.
  template <class Exec, class Generator>
  void take_step(Exec const& exec, Generator const& generator, double wanted) {
    memory_.exchange_begin_and_end();
    double const begin_time = end_time_;
    take_own_step(
        [&](double t, double dt) { return Try{try_step(exec, generator, t, dt, wanted)}; });
    begin_time_ = begin_time;
    detail::update_ghosts(exec, this->lattice_, memory_.end, memory_.last);
  }

  /// Attempts a step, and returns its error, an angle.
  template <class Exec, class Generator>
  double try_step(Exec const& exec, Generator const& generator, double t, double dt,
                  double wanted) {
    evaluations_done_ += stages - 1;
    has_increments_ = true;
    bool at_once = false;
    if constexpr (detail::is_host_execution<Exec>) {
      bool const by_time = detail::stages_need_only_time<Isotropy>(generator, exec, memory_.begin);
      if (this->path() == Path::sweep && !by_time) this->use(Path::pass);
      if constexpr (Base::Sweeps::possible) {
        if (this->path() == Path::sweep) {
          has_increments_ = ends_beyond(wanted, t + dt, dt);
          sweep(exec, generator, t, dt, has_increments_);
          return error(exec);
        }
      }
      at_once = by_time && detail::runs_on_calling_thread<Exec>(memory_.begin.sites());
      if (at_once) stages_at_once(exec, generator, t, dt);
    }
    if (!at_once) stages_from<0>(exec, generator, t, dt);
    return error(exec);
  }

  /// Returns true if a step of dt that ends at `end` passes the time `wanted` by more than
  /// round-off. The spins at `wanted` are then interpolated from the increments of this step.
  static bool ends_beyond(double wanted, double end, double dt) { return end - wanted > 1e-9 * dt; }

  template <class Exec>
  double error(Exec const& exec) const {
    return 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(largest_square(exec))));
  }

  /// Returns the kernel of a stage that evaluates the prepared generator. The kernel of the first
  /// stage, from first_stage(), loads the generator's values instead: they are known already.
  template <int Stage, class Prepared>
  auto stage(Prepared prepared, double dt) const {
    return detail::RungeKuttaStage<Tableau, Update, Isotropy, Stage, Prepared, Real>{
        std::move(prepared), isotropy_, static_cast<Real>(dt)};
  }
  auto first_stage(double dt) const {
    using Known = detail::KnownGenerator<Real>;
    return detail::RungeKuttaStage<Tableau, Update, isotropy::Zero, 0, Known, Real>{
        {memory_.first.array()}, {}, static_cast<Real>(dt)};
  }
  template <class Prepared>
  auto end_stage(Prepared prepared, double dt,
                 detail::EndOutputs<Tableau, Real> const& outputs) const {
    return detail::EndStage<Tableau, Update, Isotropy, Prepared, Real>{
        std::move(prepared), isotropy_, outputs, static_cast<Real>(dt)};
  }
  /// Calls run(kernel..) with the kernels of all stages. All of them are prepared before the first
  /// stage runs, so the preparation must need only the time, not the spins.
  template <class Exec, class Generator, class Run>
  void with_kernels(Exec const& exec, Generator const& generator, double t, double dt,
                    detail::EndOutputs<Tableau, Real> const& outputs, Run const& run) const {
    auto const at = [&](double c) {
      return detail::prepare_stage<Isotropy>(generator, exec, memory_.begin, t + c * dt);
    };
    [&]<int... I>(std::integer_sequence<int, I...>) {
      run(first_stage(dt), stage<I + 1>(at(Tableau::c[I + 1]), dt)...,
          end_stage(at(1), dt, outputs));
    }(stages_between);
  }
  template <class Kernel>
  auto fields() const {
    return memory_.template arrays<typename Kernel::Flow>();
  }

  template <class Exec, class Generator>
  void sweep(Exec const& exec, Generator const& generator, double t, double dt,
             bool keeps_increments) const {
    with_kernels(exec, generator, t, dt, memory_.outputs_of_sweep(keeps_increments),
                 [&]<class... Kernel>(Kernel const&... kernel) {
                   this->sweep_through(exec, memory_.begin, std::tuple(kernel...));
                 });
  }

  // Runs all stages in one launch, for few spins.
  template <class Exec, class Generator>
  void stages_at_once(Exec const& exec, Generator const& generator, double t, double dt) const {
    with_kernels(exec, generator, t, dt, memory_.outputs_of_pass(),
                 [&]<class... Kernel>(Kernel const&... kernel) {
                   detail::repeat_on_calling_thread(
                       step_label_, 1,
                       std::tuple(detail::StageRowLoop(kernel, fields<Kernel>(),
                                                       memory_.begin.layout())...));
                 });
  }

  template <int Stage, class Exec, class Generator>
  void stages_from(Exec const& exec, Generator const& generator, double t, double dt) const {
    auto const run = [&]<class Kernel>(std::string const& label, Kernel const& kernel) {
      detail::run_pass(exec, label, memory_.begin.layout(), kernel, fields<Kernel>());
    };
    auto const prepared = [&] {
      return detail::prepare_stage<Isotropy>(generator, exec, memory_.level_of(Stage),
                                             t + Tableau::c[Stage] * dt);
    };
    if constexpr (Stage == 0)
      run(labels_[Stage], first_stage(dt));
    else if constexpr (Stage + 1 < stages)
      run(labels_[Stage], stage<Stage>(prepared(), dt));
    else
      run(end_label_, end_stage(prepared(), dt, memory_.outputs_of_pass()));
    if constexpr (Stage + 1 < stages) stages_from<Stage + 1>(exec, generator, t, dt);
  }

  template <class Exec>
  void deliver(Exec const& exec, Spins const& spins, double t) const {
    double const fraction = end_time_ > begin_time_ ? (t - begin_time_) / dt_ : 1;
    if (!ends_beyond(t, end_time_, dt_) || fraction >= 1) {
      Kokkos::deep_copy(exec, spins.allocation(), memory_.end.allocation());
      return;
    }
    detail::DenseOutput<Tableau, Update, Real> look{memory_.begin.array(), memory_.end.array(),
                                                    memory_.last.array(),  memory_.all_increments(),
                                                    spins.output(false),   static_cast<Real>(dt_)};
    look.set_fraction(fraction);
    detail::for_each_site<Real>(exec, dense_label_, spins.layout(), look);
    detail::update_ghosts(exec, this->lattice_, spins);
  }

  template <class Exec>
  double largest_square(Exec const& exec) const {
    return detail::reduce_sites<detail::Maximum, 1>(
        exec, error_label_, memory_.square.layout(),
        detail::LargestOfSites<Real>{memory_.square.array()})[0];
  }

  std::string begin_label_ = this->label("::begin"), end_label_ = this->label("::end"),
              dense_label_ = this->label("::dense_output"), error_label_ = this->label("::error"),
              step_label_ = this->label("::all_stages");
  double begin_time_ = 0;       // start of the last internal step
  bool has_increments_ = true;  // of the last internal step; a sweep stores them only if needed
  std::int64_t evaluations_done_ = 0;
};

/// Adaptive Runge-Kutta-Munthe-Kaas: the embedded tableau is applied to coordinates in the Lie
/// algebra. The first increment of a step is dt times the generator at the end of the previous
/// step, because the inverse differential at 0 is the identity.
template <class Spins, class Embedded = tableau::Tsitouras5, class Isotropy = isotropy::Zero,
          class Rotation = Cayley>
class AdaptiveRkmk : public AdaptiveRungeKutta<Spins, Embedded, update::Lie<Rotation>, Isotropy> {
 public:
  explicit AdaptiveRkmk(Spins const& like, StepOptions const& options = {}, Isotropy isotropy = {},
                        Rotation = {})
      : AdaptiveRkmk::AdaptiveRungeKutta("AdaptiveRkmk", like, options, isotropy) {}
};

/// Adaptive Runge-Kutta in stereographic coordinates. The chart of each spin is centred at its
/// direction at the start of the internal step (update::Stereographic).
template <class Spins, class Embedded = tableau::Tsitouras5>
class AdaptiveStereographic : public AdaptiveRungeKutta<Spins, Embedded, update::Stereographic> {
 public:
  explicit AdaptiveStereographic(Spins const& like, StepOptions const& options = {})
      : AdaptiveStereographic::AdaptiveRungeKutta("AdaptiveStereographic", like, options) {}
};

/// Baseline for comparison: adaptive Runge-Kutta in Cartesian components. At the end of each
/// internal step, each spin is divided by its length.
template <class Spins, class Embedded = tableau::DormandPrince5>
class AdaptiveProjected : public AdaptiveRungeKutta<Spins, Embedded, update::Projected> {
 public:
  explicit AdaptiveProjected(Spins const& like, StepOptions const& options = {})
      : AdaptiveProjected::AdaptiveRungeKutta("AdaptiveProjected", like, options) {}
};

}  // namespace cayspin::inline v0_2
