// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/callers_memory.hpp>
#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/lbfgs.hpp>
#include <cayspin/minimizer/lowest_curvature.hpp>
#include <cayspin/minimizer/minimum.hpp>
#include <cayspin/minimizer/newton.hpp>
#include <cayspin/minimizer/probe.hpp>
#include <cayspin/minimizer/trial.hpp>
#include <cayspin/step.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_1 {

/// Finds states of rest of the energy of a field, by L-BFGS on the spheres: along great circles by
/// the Cayley map, with the pairs of steps and gradients projected to the present tangent planes.
/// The inverse of exchange and a constant, (K + c)^-1, by a cycle of multigrid, makes the number of
/// evaluations nearly independent of the lattice and of the exchange; its coefficients are found
/// from the field itself, so terms of one's own, vacancies and coefficients of sites need nothing
/// more. c follows the curvature along the last step, and is not below the mean field of parallel
/// spins once all torques are. A state where the torque vanishes is left
/// again when the Hessian has a negative eigenvalue there.
/// Energies fall from iteration to iteration, up to round-off.
template <class Spins>
class Minimizer {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;

 public:
  /// Fields of three numbers per site that it allocates, the grids of the multigrid included.
  static constexpr int work_fields = 24;
  /// The least bound on the torque, of which squares are summed.
  static constexpr double least_bound = 1e-150;

  /// Throws std::invalid_argument for a part of a lattice.
  explicit Minimizer(Spins const& like)
      : search_{named("trial", like), named("gradient", like), named("new_gradient", like),
                named("direction", like)},
        is_mobile_("Minimizer::is_mobile", like.lattice()),
        lbfgs_("Minimizer", like.lattice()) {
    detail::require_whole("cayspin::Minimizer", like.lattice());
  }

  /// Moves `spins` to a minimum. Waits. Throws
  /// std::invalid_argument for spins of another lattice and options that cannot be, and
  /// FieldNotFinite for a field that is not finite at the start.
  template <class Exec, class Field>
  Minimum minimize(Exec const& exec, Field const& field, Spins& spins,
                   MinimizeOptions const& options = {}) {
    detail::check_access<Exec, Memory>();
    detail::check_conservative<Field>();
    Kokkos::Profiling::ScopedRegion const region("cayspin::minimize");
    require_lattice("cayspin::minimize", is_mobile_.lattice(), spins.lattice());
    if (!(options.torque >= least_bound))
      throw std::invalid_argument(
          "cayspin::minimize: the bound on the torque must be 1e-150 or "
          "more");
    if (options.evaluations < 1)
      throw std::invalid_argument("cayspin::minimize: the evaluations must be at least 1");
    detail::CallersMemory const memory(exec, *this, spins);
    begin(exec, field, spins, options);
    for (;;) {
      auto const end = descend(exec, field, spins, options);
      if (end && *end != MinimizeEnd::stagnated) return ended(*end);
      if (options.keep_saddles) return ended(end.value_or(MinimizeEnd::converged));
      if (auto const at_rest = leave_saddle(exec, field, spins, options))
        return ended(end ? *end : *at_rest);
      if (so_far_.evaluations >= options.evaluations) return ended(MinimizeEnd::evaluation_limit);
    }
  }

  /// The field whose memory a search exchanges for that of the spins, until it ends.
  template <class Visit>
  void visit_exchanged(Visit const& visit) {
    visit(search_.trial);
  }

 private:
  static constexpr double largest_turn = 1;  // of any spin in a step
  static constexpr double turn_from_saddle = 0.3, largest_newton_turn = 0.15;
  static constexpr double least_turn = 1e-5;  // of the spin that turns most, out of a saddle
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();

  static Spins named(char const* name, Spins const& like) {
    return Spins(std::string("Minimizer::") + name, like.lattice());
  }

  Minimum ended(MinimizeEnd end) {
    so_far_.end = end;
    return so_far_;
  }

  template <class Exec, class Field>
  void begin(Exec const& exec, Field const& field, Spins const& spins,
             MinimizeOptions const& options) {
    so_far_ = {};
    first_step_ = 1;
    newton_error_ = 1e-2;
    takes_newton_ = false;
    lbfgs_.pairs().forget();
    Kokkos::deep_copy(exec, is_mobile_.allocation(), Real(0));
    auto const found = detail::probe(exec, field, options.time, spins, search_.trial, is_mobile_);
    so_far_.evaluations += found.evaluations;
    strongest_field_ = found.strongest();
    lbfgs_.preconditioner().set(spins.lattice(), found, options.preconditioned);

    Kokkos::deep_copy(exec, search_.direction.allocation(), Real(0));
    auto const start = look(exec, field, spins, 0, options);
    if (!start.is_finite())
      throw FieldNotFinite("cayspin::minimize: the field or its energy is not finite");
    swap(search_.gradient, search_.new_gradient);
    take(start);
  }

  template <class Exec, class Field>
  detail::PointOnPath look(Exec const& exec, Field const& field, Spins const& spins, double step,
                           MinimizeOptions const& options) {
    ++so_far_.evaluations;
    return detail::look_along(exec, field, options.time, spins, step, search_,
                              lbfgs_.pairs().next_step(), lbfgs_.pairs().next_change());
  }
  void take(detail::PointOnPath const& point) {
    so_far_.energy = point.energy;
    so_far_.torque = point.torque;
  }

  /// Until the torque is below the bound: nothing. Otherwise why it ended before.
  template <class Exec, class Field>
  std::optional<MinimizeEnd> descend(Exec const& exec, Field const& field, Spins& spins,
                                     MinimizeOptions const& options) {
    double least_torque = so_far_.torque, energy_then = so_far_.energy.value;
    std::int64_t least_at = so_far_.iterations;
    bool newton_failed = false;
    while (so_far_.torque >= options.torque) {
      if (so_far_.evaluations >= options.evaluations) return MinimizeEnd::evaluation_limit;
      if (takes_newton_ &&
          (so_far_.evaluations > newton_until_ || !take_newton_step(exec, field, spins, options))) {
        takes_newton_ = false;
        newton_failed = true;
      }
      if (!takes_newton_ && !iterate(exec, field, spins, options)) return MinimizeEnd::stagnated;
      ++so_far_.iterations;
      if (options.observer && options.observer(so_far_) == Next::stop)
        return MinimizeEnd::interrupted;
      bool const is_round_off = may_be_round_off(so_far_.torque);
      bool const falls = energy_then - so_far_.energy.value > round_off(so_far_.energy);
      if (so_far_.torque < 0.9 * least_torque || falls) {
        least_torque = std::min(least_torque, so_far_.torque);
        energy_then = so_far_.energy.value;
        least_at = so_far_.iterations;
      } else if (so_far_.iterations - least_at >= (is_round_off ? 20 : 50)) {
        if (is_round_off || newton_failed || takes_newton_) return MinimizeEnd::stagnated;
        begin_newton();
      }
    }
    return std::nullopt;
  }

  /// Could round-off of the fields be all of a torque?
  bool may_be_round_off(double torque) const { return torque < 16 * epsilon * strongest_field_; }
  /// Of spins whose components are rounded independently, and of sums in double.
  double round_off(Energy const& energy) const {
    auto const sites = static_cast<double>(is_mobile_.lattice().sites());
    double const of_spins = epsilon / std::sqrt(sites);
    return 8 * (of_spins + std::numeric_limits<double>::epsilon()) * energy.magnitude;
  }

  /// One step; false when no step goes down.
  template <class Exec, class Field>
  bool iterate(Exec const& exec, Field const& field, Spins& spins, MinimizeOptions const& options) {
    for (bool const with_pairs : {true, false}) {
      if (!with_pairs) {
        if (lbfgs_.pairs().count() == 0) return false;
        lbfgs_.pairs().forget();
      }
      auto const [slope, longest] = lbfgs_.find(exec, spins, is_mobile_, search_, so_far_.torque);
      if (!(slope < 0) || !std::isfinite(longest)) continue;
      if (search(exec, field, spins, slope, std::min(first_step_, largest_turn / longest), options))
        return true;
    }
    return false;
  }

  /// Steps that get shorter until one goes down: by the energies, and where round-off hides their
  /// difference by the slopes at both ends (Hager and Zhang 2005, eq. 4.1).
  template <class Exec, class Field>
  bool search(Exec const& exec, Field const& field, Spins& spins, double slope, double step,
              MinimizeOptions const& options) {
    constexpr double decrease = 1e-4;
    for (int trial = 0; trial < 25; ++trial, step *= 0.4) {
      auto const there = look(exec, field, spins, step, options);
      if (!there.is_finite()) continue;
      double const change = there.energy.value - so_far_.energy.value;
      bool const goes_down = change <= decrease * step * slope;
      bool const may_go_down =
          std::abs(change) <= round_off(there.energy) && there.slope <= (2 * decrease - 1) * slope;
      if (!goes_down && !may_go_down) continue;
      swap(spins, search_.trial);
      swap(search_.gradient, search_.new_gradient);
      take(there);
      lbfgs_.remember(there);
      // Where the energy is no bowl along the way down, steps of a bowl's size get nowhere.
      first_step_ = there.curvature > 0 ? 1 : 4 * step;
      return true;
    }
    return false;
  }

  /// Where many modes are soft, L-BFGS takes over again.
  void begin_newton() {
    takes_newton_ = true;
    newton_until_ = so_far_.evaluations + 250;
  }
  /// Where L-BFGS is slow, soft modes are left: a step of Newton's method to lower energy.
  template <class Exec, class Field>
  bool take_newton_step(Exec const& exec, Field const& field, Spins& spins,
                        MinimizeOptions const& options) {
    lbfgs_.pairs().forget();
    lbfgs_.preconditioner().forget_curvature();
    auto const step = find_step(exec, field, spins, options,
                                {.error = newton_error_, .longest = largest_newton_turn});
    if (!(step.slope < 0)) return false;
    newton_error_ = std::clamp(step.longest, 1e-3, 1e-2);
    return move_and_correct(exec, field, spins, step.slope, step.longest, options);
  }

  /// A Newton step into search_.direction.
  template <class Exec, class Field>
  detail::NewtonStep find_step(Exec const& exec, Field const& field, Spins const& spins,
                               MinimizeOptions const& options, detail::NewtonOptions newton) {
    auto const& pairs = lbfgs_.pairs();
    newton.residual = 0.3 * options.torque;
    detail::Hessian hessian(
        exec, field, options.time, spins, is_mobile_,
        detail::HessianArrays<Spins>{search_.trial, pairs.change(1), pairs.change(2)});
    auto const step = detail::find_newton_step(
        hessian, exec, search_.gradient, search_.direction,
        detail::NewtonArrays<Spins>{pairs.step(1), pairs.step(2), pairs.step(3), pairs.step(4)},
        newton, precondition(exec));
    so_far_.evaluations += hessian.evaluations();
    return step;
  }

  /// Turns the spins along search_.direction, by `longest` at most, and by Newton steps across soft
  /// modes to where the energy is lower than before; otherwise they stay. Along a bent valley of
  /// the energy it rises before it falls (the watchdog of Chamberlain, Powell, Lemarechal and
  /// Pedersen 1982).
  template <class Exec, class Field>
  bool move_and_correct(Exec const& exec, Field const& field, Spins& spins, double slope,
                        double longest, MinimizeOptions const& options) {
    auto const& pairs = lbfgs_.pairs();
    Spins const &spins_before = pairs.change(3), &gradient_before = pairs.change(4),
                &direction = pairs.step(5);
    copy(exec, spins, spins_before);
    copy(exec, search_.gradient, gradient_before);
    copy(exec, search_.direction, direction);
    double factor = 1;
    for (int attempt = 0; attempt < 3; ++attempt) {
      double rise = 0;
      for (int corrections = 0;; ++corrections) {
        auto const there = look(exec, field, spins, corrections == 0 ? factor : 1, options);
        if (!there.is_finite()) break;
        rise = there.energy.value - so_far_.energy.value;
        bool const is_hidden = std::abs(rise) <= round_off(there.energy);
        bool const is_lower =
            is_hidden ? there.torque < 0.9 * so_far_.torque : rise <= 1e-4 * factor * slope;
        if (!is_lower && corrections == 3) break;
        swap(spins, search_.trial);
        swap(search_.gradient, search_.new_gradient);
        if (is_lower) {
          take(there);
          return true;
        }
        auto const step = find_step(exec, field, spins, options,
                                    {.error = 0.02, .longest = 0.1, .follows_negative = false});
        // Soft modes are all that is left, or what the step is about to gain is too little.
        if (!(step.slope < 0) || step.is_cut || rise + step.slope > 0) break;
      }
      copy(exec, spins_before, spins);
      copy(exec, gradient_before, search_.gradient);
      copy(exec, direction, search_.direction);
      if (factor * longest < least_turn) break;
      // To the lowest point of the parabola.
      factor *= std::clamp(0.5 * factor * slope / (factor * slope - rise), 0.1, 0.5);
    }
    return false;
  }

  /// At an equilibrium, or near one: turns the spins out of a saddle, or says what the state is.
  template <class Exec, class Field>
  std::optional<MinimizeEnd> leave_saddle(Exec const& exec, Field const& field, Spins& spins,
                                          MinimizeOptions const& options) {
    lbfgs_.pairs().forget();
    lbfgs_.preconditioner().forget_curvature();
    auto const found = find_curvature(exec, field, spins, options);
    so_far_.curvature = found.value;
    if (!found.is_negative) return MinimizeEnd::converged;
    ++so_far_.saddles;
    // Along a great circle each, to where the energy is clearly lower; or, near an instability, to
    // where it falls further while round-off hides by how much.
    auto const &vector = search_.direction, &none = search_.trial;
    detail::combine(exec, 0, vector, 0, vector, none);
    double const longest = detail::largest_difference(exec, vector, none);
    if (-found.value < 1e-2 * first_shift() && leave_softly(exec, field, spins, longest, options))
      return std::nullopt;
    for (double turn = turn_from_saddle; turn > least_turn; turn *= 0.3)
      for (double const step : {turn / longest, -turn / longest}) {
        auto const there = look(exec, field, spins, step, options);
        double const change = there.energy.value - so_far_.energy.value;
        bool const is_hidden = std::abs(change) <= round_off(there.energy);
        if (!there.is_finite() || !(is_hidden ? step * there.slope < 0 : change < 0)) continue;
        swap(spins, search_.trial);
        swap(search_.gradient, search_.new_gradient);
        take(there);
        return std::nullopt;
      }
    return MinimizeEnd::stagnated;
  }

  /// The vector of the lowest curvature in search_.direction.
  template <class Exec, class Field>
  detail::LowestCurvature find_curvature(Exec const& exec, Field const& field, Spins const& spins,
                                         MinimizeOptions const& options) {
    auto const& pairs = lbfgs_.pairs();
    detail::CurvatureArrays<Spins> const arrays{search_.direction, pairs.step(0),
                                                pairs.step(1),     pairs.step(2),
                                                pairs.change(0),   pairs.change(1)};
    detail::Hessian hessian(
        exec, field, options.time, spins, is_mobile_,
        detail::HessianArrays<Spins>{search_.trial, pairs.change(2), lbfgs_.scratch()});
    // Along what is flatter, a turn by a radian does not bring the torque above its bound.
    auto const found = detail::find_lowest_curvature(
        hessian, exec, arrays,
        {.scale = first_shift(),
         .tolerance = std::max(options.torque, hessian.round_off(strongest_field_)),
         .error = options.lowest_curvature ? std::max(5e-7, 16 * epsilon) * strongest_field_
                                           : std::numeric_limits<double>::infinity(),
         .stream = so_far_.saddles},
        precondition(exec));
    so_far_.evaluations += hessian.evaluations();
    return found;
  }

  /// Out of a saddle of small curvature, the vector of which is search_.direction.
  template <class Exec, class Field>
  bool leave_softly(Exec const& exec, Field const& field, Spins& spins, double longest,
                    MinimizeOptions const& options) {
    auto const& vector = search_.direction;
    double const slope = detail::inner_product(exec, search_.gradient, vector);
    double const step = (slope > 0 ? -turn_from_saddle : turn_from_saddle) / longest;
    detail::combine(exec, step, vector, 0, vector, vector);
    bool const leaves =
        move_and_correct(exec, field, spins, slope * step, turn_from_saddle, options);
    if (leaves)
      begin_newton();
    else
      detail::combine(exec, 1 / step, vector, 0, vector, vector);
    return leaves;
  }
  template <class Exec>
  static void copy(Exec const& exec, Spins const& from, Spins const& to) {
    detail::combine(exec, 1, from, 0, from, to);
  }

  double first_shift() const { return lbfgs_.first_shift(); }
  template <class Exec>
  auto precondition(Exec const& exec) {
    return [this, &exec](Spins const& from, Spins const& to) {
      lbfgs_.preconditioner().apply(exec, from, to);
    };
  }

  detail::SearchArrays<Spins> search_;
  ScalarField<Real, Memory> is_mobile_;
  detail::Lbfgs<Spins> lbfgs_;
  double strongest_field_ = 0, first_step_ = 1;
  double newton_error_ = 1e-2;  // of the next Newton step, relative
  bool takes_newton_ = false;
  std::int64_t newton_until_ = 0;  // so many evaluations
  Minimum so_far_;
};

/// Moves `spins` to a minimum of the energy of `field`, an EffectiveField or a field term: a
/// Minimizer for one call.
///   auto const found = cayspin::minimize(exec, field, spins, {.torque = 1e-6});
///   if (found.end != cayspin::MinimizeEnd::converged) ...
template <class Exec, class Field, class Spins>
Minimum minimize(Exec const& exec, Field const& field, Spins& spins,
                 MinimizeOptions const& options = {}) {
  return Minimizer<Spins>(spins).minimize(exec, field, spins, options);
}

}  // namespace cayspin::inline v0_1
