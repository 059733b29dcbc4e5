// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stepper/field_extrapolation_stability.hpp>
#include <cayspin/stepper/field_extrapolation_stage.hpp>
#include <cayspin/stepper/field_history.hpp>
#include <cayspin/stepper/methods.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_1 {

/// When a stepper that estimates its errors starts again, because the neighbour field is not what
/// its past predicted. Infinity: never. If both are infinite, no step waits for its estimate.
struct FieldExtrapolationOptions {
  double restart_angle = 0.1;   // above an error of so many radians in one step
  double restart_growth = 100;  // above so many times the largest of the last few errors
};

/// Field extrapolation of order 3 or 4 with one evaluation per step. The polynomial through the
/// last Order values predicts the field of the other spins. Every spin then moves in it and in its
/// own local field, by one step of Rkmk4. What depends on a spin alone (anisotropy) or on t
/// (applied fields) is not extrapolated. The first Order - 1 steps are steps of Rkmk4. Steps may
/// change, but grow by a factor of 2 at most; otherwise the method starts again. Estimates: the
/// error of each step is known one step later, as dt g |dA x m| of a spin. dA is the A in the
/// neighbour field less the A in the predicted one. g is 3/8 for order 3 and, to 0.1 %, 251/720 for
/// order 4 with equal steps, as in the methods of Adams and Bashforth. The estimate leaves out the
/// error of the local solve, which is of order 4. It takes a field and a number per site more.
template <class Spins, int Order, bool Estimates = false>
class FieldExtrapolation : public detail::StepperBase<Spins> {
  static_assert(Order == 3 || Order == 4, "Field extrapolation is of order 3 or 4.");
  using Base = detail::StepperBase<Spins>;
  using Start = Rkmk4<Spins>;

 public:
  using typename Base::Real;
  static constexpr int order = Order;
  static constexpr int evaluations = 1;  // of the generator, per step after the first ones
  static constexpr std::size_t past_fields = Estimates ? Order : Order - 1;
  static constexpr int ghosts = Start::ghosts;
  static constexpr int work_fields = static_cast<int>(past_fields) + 1 + Start::work_fields;

  FieldExtrapolation(std::string const& name, Spins const& like)
      : Base(name, like.lattice(), ghosts),
        start_(like),
        next_(name + "::next", like.lattice()),
        past_(name + "::neighbor_field", like.lattice()),
        streaming_(detail::exceeds_caches<DefaultExec>((past_fields + 2) * like.bytes())) {
    if constexpr (Estimates) angles_ = Angles(name + "::error", like.lattice());
  }
  FieldExtrapolation(std::string const& name, Spins const& like,
                     FieldExtrapolationOptions const& options)
      : FieldExtrapolation(name, like) {
    static_assert(Estimates,
                  "FieldExtrapolationOptions are those of a method that estimates its errors: "
                  "FieldExtrapolation3<Spins, true>(spins, options).");
    options_ = options;
  }

  std::size_t work_bytes() const {
    return (past_fields + 1) * next_.bytes() + angles_.bytes() + start_.work_bytes();
  }
  static std::size_t work_bytes(Lattice const& lattice, bool by_time_alone, int threads) {
    auto const layout = detail::RowLayout::of<Real>(lattice);
    std::size_t const numbers =
        (past_fields + 1) * layout.allocation(3) + (Estimates ? layout.allocation(1) : 0);
    return numbers * sizeof(Real) + Start::work_bytes(lattice, by_time_alone, threads);
  }

  /// The result of cayspin::largest_stable_step, if the field of the other spins is exchange
  /// between neighbours. If the whole field is extrapolated, the limit is 0.5 to 0.75 of it.
  static double largest_stable_step(double field_bound, double damping,
                                    std::same_as<bool> auto precession) {
    detail::check_bound(field_bound, damping);
    return detail::largest_stable_extrapolation<Order>(field_bound, damping, precession);
  }

  /// Evaluations of the generator so far; those of the first steps count 5 each.
  std::int64_t evaluations_done() const { return evaluations_done_; }
  /// Starts so far, the first one included.
  std::int64_t starts() const { return starts_; }

  /// Forgets the steps before, so that the next steps are a start. Call it when something else has
  /// changed the spins or the generator. cayspin::integrate calls it for each run.
  void reset() { past_.forget(); }

  /// For cayspin::exchange_memory.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    past_.visit_memory(visit);
    visit("evaluations", evaluations_done_);
    visit("starts", starts_);
    if constexpr (Estimates) {
      visit("has_error", has_error_);
      visit("largest_of_late", largest_of_late_);
      if (has_error_) visit("error", angles_);
    }
  }

  /// For cayspin::integrate: the fields whose memory a step may exchange for that of the spins.
  template <class Visit>
  void visit_exchanged(Visit const& visit) {
    visit(next_);
    start_.visit_exchanged(visit);
  }

  /// The largest error estimated for the step before the last one, as an angle in radians; NaN
  /// until Order + 1 steps are taken from a start. Waits.
  template <class Exec>
  double last_error(Exec const& exec) const
    requires Estimates
  {
    if (!has_error_) return std::numeric_limits<double>::quiet_NaN();
    return detail::reduce_sites<detail::Maximum, 1>(
        exec, error_label_, angles_.layout(), detail::LargestOfSites<Real>{angles_.array()})[0];
  }

  /// Advances `spins` from t to t + dt under `generator`. `spins` must be those at the end of the
  /// step before. The step exchanges their memory with its own: take arrays of `spins` again after
  /// it.
  /// Throws std::invalid_argument when `spins` is not of the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    this->require_other_memory(spins, next_);
    if (dt == 0) return;
    if (past_.known() > 0 && !past_.is_followed_by(dt)) reset();
    if (past_.known() >= Order - 1) {
      extrapolate(exec, generator, spins, t, dt);
      if (!has_failed(exec)) {
        swap(spins, next_);
        detail::update_ghosts(exec, this->lattice_, spins);
        return past_.remember(dt);
      }
      reset();
      begin(exec, generator, spins, t, dt);
    } else {
      store_neighbor_field(exec, generator, spins, t);
      begin(exec, generator, spins, t, dt);
    }
  }

 private:
  using DefaultExec = typename Spins::memory_space::execution_space;
  using Angles = ScalarField<Real, typename Spins::memory_space>;
  using Error = std::conditional_t<Estimates, detail::ErrorOfExtrapolation<Order, Real>,
                                   detail::NoErrorOfExtrapolation<Order>>;

  template <class Exec, class Generator>
  void store_neighbor_field(Exec const& exec, Generator const& generator, Spins const& spins,
                            double t) {
    auto prepared = detail::prepare_term(generator, exec, spins, t);
    detail::for_each_site<Real>(
        exec, store_label_, spins.layout(),
        detail::NeighborFieldStage<decltype(prepared), Real>{std::move(prepared), spins.array(),
                                                             past_.following().output(false)},
        spins.layout().own);
    ++evaluations_done_;
  }

  /// A step of the start, which stores its neighbour field.
  template <class Exec, class Generator>
  void begin(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    if (past_.known() == 0) {
      ++starts_;
      has_error_ = false;
      largest_of_late_ = 0;
    }
    start_.step(exec, generator, spins, t, dt);
    evaluations_done_ += Start::evaluations;
    past_.remember(dt);
  }

  template <class Exec, class Generator>
  void extrapolate(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                   double dt) {
    auto prepared = detail::prepare_term(generator, exec, spins, t);
    auto const local = [&](double when) {
      return detail::prepare_local(generator, exec, spins, when);
    };
    using Kernel =
        detail::FieldExtrapolationStage<Order, Error, decltype(prepared), decltype(local(t)), Real>;
    Kernel kernel{std::move(prepared),
                  {local(t), local(t + 0.5 * dt), local(t + dt)},
                  {},
                  {},
                  spins.array(),
                  {},
                  past_.following().output(false),
                  next_.output(streaming_),
                  {},
                  static_cast<Real>(dt)};
    auto const nodes = past_.template times<Order>(0, dt);
    std::ranges::copy(detail::interpolation_weights(nodes, 0.5), kernel.middle);
    std::ranges::copy(detail::interpolation_weights(nodes, 1), kernel.end);
    for (std::size_t j = 0; j < past_fields; ++j) kernel.older[j] = past_[j].array();
    if constexpr (Estimates) {
      kernel.error = error_of_step_before(dt);
      has_error_ = past_.is_full();
    }
    detail::for_each_site<Real>(exec, step_label_, spins.layout(), kernel, spins.layout().own);
    ++evaluations_done_;
  }

  /// For the polynomial of the step before: its weights at the end of that step, and the ratio of
  /// its mean error over the step (with the local solve's weights) to its error at the end.
  Error error_of_step_before(double dt) const
    requires Estimates
  {
    Error error{{}, 0, angles_.output(false)};
    if (!past_.is_full()) return error;
    auto const nodes = past_.template times<Order>(1, past_.last_step());
    std::ranges::copy(detail::interpolation_weights(nodes, 1), error.weights);
    double middle = 1, end = 1;
    for (double const node : nodes) middle *= 0.5 - node, end *= 1 - node;
    error.scale = past_.last_step() / dt * (4 * middle / end + 1) / 6;
    return error;
  }

  template <class Exec>
  bool has_failed(Exec const& exec) {
    if constexpr (Estimates) {
      double const never = std::numeric_limits<double>::infinity();
      if (!has_error_ || (options_.restart_angle == never && options_.restart_growth == never))
        return false;
      double const error = last_error(exec);
      // Growth of round-off errors is no failure.
      double const floor = 100 * std::numeric_limits<Real>::epsilon();
      if (options_.restart_angle < error ||
          (largest_of_late_ > 0 &&
           options_.restart_growth * std::max(largest_of_late_, floor) < error))
        return true;
      largest_of_late_ = std::max(error, 0.5 * largest_of_late_);
    }
    return false;
  }

  std::string store_label_ = this->label("::neighbor_field"), step_label_ = this->label("::step"),
              error_label_ = this->label("::largest_error");
  FieldExtrapolationOptions options_;
  Start start_;
  Spins next_;
  detail::FieldHistory<Spins, past_fields> past_;
  Angles angles_;
  bool streaming_;  // stores of spins go around the caches
  bool has_error_ = false;
  double largest_of_late_ = 0;
  std::int64_t evaluations_done_ = 0, starts_ = 0;
};

/// Field extrapolation of order 3: five fields in motion.
template <class Spins, bool Estimates = false>
class FieldExtrapolation3 : public FieldExtrapolation<Spins, 3, Estimates> {
 public:
  explicit FieldExtrapolation3(Spins const& like)
      : FieldExtrapolation3::FieldExtrapolation("FieldExtrapolation3", like) {}
  FieldExtrapolation3(Spins const& like, FieldExtrapolationOptions const& options)
      : FieldExtrapolation3::FieldExtrapolation("FieldExtrapolation3", like, options) {}
};

/// Field extrapolation of order 4: six fields in motion.
template <class Spins, bool Estimates = false>
class FieldExtrapolation4 : public FieldExtrapolation<Spins, 4, Estimates> {
 public:
  explicit FieldExtrapolation4(Spins const& like)
      : FieldExtrapolation4::FieldExtrapolation("FieldExtrapolation4", like) {}
  FieldExtrapolation4(Spins const& like, FieldExtrapolationOptions const& options)
      : FieldExtrapolation4::FieldExtrapolation("FieldExtrapolation4", like, options) {}
};

}  // namespace cayspin::inline v0_1
