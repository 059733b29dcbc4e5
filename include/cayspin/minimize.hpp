// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/callers_memory.hpp>
#include <cayspin/minimizer/descent.hpp>
#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/lowest_curvature.hpp>
#include <cayspin/minimizer/minimum.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <type_traits>

namespace cayspin::inline v0_2 {

/// Minimises the energy of a field by L-BFGS on the product of spheres, with Newton steps when
/// L-BFGS is slow. Spins move along great circles by the Cayley map; earlier steps and gradients
/// are projected onto the current tangent planes.
///
/// The preconditioner (K + c)^-1, with the exchange operator K and a constant c, is applied by a
/// multigrid cycle. It makes the number of evaluations nearly independent of the size of the
/// lattice and of the strength of the exchange. K is measured on the field itself, so that user
/// terms, vacancies and site-dependent coefficients need nothing more. c follows the curvature
/// along the last step. Once all torques are below the root mean square of H without exchange,
/// measured on parallel spins, c is at least that value.
///
/// If the torque vanishes but the Hessian has a negative eigenvalue, the state is a saddle, and the
/// search moves on (unless options.keep_saddles). The energy decreases from iteration to iteration,
/// up to round-off.
template <class Spins>
class Minimizer {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;

 public:
  /// Number of allocated fields with three numbers per site, counting the memory of the multigrid
  /// levels as fields, too. The levels are always in single precision, and count half if Real is
  /// double.
  static constexpr int work_fields = sizeof(Real) == 8 ? 24 : 26;
  /// Smallest accepted bound on the torque: the squares of much smaller torques would underflow.
  static constexpr double least_bound = 1e-150;

  /// Throws std::invalid_argument for a part of a lattice and for more than one replica.
  explicit Minimizer(Spins const& like) : descent_(like) {
    detail::require_whole("cayspin::Minimizer", like.lattice());
    detail::require_one_replica("cayspin::Minimizer", like.lattice());
  }

  /// Moves `spins` to a minimum. Waits. Throws std::invalid_argument for spins of another lattice
  /// and invalid options, and FieldNotFinite for a field or an energy that is not finite at the
  /// start.
  template <class Exec, class Field>
  Minimum minimize(Exec const& exec, Field const& field, Spins& spins,
                   MinimizeOptions const& options = {}) {
    detail::check_access<Exec, Memory>();
    detail::check_conservative<Field>();
    Kokkos::Profiling::ScopedRegion const region("cayspin::minimize");
    require_lattice("cayspin::minimize", descent_.is_mobile.lattice(), spins.lattice());
    if (!(options.torque >= least_bound))
      throw std::invalid_argument(
          "cayspin::minimize: the bound on the torque must be 1e-150 or "
          "more");
    if (!(options.least_curvature.value_or(0) >= 0))
      throw std::invalid_argument("cayspin::minimize: the least curvature must be 0 or more");
    if (options.evaluations < 1)
      throw std::invalid_argument("cayspin::minimize: the evaluations must be at least 1");
    detail::CallersMemory const memory(exec, *this, spins);
    descent_.begin(exec, field, spins, options);
    for (;;) {
      auto const end = descent_.descend(exec, field, spins, options);
      if (end && *end != MinimizeEnd::stagnated) return ended(*end);
      if (options.keep_saddles) {
        if (options.lowest_curvature) find_curvature(exec, field, spins, options);
        return ended(end.value_or(MinimizeEnd::converged));
      }
      if (auto const at_rest = leave_saddle(exec, field, spins, options))
        return ended(end ? *end : *at_rest);
      if (descent_.so_far.evaluations >= options.evaluations)
        return ended(MinimizeEnd::evaluation_limit);
    }
  }

  /// Visits the field whose memory may be swapped with that of the spins during a search.
  template <class Visit>
  void visit_exchanged(Visit const& visit) {
    visit(descent_.search.trial);
  }

 private:
  static constexpr double turn_from_saddle = 0.3;
  using Descent = detail::Descent<Spins>;

  Minimum ended(MinimizeEnd end) {
    descent_.so_far.end = end;
    return descent_.so_far;
  }

  /// Call at or near an equilibrium. If it is a saddle, moves the spins away from it and returns
  /// nothing. Otherwise, or if no move lowers the energy, returns how the search ends.
  template <class Exec, class Field>
  std::optional<MinimizeEnd> leave_saddle(Exec const& exec, Field const& field, Spins& spins,
                                          MinimizeOptions const& options) {
    auto const found = find_curvature(exec, field, spins, options);
    if (!found.is_negative) return MinimizeEnd::converged;
    ++descent_.so_far.saddles;
    // Turns the spins along or against the vector by ever smaller angles, until the energy is
    // lower. If the change of the energy is within round-off, the slope must show that the energy
    // falls in the direction of the turn.
    auto const &vector = descent_.search.direction, &none = descent_.search.trial;
    detail::combine(exec, 0, vector, 0, vector, none);
    double const longest = detail::largest_difference(exec, vector, none);
    if (-found.value < 1e-2 * descent_.first_shift() &&
        leave_softly(exec, field, spins, longest, options))
      return std::nullopt;
    for (double turn = turn_from_saddle; turn > Descent::least_turn; turn *= 0.3)
      for (double const step : {turn / longest, -turn / longest}) {
        auto const there = descent_.look(exec, field, spins, step, options);
        double const change = there.energy.value - descent_.so_far.energy.value;
        bool const is_hidden = std::abs(change) <= descent_.round_off(there.energy);
        if (!there.is_finite() || !(is_hidden ? step * there.slope < 0 : change < 0)) continue;
        swap(spins, descent_.search.trial);
        swap(descent_.search.gradient, descent_.search.new_gradient);
        descent_.take(there);
        return std::nullopt;
      }
    return MinimizeEnd::stagnated;
  }

  /// Finds the lowest curvature, stores it in so_far, and writes its eigenvector into
  /// search.direction.
  template <class Exec, class Field>
  detail::LowestCurvature find_curvature(Exec const& exec, Field const& field, Spins const& spins,
                                         MinimizeOptions const& options) {
    descent_.lbfgs.pairs().forget();
    descent_.lbfgs.preconditioner().forget_curvature();
    auto const& pairs = descent_.lbfgs.pairs();
    detail::CurvatureArrays<Spins> const arrays{
        descent_.search.direction, pairs.step(0),  pairs.step(1), pairs.step(2),
        pairs.change(0),           pairs.change(1)};
    detail::Hessian hessian(exec, field, options.time, spins, descent_.is_mobile,
                            detail::HessianArrays<Spins>{descent_.search.trial, pairs.change(2),
                                                         descent_.lbfgs.scratch()});
    // Only curvatures below -tolerance count as negative. By default, for one between -tolerance
    // and 0, even a rotation by one radian along its eigenvector gives a torque that is below
    // options.torque or within round-off.
    auto const found = detail::find_lowest_curvature(
        hessian, exec, arrays,
        {.scale = descent_.first_shift(),
         .tolerance = std::max(options.least_curvature.value_or(options.torque),
                               hessian.round_off(descent_.strongest_field())),
         .error = options.lowest_curvature
                      ? std::max(5e-7, 16 * Descent::epsilon) * descent_.strongest_field()
                      : std::numeric_limits<double>::infinity(),
         .stream = descent_.so_far.saddles},
        descent_.precondition(exec));
    descent_.so_far.evaluations += hessian.evaluations();
    descent_.so_far.curvature = found.value;
    return found;
  }

  /// Leaves a saddle of small negative curvature along the eigenvector of that curvature, which is
  /// in search.direction. If the energy does not fall, restores the spins and returns false.
  template <class Exec, class Field>
  bool leave_softly(Exec const& exec, Field const& field, Spins& spins, double longest,
                    MinimizeOptions const& options) {
    auto const& vector = descent_.search.direction;
    double const slope = detail::inner_product(exec, descent_.search.gradient, vector);
    double const step = (slope > 0 ? -turn_from_saddle : turn_from_saddle) / longest;
    detail::combine(exec, step, vector, 0, vector, vector);
    bool const leaves =
        descent_.move_and_correct(exec, field, spins, slope * step, turn_from_saddle, options);
    if (leaves)
      descent_.begin_newton();
    else
      detail::combine(exec, 1 / step, vector, 0, vector, vector);
    return leaves;
  }

  Descent descent_;
};

/// Moves `spins` to a minimum of the energy of `field`, an EffectiveField or a field term, by a
/// Minimizer that is made for this call. Waits. Lengths of spins are not checked: call
/// require_unit_spins for your own spins. Throws like Minimizer.
///   auto const found = cayspin::minimize(exec, field, spins, {.torque = 1e-6});
///   if (found.end != cayspin::MinimizeEnd::converged) ...
template <class Exec, class Field, class Spins>
Minimum minimize(Exec const& exec, Field const& field, Spins& spins,
                 MinimizeOptions const& options = {}) {
  static_assert(!std::is_const_v<Spins>,
                "minimize takes spins that are not const: a search may exchange their memory.");
  return Minimizer<Spins>(spins).minimize(exec, field, spins, options);
}

}  // namespace cayspin::inline v0_2
