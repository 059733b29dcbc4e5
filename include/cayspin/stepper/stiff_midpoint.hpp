// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/text.hpp>
#include <cayspin/solver/measured_exchange.hpp>
#include <cayspin/solver/spin_wave_solver.hpp>
#include <cayspin/stepper/implicit.hpp>
#include <cayspin/stepper/stepper_base.hpp>
#include <cayspin/stepper/stiff_history.hpp>
#include <cayspin/stepper/stiff_midpoint_stage.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace cayspin {

/// Implicit midpoint in Cayley coordinates for stiff exchange, order 2 (or 4, as five steps of
/// Suzuki's composition): m1 = cay(f) m0, f = dt A((m0 + m1) / 2). f is extrapolated from earlier
/// steps and corrected by (1 + b K)^-1 of the residual, b = (dt / 2) (damping - i): with K = -J
/// Lap, as it is measured at the first step, that is Newton's method for exchange, on lines of
/// spins that are nearly parallel. One or two evaluations a step are usual. A correction that does
/// not converge halves the step. Keeps |m| and, where the generator is conservative and H affine,
/// the energy to round-off; with isotropic exchange alone the total spin too. Any generator; not
/// for parts of a lattice.
template <class Spins, int Order>
class StiffMidpoint : public detail::StepperBase<Spins> {
  static_assert(Order == 2 || Order == 4, "StiffMidpoint has order 2 or 4.");
  using MemorySpace = typename Spins::memory_space;

 public:
  using typename detail::StepperBase<Spins>::Real;
  static constexpr int order = Order;
  static constexpr int stages = Order == 2 ? 1 : 5;
  // The grids' are of single precision.
  static constexpr int work_fields = 7 + 3 * stages + (sizeof(Real) == 8 ? 4 : 8);

  explicit StiffMidpoint(Spins const& like, StiffOptions options = {})
      : detail::StepperBase<Spins>(name, like.lattice()), options_(options) {
    std::string const prefix = std::string(name) + "::";
    for (auto& [field, label] : {std::pair<Spins&, char const*>(x_, "generator"),
                                 {middle_, "middle"},
                                 {residual_, "residual"},
                                 {end_, "end"},
                                 {start_, "start"}})
      field = Spins(prefix + label, like.lattice());
    for (History& history : histories_) history = {prefix + "earlier", like.lattice()};
    solution_ = Solution(prefix + "solution", like.lattice());
  }

  /// Evaluations of the generator so far.
  std::int64_t evaluations_done() const { return evaluations_done_; }
  /// Steps, or parts of them, that were halved so far.
  std::int64_t halvings_done() const { return halvings_done_; }

  /// Forgets the steps so far.
  void reset() {
    exchange_ = {};
    forget();
  }

  /// For cayspin::exchange_memory.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("exchange_known", exchange_.known);
    visit("precession", exchange_.precession);
    visit("damping", exchange_.damping);
    for (std::size_t axis = 0; axis < 3; ++axis)
      visit("coupling_" + std::to_string(axis), exchange_.couplings[axis]);
    visit("last_dt", last_dt_);
    visit("contraction", contraction_);
    visit("unmeasured", unmeasured_);
    visit("evaluations", evaluations_done_);
    visit("halvings", halvings_done_);
    for (std::size_t i = 0; i < histories_.size(); ++i)
      histories_[i].visit_memory("stage_" + std::to_string(i) + "_", visit);
    if (exchange_.known) make_solver();
  }

  /// Advances `spins` from t to t + dt under `generator`; exchanges their memory with its own, so
  /// take arrays of `spins` again after a step. Waits.
  /// Throws NotConverged, with `spins` as before, when halved steps have no solution either, and
  /// std::invalid_argument when `spins` is not of the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    for (Spins const* own : {&x_, &middle_, &residual_, &end_, &start_})
      this->require_other_memory(spins, *own);
    if (!exchange_.known) {
      evaluations_done_ += exchange_.measure(exec, measure_label_, generator, middle_, t);
      make_solver();
      contraction_ = 1;
    }
    if (dt != last_dt_) forget();
    last_dt_ = dt;
    moved_ = false;
    double begin = t;
    for (std::size_t i = 0; i < histories_.size(); ++i) {
      double const part = dt * shares[i];
      if (!advance(exec, generator, spins, begin, part, &histories_[i], options_.halvings)) {
        if (moved_) swap(spins, start_);
        forget();
        throw NotConverged(this->label("::step: the equation of the step from t = ") +
                           detail::to_text(t) + " is not solved: dt = " + detail::to_text(dt) +
                           " is too large");
      }
      begin += part;
    }
  }

 private:
  using Solver = detail::SpinWaveSolver<Real, MemorySpace>;
  using Solution = typename Solver::Solution;
  using History = detail::StiffHistory<Spins>;
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();
  static constexpr auto name = Order == 2 ? "StiffMidpoint2" : "StiffMidpoint4";
  static constexpr double suzuki = 0.4144907717943757;  // 1 / (4 - 4^(1/3))
  static constexpr std::array<double, std::size_t{stages}> shares = [] {
    if constexpr (Order == 2)
      return std::array{1.0};
    else
      return std::array{suzuki, suzuki, 1 - 4 * suzuki, suzuki, suzuki};
  }();

  void forget() {
    for (auto& history : histories_) history.forget();
  }
  void make_solver() { solver_ = Solver(name, this->lattice_, exchange_.couplings); }

  /// One step of order 2, or two of half the length where it is not solved.
  template <class Exec, class Generator>
  bool advance(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt,
               History* history, int halvings) {
    if (solve(exec, generator, spins, t, dt, history)) {
      swap(spins, end_);
      if (!moved_) swap(end_, start_);
      moved_ = true;
      if (history != nullptr) history->remember(x_);
      return true;
    }
    if (history != nullptr) history->forget();
    if (halvings == 0) return false;
    ++halvings_done_;
    return advance(exec, generator, spins, t, 0.5 * dt, nullptr, halvings - 1) &&
           advance(exec, generator, spins, t + 0.5 * dt, 0.5 * dt, nullptr, halvings - 1);
  }

  /// Leaves the spins after the step in end_, and A in its middle in x_.
  template <class Exec, class Generator>
  bool solve(Exec const& exec, Generator const& generator, Spins const& spins, double t, double dt,
             History* history) {
    bool const has_history = history != nullptr && history->is_complete();
    guess(exec, spins, history, dt);
    double change = 0, tolerance = 0, smallest = std::numeric_limits<double>::infinity();
    int stalled = 0;
    for (int i = 0; i < options_.iterations; ++i) {
      bool const to_end = i > 0 || has_history;  // it may be the last one
      double const before = change;
      change = correct(exec, generator, spins, to_end ? end_ : middle_, t, dt, to_end);
      if (!(change < 1)) return false;  // out of the reach of its solution, or not a number
      if (i == 0) {
        tolerance = tolerance_of(generator, has_history ? history : nullptr, change);
        // Only a second correction can tell how fast they converge.
        bool const measures = !has_history || contraction_ > 0.1 || ++unmeasured_ >= 16;
        if (!measures && contraction_ * change <= tolerance) return true;
      } else {
        double const contraction = before > 0 ? change / before : 0;
        if (i == 1) contraction_ = contraction;
        unmeasured_ = 0;
        if (contraction < 0.9 && change * contraction <= (1 - contraction) * tolerance) return true;
        stalled = change < smallest ? 0 : stalled + 1;
        if (change <= 512 * epsilon && stalled == 2) return true;  // round-off
        if (change > 10 * smallest) return false;
      }
      smallest = std::min(smallest, change);
      if (to_end) detail::combine(exec, 0.5, spins, 0.5, end_, middle_);
    }
    return false;
  }

  /// Of the error that corrections leave, given the first of them.
  template <class Generator>
  double tolerance_of(Generator const& generator, History* history, double first) const {
    if (options_.tolerance > 0) return options_.tolerance;
    if constexpr (requires { generator.is_conservative(); })
      if (generator.is_conservative()) return 4 * epsilon;
    if (history != nullptr) return history->tolerance(first, Order);
    // It is the whole rotation.
    return std::max(std::min(1e-3 * first, 0.01 * std::pow(first, Order + 1)), 16 * epsilon);
  }

  template <class Exec>
  void guess(Exec const& exec, Spins const& spins, History const* history, double dt) const {
    detail::GuessStage<Real> kernel{
        {}, {}, 0, spins.array(), x_.output(false), middle_.output(false), static_cast<Real>(dt)};
    if (history != nullptr) history->extrapolate_in(kernel);
    detail::for_each_site<Real>(exec, guess_label_, spins.layout(), kernel);
  }

  /// A correction of x_, with the spins at the end or in the middle of the step in `to`. Returns
  /// the largest change of dt x_.
  template <class Exec, class Generator>
  double correct(Exec const& exec, Generator const& generator, Spins const& spins, Spins const& to,
                 double t, double dt, bool to_end) {
    auto prepared = detail::prepare_term(generator, exec, middle_, t + 0.5 * dt);
    using Residual = detail::ResidualStage<decltype(prepared), Real>;
    detail::for_each_site<Real>(exec, residual_label_, spins.layout(),
                                Residual{std::move(prepared), middle_.array(), x_.array(),
                                         x_.output(false), residual_.output(false)});
    ++evaluations_done_;
    std::complex<double> const b(0.5 * dt * exchange_.damping, -0.5 * dt * exchange_.precession);
    solver_.solve(exec, b, residual_, middle_, solution_);
    double const square = detail::reduce_sites<detail::Maximum, 1>(
        exec, correct_label_, spins.layout(),
        detail::CorrectStage<Real, Solution::components>{
            solution_.array(), spins.array(), middle_.array(), x_.array(), to.array(),
            static_cast<Real>(dt), to_end ? Real(1) : Real(0.5)})[0];
    return std::abs(dt) * std::sqrt(square);
  }

  std::string guess_label_ = this->label("::guess"), residual_label_ = this->label("::residual"),
              correct_label_ = this->label("::correct"), measure_label_ = this->label("::measure");
  StiffOptions options_;
  Spins x_, middle_, residual_, end_, start_;
  Solution solution_;
  std::array<History, std::size_t{stages}> histories_;
  Solver solver_;
  detail::MeasuredExchange exchange_;
  double last_dt_ = 0;
  double contraction_ = 1;  // of the last two corrections that were compared
  int unmeasured_ = 0;      // steps since then
  bool moved_ = false;      // start_ holds the spins before the step
  std::int64_t evaluations_done_ = 0, halvings_done_ = 0;
};

template <class Spins>
using StiffMidpoint2 = StiffMidpoint<Spins, 2>;
template <class Spins>
using StiffMidpoint4 = StiffMidpoint<Spins, 4>;

}  // namespace cayspin
