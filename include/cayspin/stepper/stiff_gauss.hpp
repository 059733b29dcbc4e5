// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/text.hpp>
#include <cayspin/solver/measured_exchange.hpp>
#include <cayspin/solver/spin_wave_solver.hpp>
#include <cayspin/stepper/implicit.hpp>
#include <cayspin/stepper/stepper_base.hpp>
#include <cayspin/stepper/stiff_gauss_stage.hpp>
#include <cayspin/stepper/stiff_history.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_2 {

/// Gauss's collocation method for stiff exchange. Order 2 is implicit midpoint in Cayley
/// coordinates: m1 = cay(f) m0, f = dt * A((m0 + m1) / 2). Order 4 has two coupled stages.
///
/// The estimate of A at the stages is first extrapolated from earlier steps, then corrected. Each
/// correction adds (1 + b * K)^-1 times the residual, which is A at the spins of the stages minus
/// the estimate. Here K = -J * Lap is the exchange operator, with the lattice Laplacian Lap and the
/// coupling J (one for each axis), which is measured in the first step. b is an eigenvalue of the
/// tableau times dt * (damping - i), or times dt * damping if there is no precession; i stands for
/// the operation m x. These are the corrections of Newton's method if exchange couples sites along
/// one axis only and the spins are nearly parallel. One or two corrections per step are typical. If
/// the corrections of a step do not converge, the step is halved.
///
/// Conserves |m|. If H is affine and the generator's conserves_energy() is true, also conserves the
/// energy to round-off, and the total spin if isotropic exchange is the only term. Works with any
/// generator, but not on parts of a lattice or on replicas.
template <class Spins, int Order>
class StiffGauss : public detail::StepperBase<Spins> {
  static_assert(Order == 2 || Order == 4, "StiffGauss has order 2 or 4.");
  using MemorySpace = typename Spins::memory_space;
  static constexpr std::size_t count = Order / 2;
  using History = detail::StiffHistory<Spins, Order / 2>;
  using Gauss = detail::GaussLegendre<Order / 2>;

 public:
  using typename detail::StepperBase<Spins>::Real;
  static constexpr int order = Order;
  static constexpr int stages = Order / 2;
  // The solver's grids are always in single precision, and count half if Real is double.
  static constexpr int work_fields = 2 + 5 * stages + History::fields + (sizeof(Real) == 8 ? 4 : 8);

  /// Throws std::invalid_argument for invalid options, and for a lattice with replicas.
  explicit StiffGauss(Spins const& like, StiffOptions options = {})
      : StiffGauss(name, like, options) {}

  /// Returns the number of generator evaluations so far.
  std::int64_t evaluations_done() const { return evaluations_done_; }
  /// Returns how often a step, or a part of one, was halved so far.
  std::int64_t halvings_done() const { return halvings_done_; }

  /// Forgets the previous steps and the measured exchange.
  void reset() {
    exchange_ = {};
    history_.forget();
  }

  /// For cayspin::serialize.
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
    history_.visit_memory(visit);
    if (exchange_.known) make_solver();
  }

  /// Visits the fields whose memory a step may swap with that of the spins, for cayspin::integrate.
  template <class Visit>
  void visit_exchanged(Visit const& visit) {
    visit(start_);
    visit(end_);
  }

  /// Advances `spins` from t to t + dt under `generator`. A step swaps the memory of `spins` with
  /// that of the stepper, so call spins.array() again after it. Waits for each correction. If a
  /// term of the field throws, `spins` is unchanged. Throws NotConverged, with `spins` unchanged,
  /// when the equations are not solved even for halved steps, and std::invalid_argument when
  /// `spins` is not on the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    make_ready(exec, generator, spins, t);
    if (dt != last_dt_) history_.forget();
    last_dt_ = dt;
    moved_ = false;
    bool solved = false;
    try {
      solved = advance(exec, generator, spins, t, dt, &history_, solving_.halvings);
    } catch (...) {
      give_back(spins);
      throw;
    }
    if (!solved) {
      give_back(spins);
      throw NotConverged(this->label("::step: the equation of the step from t = ") +
                             detail::to_text(t) + " is not solved: dt = " + detail::to_text(dt) +
                             " is too large, or the numbers are not finite",
                         t, dt);
    }
  }

 protected:
  using Solver = detail::SpinWaveSolver<Real, MemorySpace>;
  using Solution = typename Solver::Solution;
  using Residual = SiteField<Real, 3 * stages, MemorySpace>;
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();
  static constexpr auto name = Order == 2 ? "StiffGauss2" : "StiffGauss4";

  StiffGauss(std::string const& own_name, Spins const& like, StiffOptions const& options)
      : detail::StepperBase<Spins>(own_name, like.lattice()), solving_(options) {
    detail::require_one_replica(this->label("").c_str(), like.lattice());
    if (!(options.tolerance >= 0) || options.iterations < 1 || options.halvings < 0)
      throw std::invalid_argument(
          "cayspin::" + own_name +
          ": accepted: a tolerance of 0 or more, at least one iteration and 0 or more halvings");
    std::string const prefix = own_name + "::";
    auto const& lattice = like.lattice();
    x_ = detail::numbered_fields<Spins, count>(prefix + "generator", lattice);
    stage_ = detail::numbered_fields<Spins, count>(prefix + "stage", lattice);
    end_ = Spins(prefix + "end", lattice);
    start_ = Spins(prefix + "start", lattice);
    residual_ = Residual(prefix + "residual", lattice);
    solution_ = detail::numbered_fields<Solution, count>(prefix + "solution", lattice);
    history_ = {prefix + "earlier", lattice};
  }

  /// Prepares a step: checks that the spins are not the stepper's own memory, and measures the
  /// exchange unless it is known.
  template <class Exec, class Generator>
  void make_ready(Exec const& exec, Generator const& generator, Spins const& spins, double t) {
    for (Spins const* own : {&end_, &start_}) this->require_other_memory(spins, *own);
    for (auto const* own : {&x_, &stage_})
      for (Spins const& field : *own) this->require_other_memory(spins, field);
    if (exchange_.known) return;
    evaluations_done_ += exchange_.measure(exec, measure_label_, generator, spins, stage_[0], t);
    exchange_.known = false;  // if make_solver() throws, the next step calls it again
    make_solver();
    exchange_.known = true;
    contraction_ = 1;
  }

  void make_solver() {
    if (solver_couplings_ == exchange_.couplings) return;
    solver_couplings_.reset();
    solver_ = Solver();  // before the new one is made, so that there is memory for one only
    solver_ = Solver(name, this->lattice_, exchange_.couplings);
    solver_couplings_ = exchange_.couplings;
  }

  /// Restores the spins after a failed step, and forgets the previous steps.
  void give_back(Spins& spins) {
    if (moved_) swap(spins, start_);
    moved_ = false;
    history_.forget();
  }

  /// Takes one step. If its equation is not solved, takes two steps of half the length instead.
  /// `halvings`: how often lengths may still be halved. Returns false if the equation of a shortest
  /// step is not solved either.
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

  /// Solves the equation of one step. Leaves the spins at the end of the step in end_, and A at its
  /// stages in x_. `Shifted`: corrections use K + local_ in place of K. Returns false if
  /// corrections do not converge.
  template <bool Shifted = false, class Exec, class Generator>
  bool solve(Exec const& exec, Generator const& generator, Spins const& spins, double t, double dt,
             History* history) {
    bool const has_history = history != nullptr && history->is_complete();
    guess(exec, spins, history, dt);
    double change = 0, tolerance = 0, smallest = std::numeric_limits<double>::infinity();
    int stalled = 0;
    for (int i = 0; i < solving_.iterations; ++i) {
      double const before = change;
      corrections_ = i + 1;
      change = correct<Shifted>(exec, generator, spins, t, dt);
      if (!(change < 1)) return false;  // diverging, or not a number
      if (i == 0) {
        tolerance = tolerance_of(generator, history, change);
        // A second correction is needed to measure how fast corrections converge. If this was
        // measured within the last 16 steps, one correction may be enough.
        bool const measures = !has_history || contraction_ > 0.1 || ++unmeasured_ >= 16;
        if (!measures && contraction_ * change <= tolerance) return true;
      } else {
        // The quotient of two corrections at round-off level means nothing.
        double const contraction = before > 4 * epsilon ? change / before : 0;
        if (i == 1) contraction_ = contraction;
        unmeasured_ = 0;
        if (contraction < 0.9 && change * contraction <= (1 - contraction) * tolerance) return true;
        stalled = change < smallest ? 0 : stalled + 1;
        if (change <= 512 * epsilon && stalled == 2) return true;  // at round-off level
        if (change > 10 * smallest) return false;
      }
      smallest = std::min(smallest, change);
    }
    return false;
  }

  /// Returns the bound on the error that corrections may leave. `first`: size of the first
  /// correction.
  template <class Generator>
  double tolerance_of(Generator const& generator, History* history, double first) const {
    if (solving_.tolerance > 0) return solving_.tolerance;
    if constexpr (requires { generator.conserves_energy(); })
      if (generator.conserves_energy()) return 4 * epsilon;
    if (history != nullptr && history->is_complete()) return history->tolerance(first);
    // `first` is proportional to the power `of_rotation` of the angle by which spins turn in the
    // step. Without history, `first` is this angle itself.
    double const of_rotation = 1 + (history != nullptr ? history->known() : 0);
    return std::max(std::min(1e-3 * first, 0.01 * std::pow(first, (Order + 1) / of_rotation)),
                    16 * epsilon);
  }

  template <class Exec>
  void guess(Exec const& exec, Spins const& spins, History const* history, double dt) const {
    typename History::Guess kernel{{}, {}, 0, spins.array(), {}, {}, static_cast<Real>(dt)};
    for (std::size_t s = 0; s < count; ++s) {
      kernel.x[s] = x_[s].output(false);
      kernel.stage[s] = stage_[s].output(false);
    }
    if (history != nullptr) history->extrapolate_in(kernel, extrapolated_);
    detail::for_each_site<Real>(exec, guess_label_, spins.layout(), kernel);
  }

  /// Corrects x_, and computes the spins at the stages and at the end of the step. Returns the
  /// largest |change of x_| times |dt|.
  template <bool Shifted, class Exec, class Generator>
  double correct(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                 double dt) {
    for (std::size_t s = 0; s < count; ++s) residual(exec, generator, s, t, dt);
    detail::CorrectStage<stages, Shifted, Real> kernel{};
    kernel.spins = spins.array();
    kernel.end = end_.array();
    kernel.dt = static_cast<Real>(dt);
    kernel.only_rotated_part = solver_.solves_only_rotated_part();
    std::complex<double> const step(dt * exchange_.damping, -dt * exchange_.precession);
    for (std::size_t s = 0; s < count; ++s) {
      auto b = step * (s == 0 ? Gauss::eigenvalue : std::conj(Gauss::eigenvalue));
      if constexpr (Shifted) {
        auto const factor = 1.0 / (1.0 + b * local_);
        b *= factor;
        if (s == 0) {
          kernel.real = static_cast<Real>(factor.real());
          kernel.imaginary = static_cast<Real>(factor.imag());
        }
      }
      solver_.solve(exec, b, residual_, stage_[0], solution_[s],
                    {.conjugated = s == 1, .same_directions = s == 1 || corrections_ > 1});
      kernel.solution[s] = solution_[s].array();
      kernel.x[s] = x_[s].array();
      kernel.stage[s] = stage_[s].array();
    }
    double const square =
        detail::reduce_sites<detail::Maximum, 1>(exec, correct_label_, spins.layout(), kernel)[0];
    return std::abs(dt) * std::sqrt(square);
  }

  /// Computes the residual of one stage, and stores its part of the right side (r', r''), which
  /// belongs to an eigenvector of the tableau: stage 0 gives r', and stage 1, if there is one,
  /// gives r''.
  template <class Exec, class Generator>
  void residual(Exec const& exec, Generator const& generator, std::size_t s, double t, double dt) {
    auto prepared = detail::prepare_term(generator, exec, stage_[s], t + Gauss::nodes[s] * dt);
    double share = 1;
    if constexpr (stages == 2) share = s == 0 ? 0.5 : -0.5 / Gauss::turned;
    detail::for_each_site<Real>(
        exec, residual_label_, residual_.layout(),
        detail::ResidualStage<decltype(prepared), Real>{
            std::move(prepared), stage_[s].array(), x_[s].array(), x_[s].output(false),
            part_of_residual(s), static_cast<Real>(share)});
    ++evaluations_done_;
  }

  OutputArray<Real, 3> part_of_residual(std::size_t s) const {
    auto const all = residual_.array();
    return {{all.data + 3 * static_cast<std::ptrdiff_t>(s) * all.stride, all.stride}, false};
  }

  std::string guess_label_ = this->label("::guess"), residual_label_ = this->label("::residual"),
              correct_label_ = this->label("::correct"), measure_label_ = this->label("::measure");
  StiffOptions solving_;
  std::array<Spins, count> x_, stage_;
  Spins end_, start_;
  Residual residual_;
  std::array<Solution, count> solution_;
  History history_;
  Solver solver_;
  std::optional<std::array<double, 3>> solver_couplings_;
  detail::MeasuredExchange exchange_;
  double local_ = 0;
  double last_dt_ = 0;
  double contraction_ = 1;              // last measured ratio of second to first correction
  int unmeasured_ = 0;                  // steps since that measurement
  int corrections_ = 0;                 // number of corrections in the last step
  int extrapolated_ = History::fields;  // number of earlier values in an extrapolation
  bool moved_ = false;                  // true if start_ holds the spins before the step
  std::int64_t evaluations_done_ = 0, halvings_done_ = 0;
};

template <class Spins>
using StiffGauss2 = StiffGauss<Spins, 2>;
template <class Spins>
using StiffGauss4 = StiffGauss<Spins, 4>;

}  // namespace cayspin::inline v0_2
