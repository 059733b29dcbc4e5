// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/pair_field.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stepper/red_black_stage.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_2 {

/// Splitting by the two colours of a checkerboard, of order 2 or 4, for the Landau-Lifshitz
/// equation with nearest-neighbour couplings. While the spins of one colour move, their neighbours
/// are fixed. Each spin moves by the exact flow of one spin in a fixed field, with precession and
/// damping together. Works in place, without work memory.
///
/// On-site terms (anisotropy, a local demagnetising field) are evaluated at the mean of the spin
/// before and after its move, which is found by iteration. Field terms must therefore accept spins
/// shorter than 1, including the zero vector. Without damping, a step of -dt undoes a step of dt.
///
/// If the energy is at most quadratic in the spins and does not depend on t, both orders conserve
/// it to round-off without damping. With damping, order 2 never raises it; order 4 may, because one
/// of its five steps of order 2 goes backwards. This holds for any dt at which the iteration
/// converges: |dt| * (1 + damping) * (strength of the on-site terms) must be below about 1/2.
template <class Spins, int Order>
class RedBlack : public detail::StepperBase<Spins> {
  static_assert(Order == 2 || Order == 4, "RedBlack is of order 2 or 4.");

 public:
  using typename detail::StepperBase<Spins>::Real;
  static constexpr int order = Order;
  /// Evaluations per step of a long run, where a pass over one colour counts as half an evaluation.
  /// Consecutive steps in a batch share the pass at which they meet. evaluations_done() is half the
  /// actual number of passes.
  static constexpr int evaluations = Order == 2 ? 1 : 5;
  static constexpr int ghosts = 1;  // ghosts are exchanged after each pass
  static constexpr int work_fields = 0;

  /// Throws std::invalid_argument when a periodic axis has an odd number of sites greater than one.
  explicit RedBlack(Spins const& like)
      : RedBlack::StepperBase("RedBlack" + std::to_string(Order), like.lattice(), ghosts),
        pass_label_(this->label("::colour_pass")),
        batch_label_(this->label("::batch")) {
    Lattice const& lattice = whole(this->lattice_);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (lattice.boundary[axis] == Boundary::periodic && lattice.shape[axis] > 1 &&
          lattice.shape[axis] % 2 != 0)
        throw std::invalid_argument(
            std::string("cayspin::RedBlack: the periodic ") + "xyz"[axis] + " axis has " +
            std::to_string(lattice.shape[axis]) +
            " sites, and no checkerboard closes on itself over an odd number");
  }

  std::size_t work_bytes() const { return 0; }

  /// Returns the number of generator evaluations so far: half the number of passes, rounded up.
  std::int64_t evaluations_done() const { return (passes_done_ + 1) / 2; }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("passes", passes_done_);
  }

  /// Advances `spins` from t to t + dt, in place, under `generator`: a LandauLifshitz, or a
  /// generator whose prepare returns one. Throws std::invalid_argument when `spins` is not on the
  /// lattice given at construction, and when a term of the field needs all spins beforehand.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    if (!detail::needs_only_time(generator, exec, spins))
      throw std::invalid_argument(
          "cayspin::RedBlack::step: a term of the field needs all spins beforehand, but red-black "
          "steps change the neighbours of a spin while they move it");
    if (detail::is_stationary(generator, exec, spins)) {
      take_steps(exec, generator, spins, t, dt, 1);
    } else {
      for (detail::ColourPass const& pass : detail::colour_passes<Order>()) {
        auto const at = [&](int flow) {
          return detail::prepare_term(generator, exec, spins, t + pass.middle[flow] * dt);
        };
        auto stage = stage_of(at(0), at(pass.flows - 1), spins, true);
        launch(exec, stage, spins, pass, dt);
      }
    }
  }

  /// Returns true if `batch` can take several steps: the generator must not change between them.
  template <class Exec, class Generator>
  bool takes_batches(Exec const& exec, Generator const& generator, Spins const& spins) const {
    return detail::is_stationary(generator, exec, spins);
  }

  /// Takes `count` steps. Consecutive steps share the pass at which they meet; the result is
  /// bitwise identical to that of single steps. Throws std::invalid_argument when `spins` is not on
  /// the lattice given at construction, `count` is below 1 or takes_batches is false.
  template <class Exec, class Generator>
  void batch(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt,
             std::int64_t count) {
    auto const region = this->begin_step(exec, spins, "::batch");
    this->require_steps(count);
    if (!takes_batches(exec, generator, spins))
      throw std::invalid_argument(
          this->label("::batch: these steps have to be taken one by one (takes_batches)"));
    take_steps(exec, generator, spins, t, dt, count);
  }

 private:
  template <class Prepared>
  static auto stage_of(Prepared first, Prepared second, Spins const& spins, bool changes) {
    static_assert(detail::is_landau_lifshitz<Prepared>,
                  "RedBlack moves spins by the Landau-Lifshitz equation: its generator is a "
                  "LandauLifshitz, or has a prepare that returns one; `orthogonal` around it would "
                  "change nothing here.");
    static_assert(!detail::holds<detail::PairField, Prepared>(),
                  "RedBlack takes couplings between nearest neighbours along the axes only, and "
                  "PairCouplings may have bonds between spins of one colour.");
    return detail::RedBlackStage<Prepared, Real>{
        {std::move(first), std::move(second)}, spins.array(), changes, {}, 1, 0, false};
  }

  /// Takes steps under a generator that does not change between them.
  template <class Exec, class Generator>
  void take_steps(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                  double dt, std::int64_t count) {
    auto const prepared = detail::prepare_term(generator, exec, spins, t);
    auto stage = stage_of(prepared, prepared, spins, false);
    if constexpr (detail::is_host_execution<Exec>) {
      if (this->lattice_.part == nullptr && detail::runs_on_calling_thread<Exec>(spins.sites())) {
        detail::RedBlackSteps<Order, decltype(stage), Real> const steps{
            detail::colour_row_loop<Real>(stage, spins.layout()), dt, count};
        detail::for_each_task(exec, batch_label_, 1, spins.sites(), steps);
        passes_done_ += count * (passes - 1) + 1;
        return;
      }
    }
    detail::for_each_colour_pass<Order>(
        count, [&](detail::ColourPass const& pass) { launch(exec, stage, spins, pass, dt); });
  }

  template <class Exec, class Stage>
  void launch(Exec const& exec, Stage& stage, Spins const& spins, detail::ColourPass const& pass,
              double dt) {
    stage.set(pass, dt);
    detail::for_each_site_of_colour<Real>(exec, pass_label_, spins.layout(), stage);
    detail::update_ghosts(exec, this->lattice_, spins);
    ++passes_done_;
  }

  static constexpr int passes = static_cast<int>(detail::colour_passes<Order>().size());

  std::string pass_label_, batch_label_;
  std::int64_t passes_done_ = 0;
};

/// Red-black splitting of order 2 (RedBlack): three passes per step, each over half of the spins.
/// Consecutive steps of a batch share one pass.
template <class Spins>
class RedBlack2 : public RedBlack<Spins, 2> {
 public:
  explicit RedBlack2(Spins const& like) : RedBlack2::RedBlack(like) {}
};

/// Red-black splitting of order 4 (RedBlack): five steps of order 2, one of them backwards.
template <class Spins>
class RedBlack4 : public RedBlack<Spins, 4> {
 public:
  explicit RedBlack4(Spins const& like) : RedBlack4::RedBlack(like) {}
};

}  // namespace cayspin::inline v0_2
