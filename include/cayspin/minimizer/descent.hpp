// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/lbfgs.hpp>
#include <cayspin/minimizer/minimum.hpp>
#include <cayspin/minimizer/newton.hpp>
#include <cayspin/minimizer/probe.hpp>
#include <cayspin/minimizer/trial.hpp>
#include <cayspin/step.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace cayspin::inline v0_2::detail {

/// Returns a bound on the round-off of an energy summed over sites, for spin components of type
/// Real that are rounded independently and sums in double.
template <class Real>
double round_off_of_energy(Energy const& energy, double sites) {
  double const of_spins = std::numeric_limits<Real>::epsilon() / std::sqrt(sites);
  return 8 * (of_spins + std::numeric_limits<double>::epsilon()) * energy.magnitude;
}

/// Descent of a Minimizer until the torque is below its bound, by line searches along L-BFGS
/// directions, and by Newton steps when these searches are slow.
template <class Spins>
class Descent {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;

 public:
  explicit Descent(Spins const& like)
      : search{named("trial", like), named("gradient", like), named("new_gradient", like),
               named("direction", like)},
        is_mobile("Minimizer::is_mobile", like.lattice()),
        lbfgs("Minimizer", like.lattice()) {}

  SearchArrays<Spins> search;
  ScalarField<Real, Memory> is_mobile;
  Lbfgs<Spins> lbfgs;
  Minimum so_far;

  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();
  /// Once the spin that turns most turns by less than about this angle (rad), no shorter turns are
  /// tried.
  static constexpr double least_turn = 1e-5;

  double strongest_field() const { return strongest_field_; }
  double first_shift() const { return lbfgs.first_shift(); }

  template <class Exec, class Field>
  void begin(Exec const& exec, Field const& field, Spins const& spins,
             MinimizeOptions const& options) {
    so_far = {};
    first_step_ = 1;
    newton_error_ = 1e-2;
    takes_newton_ = false;
    lbfgs.pairs().forget();
    Kokkos::deep_copy(exec, is_mobile.allocation(), Real(0));
    auto const found = probe(exec, field, options.time, spins, search.trial, is_mobile);
    so_far.evaluations += found.evaluations;
    strongest_field_ = found.strongest();
    lbfgs.preconditioner().set(spins.lattice(), found, options.preconditioned);

    Kokkos::deep_copy(exec, search.direction.allocation(), Real(0));
    auto const start = look(exec, field, spins, 0, options);
    if (!start.is_finite())
      throw FieldNotFinite("cayspin::minimize: the field or its energy is not finite");
    swap(search.gradient, search.new_gradient);
    take(start);
  }

  template <class Exec, class Field>
  PointOnPath look(Exec const& exec, Field const& field, Spins const& spins, double step,
                   MinimizeOptions const& options) {
    ++so_far.evaluations;
    return look_along(exec, field, options.time, spins, step, search, lbfgs.pairs().next_step(),
                      lbfgs.pairs().next_change());
  }
  void take(PointOnPath const& point) {
    so_far.energy = point.energy;
    so_far.torque = point.torque;
  }

  /// Moves the spins downhill. Returns nothing once the torque is below the bound, otherwise the
  /// reason why it stopped earlier.
  template <class Exec, class Field>
  std::optional<MinimizeEnd> descend(Exec const& exec, Field const& field, Spins& spins,
                                     MinimizeOptions const& options) {
    double least_torque = so_far.torque, energy_then = so_far.energy.value;
    std::int64_t least_at = so_far.iterations;
    bool newton_failed = false;
    while (so_far.torque >= options.torque) {
      if (so_far.evaluations >= options.evaluations) return MinimizeEnd::evaluation_limit;
      if (takes_newton_ &&
          (so_far.evaluations > newton_until_ || !take_newton_step(exec, field, spins, options))) {
        takes_newton_ = false;
        newton_failed = true;
      }
      if (!takes_newton_ && !iterate(exec, field, spins, options)) return MinimizeEnd::stagnated;
      ++so_far.iterations;
      if (options.observer && options.observer(so_far) == Next::stop)
        return MinimizeEnd::interrupted;
      bool const is_round_off = may_be_round_off(so_far.torque);
      bool const falls = energy_then - so_far.energy.value > round_off(so_far.energy);
      if (so_far.torque < 0.9 * least_torque || falls) {
        least_torque = std::min(least_torque, so_far.torque);
        energy_then = so_far.energy.value;
        least_at = so_far.iterations;
      } else if (so_far.iterations - least_at >= (is_round_off ? 20 : 50)) {
        if (is_round_off || newton_failed || takes_newton_) return MinimizeEnd::stagnated;
        begin_newton();
      }
    }
    return std::nullopt;
  }

  /// Makes the next iterations Newton steps, until they have taken more than 250 evaluations. If
  /// many modes are soft, 250 evaluations do not suffice, and L-BFGS resumes.
  void begin_newton() {
    takes_newton_ = true;
    newton_until_ = so_far.evaluations + 250;
  }

  double round_off(Energy const& energy) const {
    return round_off_of_energy<Real>(energy, static_cast<double>(is_mobile.lattice().sites()));
  }

  /// Turns the spins along search.direction, and then corrects them by Newton steps that do not
  /// move along soft modes. Along a curved valley the energy rises in the first turn and falls in
  /// the corrections (the watchdog of Chamberlain, Powell, Lemarechal and Pedersen 1982). Returns
  /// true once the energy is lower than before or, where round-off hides the difference of
  /// energies, the torque is lower. Otherwise tries up to two shorter turns, then restores the
  /// spins and returns false. `slope`: the derivative of the energy along search.direction.
  /// `longest`: the length of the longest vector in search.direction.
  template <class Exec, class Field>
  bool move_and_correct(Exec const& exec, Field const& field, Spins& spins, double slope,
                        double longest, MinimizeOptions const& options) {
    auto const& pairs = lbfgs.pairs();
    Spins const &spins_before = pairs.change(3), &gradient_before = pairs.change(4),
                &direction = pairs.step(5);
    copy(exec, spins, spins_before);
    copy(exec, search.gradient, gradient_before);
    copy(exec, search.direction, direction);
    double factor = 1;
    for (int attempt = 0; attempt < 3; ++attempt) {
      double rise = 0;
      for (int corrections = 0;; ++corrections) {
        auto const there = look(exec, field, spins, corrections == 0 ? factor : 1, options);
        if (!there.is_finite()) break;
        rise = there.energy.value - so_far.energy.value;
        bool const is_hidden = std::abs(rise) <= round_off(there.energy);
        bool const is_lower =
            is_hidden ? there.torque < 0.9 * so_far.torque : rise <= 1e-4 * factor * slope;
        if (!is_lower && corrections == 3) break;
        swap(spins, search.trial);
        swap(search.gradient, search.new_gradient);
        if (is_lower) {
          take(there);
          return true;
        }
        auto const step = find_step(exec, field, spins, options,
                                    {.error = 0.02, .longest = 0.1, .follows_negative = false});
        // Only soft modes are left, or the step would gain too little.
        if (!(step.slope < 0) || step.is_cut || rise + step.slope > 0) break;
      }
      copy(exec, spins_before, spins);
      copy(exec, gradient_before, search.gradient);
      copy(exec, direction, search.direction);
      if (factor * longest < least_turn) break;
      // Next tries the lowest point of the parabola with this slope and this rise.
      factor *= std::clamp(0.5 * factor * slope / (factor * slope - rise), 0.1, 0.5);
    }
    return false;
  }

  template <class Exec>
  auto precondition(Exec const& exec) {
    return [this, &exec](Spins const& from, Spins const& to) {
      lbfgs.preconditioner().apply(exec, from, to);
    };
  }

 private:
  static constexpr double largest_turn = 1;  // of any spin in a step, rad
  static constexpr double largest_newton_turn = 0.15;

  static Spins named(char const* name, Spins const& like) {
    return Spins(std::string("Minimizer::") + name, like.lattice());
  }

  /// Returns true if round-off of the fields could cause the whole torque.
  bool may_be_round_off(double torque) const { return torque < 16 * epsilon * strongest_field_; }

  /// Takes an L-BFGS step; returns false if no step lowers the energy.
  template <class Exec, class Field>
  bool iterate(Exec const& exec, Field const& field, Spins& spins, MinimizeOptions const& options) {
    for (bool const with_pairs : {true, false}) {
      if (!with_pairs) {
        if (lbfgs.pairs().count() == 0) return false;
        lbfgs.pairs().forget();
      }
      auto const [slope, longest] = lbfgs.find(exec, spins, is_mobile, search, so_far.torque);
      if (!(slope < 0) || !std::isfinite(longest)) continue;
      if (search_line(exec, field, spins, slope, std::min(first_step_, largest_turn / longest),
                      options))
        return true;
    }
    return false;
  }

  /// Takes a step along search.direction, shortened until the energy falls; returns false after 25
  /// trials. Compares the energies at both ends of the step or, where round-off hides their
  /// difference, the slopes (Hager and Zhang 2005, eq. 4.1).
  template <class Exec, class Field>
  bool search_line(Exec const& exec, Field const& field, Spins& spins, double slope, double step,
                   MinimizeOptions const& options) {
    constexpr double decrease = 1e-4;
    for (int trial = 0; trial < 25; ++trial, step *= 0.4) {
      auto const there = look(exec, field, spins, step, options);
      if (!there.is_finite()) continue;
      double const change = there.energy.value - so_far.energy.value;
      bool const goes_down = change <= decrease * step * slope;
      bool const may_go_down =
          std::abs(change) <= round_off(there.energy) && there.slope <= (2 * decrease - 1) * slope;
      if (!goes_down && !may_go_down) continue;
      swap(spins, search.trial);
      swap(search.gradient, search.new_gradient);
      take(there);
      lbfgs.remember(there);
      // Where the energy along the step is not convex, steps of the expected size are too short.
      first_step_ = there.curvature > 0 ? 1 : 4 * step;
      return true;
    }
    return false;
  }

  /// Takes a Newton step to lower energy; returns false if it finds no lower energy. When L-BFGS is
  /// slow, soft modes are left, along which Newton steps are faster.
  template <class Exec, class Field>
  bool take_newton_step(Exec const& exec, Field const& field, Spins& spins,
                        MinimizeOptions const& options) {
    lbfgs.pairs().forget();
    lbfgs.preconditioner().forget_curvature();
    auto const step = find_step(exec, field, spins, options,
                                {.error = newton_error_, .longest = largest_newton_turn});
    if (!(step.slope < 0)) return false;
    newton_error_ = std::clamp(step.longest, 1e-3, 1e-2);
    return move_and_correct(exec, field, spins, step.slope, step.longest, options);
  }

  /// Writes a Newton step into search.direction.
  template <class Exec, class Field>
  NewtonStep find_step(Exec const& exec, Field const& field, Spins const& spins,
                       MinimizeOptions const& options, NewtonOptions newton) {
    auto const& pairs = lbfgs.pairs();
    newton.residual = 0.3 * options.torque;
    Hessian hessian(exec, field, options.time, spins, is_mobile,
                    HessianArrays<Spins>{search.trial, pairs.change(1), pairs.change(2)});
    auto const step = find_newton_step(
        hessian, exec, search.gradient, search.direction,
        NewtonArrays<Spins>{pairs.step(1), pairs.step(2), pairs.step(3), pairs.step(4)}, newton,
        precondition(exec));
    so_far.evaluations += hessian.evaluations();
    return step;
  }

  template <class Exec>
  static void copy(Exec const& exec, Spins const& from, Spins const& to) {
    combine(exec, 1, from, 0, from, to);
  }

  double strongest_field_ = 0, first_step_ = 1;
  double newton_error_ = 1e-2;  // relative error of the next Newton step
  bool takes_newton_ = false;
  std::int64_t newton_until_ = 0;  // Newton steps end after this number of evaluations
};

}  // namespace cayspin::inline v0_2::detail
