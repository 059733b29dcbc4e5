// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/callers_memory.hpp>
#include <cayspin/minimizer/lbfgs.hpp>
#include <cayspin/minimizer/lowest_curvature.hpp>
#include <cayspin/minimizer/minimum.hpp>
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
        moves_("Minimizer::moves", like.lattice()),
        lbfgs_("Minimizer", like.lattice()) {
    detail::require_whole("cayspin::Minimizer", like.lattice());
  }

  /// Moves `spins` to a minimum. Waits. Throws
  /// std::invalid_argument for spins of another lattice, options that cannot be, and a field that
  /// is not finite at the start.
  template <class Exec, class Field>
  Minimum minimize(Exec const& exec, Field const& field, Spins& spins,
                   MinimizeOptions const& options = {}) {
    detail::check_access<Exec, Memory>();
    detail::check_conservative<Field>();
    Kokkos::Profiling::ScopedRegion const region("cayspin::minimize");
    require_lattice("cayspin::minimize", moves_.lattice(), spins.lattice());
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
  static constexpr double largest_turn = 1;   // of any spin in a step
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
    lbfgs_.pairs().forget();
    Kokkos::deep_copy(exec, moves_.allocation(), Real(0));
    auto const found = detail::probe(exec, field, options.time, search_.trial, moves_);
    so_far_.evaluations += found.evaluations;
    strongest_field_ = found.strongest();
    lbfgs_.preconditioner().set(spins.lattice(), found, options.preconditioned);

    Kokkos::deep_copy(exec, search_.direction.allocation(), Real(0));
    auto const start = look(exec, field, spins, 0, options);
    if (!start.is_finite())
      throw std::invalid_argument("cayspin::minimize: the field or its energy is not finite");
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
    while (so_far_.torque >= options.torque) {
      if (so_far_.evaluations >= options.evaluations) return MinimizeEnd::evaluation_limit;
      if (!iterate(exec, field, spins, options)) return MinimizeEnd::stagnated;
      ++so_far_.iterations;
      if (options.observer && options.observer(so_far_) == Next::stop)
        return MinimizeEnd::interrupted;
      bool const falls = energy_then - so_far_.energy.value > round_off(so_far_.energy);
      if (so_far_.torque < 0.9 * least_torque || falls) {
        least_torque = std::min(least_torque, so_far_.torque);
        energy_then = so_far_.energy.value;
        least_at = so_far_.iterations;
      } else if (so_far_.iterations - least_at >= (is_round_off(so_far_.torque) ? 20 : 50)) {
        return MinimizeEnd::stagnated;
      }
    }
    return std::nullopt;
  }

  /// Could round-off of the fields be all of a torque?
  bool is_round_off(double torque) const { return torque < 16 * epsilon * strongest_field_; }
  /// Of spins whose components are rounded independently, and of sums in double.
  double round_off(Energy const& energy) const {
    auto const sites = static_cast<double>(moves_.lattice().sites());
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
      auto const [slope, longest] = lbfgs_.find(exec, spins, moves_, search_, so_far_.torque);
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

  /// At a state of rest, or near one: turns the spins out of a saddle, or says what the state is.
  template <class Exec, class Field>
  std::optional<MinimizeEnd> leave_saddle(Exec const& exec, Field const& field, Spins& spins,
                                          MinimizeOptions const& options) {
    lbfgs_.pairs().forget();
    auto const& pairs = lbfgs_.pairs();
    detail::CurvatureArrays<Spins> arrays{search_.direction, pairs.step(0),   pairs.step(1),
                                          pairs.step(2),     pairs.change(0), pairs.change(1),
                                          search_.trial,     pairs.change(2), lbfgs_.room()};
    // Along what is flatter, a turn by a radian does not bring the torque above its bound.
    double const flat = std::max(options.torque, 64 * epsilon * strongest_field_);
    auto& preconditioner = lbfgs_.preconditioner();
    preconditioner.forget_curvature();
    auto const found = detail::find_lowest_curvature(
        exec, field, options.time, spins, moves_, preconditioner.first_shift(), flat,
        so_far_.saddles, arrays,
        [&](Spins const& from, Spins const& to) { preconditioner.apply(exec, from, to); });
    so_far_.evaluations += found.evaluations;
    so_far_.curvature = found.value;
    if (!found.is_negative) return MinimizeEnd::converged;
    ++so_far_.saddles;
    // Along a great circle each, to where the energy is clearly lower; or, near an instability, to
    // where it falls further while round-off hides by how much.
    detail::combine(exec, 0, arrays.vector, 0, arrays.vector, arrays.product);
    double const longest = detail::largest_difference(exec, arrays.vector, arrays.product);
    for (double turn = 0.3; turn > least_turn; turn *= 0.3)
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

  detail::SearchArrays<Spins> search_;
  ScalarField<Real, Memory> moves_;
  detail::Lbfgs<Spins> lbfgs_;
  double strongest_field_ = 0, first_step_ = 1;
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
