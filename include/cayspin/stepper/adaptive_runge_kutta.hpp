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
#include <cayspin/stepper/adaptive_stage.hpp>
#include <cayspin/stepper/step_control.hpp>
#include <cayspin/stepper/stepper_base.hpp>
#include <cayspin/stepper/tableau.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

namespace cayspin {

/// An embedded Runge-Kutta method that chooses its own steps. The error of a step is the largest
/// angle of any spin between the two solutions, and is kept below the tolerance.
/// `step(.., t, dt)` returns the spins at t + dt, by the tableau's polynomial in the coordinates of
/// the group. The method's own steps do not depend on dt. It remembers its state: `spins` and t
/// must be those at the end of the step before. Otherwise call `reset`.
template <class Spins, class Embedded, class Update, class Isotropy = isotropy::Zero>
class AdaptiveRungeKutta : public detail::StepperBase<Spins> {
  using Base = detail::StepperBase<Spins>;
  using Tableau = tableau::FirstSameAsLast<Embedded>;
  static constexpr int stages = Tableau::stages;

 public:
  using typename Base::Real;
  static constexpr int order = Embedded::order;
  static constexpr int ghosts = Tableau::stages;
  static constexpr int work_fields = stages + 4;  // and a number per site

  /// Throws std::invalid_argument for invalid options, for example a tolerance below 32 epsilon of
  /// the precision.
  AdaptiveRungeKutta(std::string const& name, Spins const& like, StepOptions const& options,
                     Isotropy isotropy = {})
      : Base(name, like.lattice(), ghosts),
        isotropy_(isotropy),
        options_(options),
        controller_(options, Embedded::embedded_order + 1, StepOptions::least_tolerance<Real>(),
                    "cayspin::" + name),
        begin_(name + "::begin", like.lattice()),
        end_(name + "::end", like.lattice()),
        level_(name + "::level", like.lattice()),
        first_(name + "::first_generator", like.lattice()),
        last_(name + "::last_generator", like.lattice()),
        increments_(detail::numbered_fields<Spins, std::size_t{stages - 1}>(name + "::increment",
                                                                            like.lattice())),
        square_(name + "::squared_error", like.lattice()) {
    streaming_ = detail::exceeds_caches<DefaultExec>(like.bytes() + work_bytes());
  }

  std::size_t work_bytes() const { return work_fields * begin_.bytes() + square_.bytes(); }
  /// Predicted bytes of work memory.
  static std::size_t work_bytes(Lattice const& lattice, bool, int) {
    auto const layout = detail::RowLayout::of<Real>(lattice);
    return (work_fields * layout.allocation(3) + layout.allocation(1)) * sizeof(Real);
  }

  /// Evaluations of the generator so far, and own steps accepted and rejected.
  std::int64_t evaluations_done() const { return evaluations_done_; }
  std::int64_t accepted_steps() const { return accepted_; }
  std::int64_t rejected_steps() const { return rejected_; }
  /// The dt of the next own step.
  double next_dt() const { return next_dt_; }

  /// Forgets the run so far: the next step begins at its own t and spins.
  void reset() { running_ = false; }

  /// For cayspin::exchange_memory: the own step under way, and what chooses the next one.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("evaluations", evaluations_done_);
    visit("accepted", accepted_);
    visit("rejected", rejected_);
    visit("running", running_);
    if (!running_) return;
    controller_.visit_memory(visit);
    visit("begin_time", begin_time_);
    visit("end_time", end_time_);
    visit("dt", dt_);
    visit("next_dt", next_dt_);
    visit("begin", begin_);
    visit("end", end_);
    visit("last_generator", last_);
    for (std::size_t i = 0; i < increments_.size(); ++i)
      visit("increment_" + std::to_string(i + 1), increments_[i]);
  }

  /// Brings `spins` from t to t + dt under `generator`. Waits.
  /// Throws StepTooSmall when no step is small enough, std::invalid_argument when `spins` is not of
  /// the lattice given at construction, dt is negative or options.end is before t + dt.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    double const asked = t + dt, slack = 1e-9 * std::abs(dt);
    if (!(dt >= 0) || !(asked <= options_.end + slack))
      throw std::invalid_argument(
          this->label("::step: dt must not be negative, nor t + dt beyond the end of the options"));
    if (!running_) begin(exec, generator, spins, t, dt);
    while (end_time_ < asked - slack) take_step(exec, generator);
    deliver(exec, spins, asked);
  }

 private:
  using DefaultExec = typename Spins::memory_space::execution_space;
  using Scalars = ScalarField<Real, typename Spins::memory_space>;
  using Whole = detail::WholeFields<Real>;

  template <class Exec, class Generator>
  void begin(Exec const& exec, Generator const& generator, Spins const& spins, double t,
             double asked) {
    Kokkos::deep_copy(exec, end_.allocation(), spins.allocation());
    auto prepared = detail::prepare_term(generator, exec, end_, t);
    detail::for_each_site<Real>(exec, begin_label_, end_.layout(),
                                detail::FirstGeneratorStage<Isotropy, decltype(prepared), Real>{
                                    std::move(prepared), isotropy_, end_.array(),
                                    last_.output(false), square_.output(false)});
    ++evaluations_done_;
    controller_.reset();
    next_dt_ = controller_.first_dt(std::sqrt(largest_square(exec)), asked);
    begin_time_ = end_time_ = t;
    running_ = true;
  }

  /// The next own step, from end_ at time end_time_.
  template <class Exec, class Generator>
  void take_step(Exec const& exec, Generator const& generator) {
    swap(begin_, end_);
    swap(first_, last_);
    double const t = end_time_;
    while (true) {
      double const dt = within_end(t, next_dt_);
      if (!(t + dt > t)) give_up(t, dt);  // t + dt rounds to t
      double const error = try_step(exec, generator, t, dt);
      double const on = controller_.next_dt(dt, error);
      if (controller_.accepts(error)) {
        detail::update_ghosts(exec, this->lattice_, end_, last_);
        next_dt_ = std::max(on, options_.min_dt);
        begin_time_ = t;
        end_time_ = t + dt;
        dt_ = dt;
        ++accepted_;
        return;
      }
      ++rejected_;
      next_dt_ = on;
      double const least =
          std::max(options_.min_dt, 16 * std::numeric_limits<double>::epsilon() * std::abs(t));
      if (!(on >= least) || on == 0) give_up(t, on);
    }
  }

  /// The error of a step from begin_ to end_: an angle.
  template <class Exec, class Generator>
  double try_step(Exec const& exec, Generator const& generator, double t, double dt) {
    evaluations_done_ += stages - 1;
    bool at_once = false;
    if constexpr (detail::is_host_execution<Exec>) {
      at_once = detail::runs_on_calling_thread<Exec>(begin_.sites()) &&
                detail::needs_time_alone(generator, exec, begin_);
      if (at_once) stages_at_once(exec, generator, t, dt);
    }
    if (!at_once) {
      stages_from<0>(exec, generator, t, dt);
      auto const& layout = begin_.layout();
      detail::for_each_site<Real>(
          exec, end_label_, layout,
          end_stage(detail::prepare_term(generator, exec, end_, t + dt), dt), layout.own);
    }
    return 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(largest_square(exec))));
  }

  /// The spins at which stage `stage` evaluates the generator: end_ for the last stage.
  Spins const& level(int stage) const { return (stages - 1 - stage) % 2 == 0 ? end_ : level_; }

  template <class Prepared>
  auto end_stage(Prepared prepared, double dt) const {
    return detail::EndStage<Tableau, Update, Isotropy, Prepared, Real>{
        std::move(prepared),   isotropy_,
        begin_.array(),        end_.array(),
        increments(),          last_.output(streaming_),
        square_.output(false), static_cast<Real>(dt)};
  }
  /// Stage `Stage` with a prepared generator. That of the first stage is known.
  template <int Stage, class Prepared>
  auto stage(Prepared prepared, double dt) const {
    return detail::RungeKuttaStage<Tableau, Update, Isotropy, Stage, Prepared, Real>{
        std::move(prepared), isotropy_, static_cast<Real>(dt)};
  }
  auto first_stage(double dt) const {
    using Known = detail::KnownGenerator<Real>;
    return detail::RungeKuttaStage<Tableau, Update, isotropy::Zero, 0, Known, Real>{
        {first_.array()}, {}, static_cast<Real>(dt)};
  }
  template <int Stage>
  detail::StageArrays<Whole, stages> fields() const {
    detail::StageArrays<Whole, stages> arrays;
    detail::find_arrays<detail::StageDataFlow<Tableau, Update, Stage>>(FieldsOfStep{*this}, arrays);
    return arrays;
  }
  /// Where the arrays of a stage lie.
  struct FieldsOfStep {
    AdaptiveRungeKutta const& stepper;
    auto start() const { return stepper.begin_.array(); }
    template <int Stage>
    auto level() const {
      return Stage == 0 ? stepper.begin_.array() : stepper.level(Stage).array();
    }
    template <int Stage>
    auto increment() const {
      return stepper.increments_[Stage].array();
    }
    template <int Stage>
    auto new_increment() const {
      return stepper.increments_[Stage].output(stepper.streaming_);
    }
    template <int Stage>
    auto next() const {
      return stepper.level(Stage + 1).output(stepper.streaming_);
    }
  };

  // Few spins: all stages in one launch.
  template <class Exec, class Generator>
  void stages_at_once(Exec const& exec, Generator const& generator, double t, double dt) {
    auto const at = [&](double c) {
      return detail::prepare_term(generator, exec, begin_, t + c * dt);
    };
    auto const& layout = begin_.layout();
    [&]<int... I>(std::integer_sequence<int, I...>) {
      detail::repeat_on_calling_thread(
          step_label_, 1,
          std::tuple(detail::StageRowLoop(first_stage(dt), fields<0>(), layout),
                     detail::StageRowLoop(stage<I + 1>(at(Tableau::c[I + 1]), dt), fields<I + 1>(),
                                          layout)...,
                     detail::repeated_row_loop<Real>(layout, end_stage(at(1), dt))));
    }(std::make_integer_sequence<int, stages - 2>{});
  }

  template <int Stage, class Exec, class Generator>
  void stages_from(Exec const& exec, Generator const& generator, double t, double dt) {
    auto const run = [&](auto const& kernel) {
      detail::run_pass(exec, labels_[Stage], begin_.layout(), kernel, fields<Stage>());
    };
    if constexpr (Stage == 0)
      run(first_stage(dt));
    else
      run(stage<Stage>(
          detail::prepare_term(generator, exec, level(Stage), t + Tableau::c[Stage] * dt), dt));
    if constexpr (Stage + 2 < stages) stages_from<Stage + 1>(exec, generator, t, dt);
  }

  template <class Exec>
  void deliver(Exec const& exec, Spins const& spins, double t) const {
    double const fraction = end_time_ > begin_time_ ? (t - begin_time_) / dt_ : 1;
    if (std::abs(t - end_time_) <= 1e-9 * dt_ || fraction >= 1) {
      Kokkos::deep_copy(exec, spins.allocation(), end_.allocation());
      return;
    }
    detail::DenseOutput<Tableau, Update, Real> look(begin_.array(), end_.array(), last_.array(),
                                                    increments(), spins.output(false), dt_,
                                                    fraction);
    detail::for_each_site<Real>(exec, dense_label_, begin_.layout(), look);
    detail::update_ghosts(exec, this->lattice_, spins);
  }

  template <class Exec>
  double largest_square(Exec const& exec) const {
    return detail::reduce_sites<detail::Maximum, 1>(
        exec, error_label_, square_.layout(), detail::LargestOfSites<Real>{square_.array()})[0];
  }

  detail::StepIncrements<Tableau, Real> increments() const {
    detail::StepIncrements<Tableau, Real> all;
    for (std::size_t i = 0; i < increments_.size(); ++i) all.array[i] = increments_[i].array();
    return all;
  }

  /// A step that reaches the end exactly, without a very short last step.
  double within_end(double t, double dt) const {
    double const left = options_.end - t;
    if (dt >= left * (1 - 1e-9)) return left;
    return 2 * dt > left ? 0.5 * left : dt;
  }

  [[noreturn]] void give_up(double t, double dt) {
    swap(begin_, end_);
    swap(first_, last_);
    throw StepTooSmall(this->label("::step: from t = ") + detail::to_text(t) +
                       " the tolerance needs a step below " + detail::to_text(dt) +
                       "; the numbers are not finite, or the field is not smooth");
  }

  std::string begin_label_ = this->label("::begin"), end_label_ = this->label("::end"),
              dense_label_ = this->label("::dense_output"), error_label_ = this->label("::error"),
              step_label_ = this->label("::all_stages");
  std::array<std::string, std::size_t{stages}> labels_ =
      this->template stage_labels<std::size_t{stages}>();
  Isotropy isotropy_;
  StepOptions options_;
  detail::StepController controller_;
  Spins begin_, end_, level_, first_, last_;
  std::array<Spins, std::size_t{stages - 1}> increments_;
  Scalars square_;
  bool streaming_ = false, running_ = false;
  double begin_time_ = 0, end_time_ = 0, dt_ = 0, next_dt_ = 0;
  std::int64_t evaluations_done_ = 0, accepted_ = 0, rejected_ = 0;
};

/// Adaptive Runge-Kutta-Munthe-Kaas: the embedded tableau in the Lie algebra, where the last
/// stage's generator is the next step's first increment, since D_0 = I.
template <class Spins, class Embedded = tableau::Tsitouras5, class Isotropy = isotropy::Zero,
          class Rotation = Cayley>
class AdaptiveRkmk : public AdaptiveRungeKutta<Spins, Embedded, update::Lie<Rotation>, Isotropy> {
 public:
  explicit AdaptiveRkmk(Spins const& like, StepOptions const& options = {}, Isotropy isotropy = {},
                        Rotation = {})
      : AdaptiveRkmk::AdaptiveRungeKutta("AdaptiveRkmk", like, options, isotropy) {}
};

/// Adaptive Runge-Kutta in the stereographic chart at each step's first spin.
template <class Spins, class Embedded = tableau::Tsitouras5>
class AdaptiveStereographic : public AdaptiveRungeKutta<Spins, Embedded, update::Stereographic> {
 public:
  explicit AdaptiveStereographic(Spins const& like, StepOptions const& options = {})
      : AdaptiveStereographic::AdaptiveRungeKutta("AdaptiveStereographic", like, options) {}
};

/// The adaptive baseline: steps in space, with each spin divided by its length at the end.
template <class Spins, class Embedded = tableau::DormandPrince5>
class AdaptiveProjected : public AdaptiveRungeKutta<Spins, Embedded, update::Projected> {
 public:
  explicit AdaptiveProjected(Spins const& like, StepOptions const& options = {})
      : AdaptiveProjected::AdaptiveRungeKutta("AdaptiveProjected", like, options) {}
};

}  // namespace cayspin
