// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/lowest_curvature.hpp>
#include <cayspin/minimizer/pairs.hpp>
#include <cayspin/minimizer/probe.hpp>
#include <cayspin/minimizer/trial.hpp>
#include <cayspin/solver/helmholtz.hpp>
#include <cayspin/step.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace cayspin {

/// Why a minimisation ended.
enum class MinimizeEnd {
  converged,         ///< max |m x H| is below the bound, and no direction was found to go down
  stagnated,         ///< round-off keeps max |m x H| above the bound
  evaluation_limit,  ///< the largest number of evaluations was reached
  interrupted        ///< the observer said Next::stop
};

constexpr std::string_view to_string(MinimizeEnd end) {
  switch (end) {
    case MinimizeEnd::converged:
      return "converged";
    case MinimizeEnd::stagnated:
      return "stagnated";
    case MinimizeEnd::evaluation_limit:
      return "evaluation limit";
    case MinimizeEnd::interrupted:
      return "interrupted";
  }
  return "";
}

/// How far a minimisation has come, and at the end its result.
struct Minimum {
  MinimizeEnd end = MinimizeEnd::evaluation_limit;
  double torque = std::numeric_limits<double>::infinity();  ///< max |m x H|
  Energy energy = {};
  std::int64_t iterations = 0, evaluations = 0;  ///< evaluations of the field over all sites
  std::int64_t saddles = 0;                      ///< that were left on the way
  /// An upper bound of the least eigenvalue of the energy's Hessian, of a converged state.
  double curvature = std::numeric_limits<double>::infinity();
};

/// Options of minimize.
struct MinimizeOptions {
  double torque = 1e-6;              ///< bound on max |m x H|, in the units of H
  std::int64_t evaluations = 10000;  ///< at most so many, and the few of one more iteration
  double time = 0;                   ///< at which H is taken
  bool preconditioned = true;        ///< by the exchange that the field is found to have
  std::function<Next(Minimum const&)> observer = {};  ///< after each iteration
};

/// Finds states of rest of the energy of a field, by L-BFGS on the spheres: along great circles by
/// the Cayley map, with the pairs of steps and gradients projected to the present tangent planes.
/// The inverse of exchange and a constant, (K + c)^-1, by a cycle of multigrid, makes the number of
/// evaluations nearly independent of the lattice and of the exchange; its coefficients are found
/// from the field itself, so terms of one's own, vacancies and coefficients of sites need nothing
/// more. c follows the curvature along the last step. A state where the torque vanishes is left
/// again when the Hessian has a negative eigenvalue there.
/// Energies fall from iteration to iteration, up to round-off.
template <class Spins>
class Minimizer {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;

 public:
  /// Fields of three numbers per site that it allocates, the grids of the multigrid included.
  static constexpr int work_fields = 20;

  /// Throws std::invalid_argument for a part of a lattice.
  explicit Minimizer(Spins const& like)
      : search_{named("trial", like), named("gradient", like), named("new_gradient", like),
                named("direction", like)},
        changes_left_(named("changes_left", like)),
        preconditioned_(named("preconditioned", like)),
        moves_("Minimizer::moves", like.lattice()),
        pairs_("Minimizer", like.lattice()) {
    detail::require_whole("cayspin::Minimizer", like.lattice());
  }

  /// Moves `spins`, which may exchange their memory with its own, to a minimum. Waits. Throws
  /// std::invalid_argument for spins of another lattice, options that cannot be, and a field that
  /// is not finite at the start.
  template <class Exec, class Field>
  Minimum minimize(Exec const& exec, Field const& field, Spins& spins,
                   MinimizeOptions const& options = {}) {
    detail::check_access<Exec, Memory>();
    Kokkos::Profiling::ScopedRegion const region("cayspin::minimize");
    require_lattice("cayspin::minimize", moves_.lattice(), spins.lattice());
    if (!(options.torque > 0))
      throw std::invalid_argument("cayspin::minimize: the bound on the torque must be above 0");
    if (options.evaluations < 1)
      throw std::invalid_argument("cayspin::minimize: the evaluations must be at least 1");
    begin(exec, field, spins, options);
    for (;;) {
      if (auto const end = descend(exec, field, spins, options)) return ended(*end);
      if (auto const end = leave_saddle(exec, field, spins, options)) return ended(*end);
    }
  }

 private:
  static constexpr double largest_turn = 1.5;  // of any spin in a step
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
    pairs_.forget();
    auto const found = detail::probe(exec, field, options.time, search_.trial, moves_);
    so_far_.evaluations += found.evaluations;
    couplings_ = options.preconditioned ? found.couplings : std::array<double, 3>{};
    strongest_field_ =
        found.rest + 4 * (found.couplings[0] + found.couplings[1] + found.couplings[2]);
    exchange_.emplace("Minimizer::exchange", spins.lattice(), couplings_);
    first_shift_ = found.rest > 0 ? found.rest : strongest_field_ > 0 ? 1e-3 * strongest_field_ : 1;
    shift_ = first_shift_;

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
    return detail::look_along(exec, field, options.time, spins, step, search_, pairs_.next_step(),
                              pairs_.next_change());
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
      } else if (so_far_.iterations - least_at >= 50) {
        return MinimizeEnd::stagnated;
      }
    }
    return std::nullopt;
  }

  /// Of spins whose components are rounded independently.
  double round_off(Energy const& energy) const {
    auto const sites = static_cast<double>(moves_.lattice().sites());
    return 8 * epsilon * energy.magnitude / std::sqrt(sites);
  }

  /// One step; false when no step goes down.
  template <class Exec, class Field>
  bool iterate(Exec const& exec, Field const& field, Spins& spins, MinimizeOptions const& options) {
    for (bool const with_pairs : {true, false}) {
      if (!with_pairs) {
        if (pairs_.count() == 0) return false;
        pairs_.forget();
      }
      auto const [slope, longest] = find_direction(exec, spins);
      if (!(slope < 0) || !std::isfinite(longest)) continue;
      if (search(exec, field, spins, slope, std::min(1.0, largest_turn / longest), options))
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
      if (there.curvature > 1e-12 * std::sqrt(there.step_square * there.change_square)) {
        pairs_.keep(there.curvature);
        step_square_ = there.step_square;
      }
      return true;
    }
    return false;
  }

  struct Direction {
    double slope, longest;
  };

  /// L-BFGS with the preconditioner as the first approximation (Nocedal and Wright 2006, Alg. 7.4).
  template <class Exec>
  Direction find_direction(Exec const& exec, Spins const& spins) {
    using Products = detail::ProductsOfPairs<Real>;
    int const count = static_cast<int>(pairs_.count());
    Products products{};
    products.spins = spins.array();
    products.gradient = search_.gradient.array();
    products.count = count;
    std::copy_n(couplings_.begin(), 3, products.couplings);
    pairs_.arrays(products.steps, products.changes);
    std::array<double, Products::count_of_values> p{};
    if (count > 0)
      p = detail::reduce_sites<detail::Sum, Products::count_of_values>(
          exec, "cayspin::minimize::products", spins.layout(), products);
    auto const at = [&](int i) { return p[static_cast<std::size_t>(i)]; };
    auto const product = [&](int i) { return pairs_.product(static_cast<std::size_t>(i)); };
    if (count > 0) follow_curvature(product(count - 1), p.back());

    std::array<double, detail::pairs_kept> alpha{}, weights{};
    auto const index = [](int i) { return static_cast<std::size_t>(i); };
    for (int i = count; i-- > 0;) {
      double sum = at(i);
      for (int j = i + 1; j < count; ++j) sum -= alpha[index(j)] * at(Products::of(i, j));
      alpha[index(i)] = sum / product(i);
    }
    detail::WithoutChanges<Real> without{};
    without.spins = spins.array();
    without.gradient = search_.gradient.array();
    without.count = count;
    without.output = changes_left_.output(false);
    for (std::size_t i = 0; i < detail::pairs_kept; ++i) {
      without.changes[i] = products.changes[i];
      without.weights[i] = static_cast<Real>(alpha[i]);
    }
    detail::for_each_site<Real>(exec, "cayspin::minimize::without_changes", spins.layout(),
                                without);

    double const scale = count > 0 ? scale_of_preconditioner(exec, spins, products) : 1;
    precondition(exec, changes_left_, preconditioned_);
    std::array<double, detail::pairs_kept> along{};
    if (count > 0) along = products_with_changes(exec, spins, preconditioned_, products);
    for (int i = 0; i < count; ++i) {
      double beta = scale * along[index(i)];
      for (int j = 0; j < i; ++j) beta += weights[index(j)] * at(Products::of(j, i));
      weights[index(i)] = alpha[index(i)] - beta / product(i);
    }
    return combine_direction(exec, spins, scale, weights, products);
  }

  template <class Exec>
  Direction combine_direction(Exec const& exec, Spins const& spins, double scale,
                              std::array<double, detail::pairs_kept> const& weights,
                              detail::ProductsOfPairs<Real> const& products) {
    detail::DirectionWithSteps<Real> with{};
    with.spins = spins.array();
    with.gradient = search_.gradient.array();
    with.vectors = preconditioned_.array();
    with.moves = moves_.array();
    with.scale = scale;
    with.count = products.count;
    with.direction = search_.direction.array();
    for (std::size_t i = 0; i < detail::pairs_kept; ++i) {
      with.steps[i] = products.steps[i];
      with.weights[i] = weights[i];
    }
    auto const [slope, square] = detail::reduce_sites<detail::SumsThenMaxima<1>, 2>(
        exec, "cayspin::minimize::direction", spins.layout(), with);
    return {slope, std::sqrt(square)};
  }

  template <class Exec>
  std::array<double, detail::pairs_kept> products_with_changes(
      Exec const& exec, Spins const& spins, Spins const& vectors,
      detail::ProductsOfPairs<Real> const& products) {
    detail::ProductsWithChanges<Real> kernel{};
    kernel.spins = spins.array();
    kernel.vectors = vectors.array();
    kernel.count = products.count;
    std::copy_n(products.changes, detail::pairs_kept, kernel.changes);
    return detail::reduce_sites<detail::Sum, static_cast<int>(detail::pairs_kept)>(
        exec, "cayspin::minimize::products_with_changes", spins.layout(), kernel);
  }

  /// s.y / y.P y of the last pair.
  template <class Exec>
  double scale_of_preconditioner(Exec const& exec, Spins const& spins,
                                 detail::ProductsOfPairs<Real> const& products) {
    std::size_t const last = pairs_.count() - 1;
    precondition(exec, pairs_.change(last), preconditioned_);
    double const along = products_with_changes(exec, spins, preconditioned_, products)[last];
    double const scale = pairs_.product(last) / along;
    return along > 0 && std::isfinite(scale) ? scale : 1;
  }

  /// The curvature along the last step that exchange does not explain becomes the constant.
  void follow_curvature(double product, double exchange_energy) {
    double const rest = (product - exchange_energy) / step_square_;
    if (!std::isfinite(rest)) return;
    shift_ = std::clamp(std::sqrt(shift_ * std::max(rest, 0.2 * shift_)), 1e-3 * first_shift_,
                        30 * first_shift_);
  }

  template <class Exec>
  void precondition(Exec const& exec, Spins const& from, Spins const& to) {
    exchange_->solve(exec, shift_, Real(1), from, to);
  }

  /// At a state of rest: turns the spins out of a saddle, or says what the state is.
  template <class Exec, class Field>
  std::optional<MinimizeEnd> leave_saddle(Exec const& exec, Field const& field, Spins& spins,
                                          MinimizeOptions const& options) {
    pairs_.forget();
    detail::CurvatureArrays<Spins> arrays{search_.direction, pairs_.step(0),   pairs_.step(1),
                                          pairs_.step(2),    pairs_.change(0), pairs_.change(1),
                                          search_.trial,     pairs_.change(2), preconditioned_};
    // Along what is flatter, a turn by a radian does not bring the torque above its bound.
    double const flat = std::max(options.torque, 64 * epsilon * strongest_field_);
    auto const found = detail::find_lowest_curvature(
        exec, field, options.time, spins, moves_, flat, arrays,
        [&](Spins const& from, Spins const& to) { precondition(exec, from, to); });
    so_far_.evaluations += found.evaluations;
    so_far_.curvature = found.value;
    if (!found.is_negative) return MinimizeEnd::converged;
    ++so_far_.saddles;
    // Along a great circle each; so far that the energy clearly falls.
    detail::combine(exec, 0, arrays.vector, 0, arrays.vector, arrays.product);
    double const longest = detail::largest_difference(exec, arrays.vector, arrays.product);
    for (double turn : {0.3, 0.1, 0.03, 0.01}) {
      auto const there = look(exec, field, spins, turn / longest, options);
      if (!there.is_finite() || !(there.energy.value < so_far_.energy.value)) continue;
      swap(spins, search_.trial);
      swap(search_.gradient, search_.new_gradient);
      take(there);
      return std::nullopt;
    }
    return MinimizeEnd::stagnated;
  }

  detail::SearchArrays<Spins> search_;
  Spins changes_left_, preconditioned_;
  ScalarField<Real, Memory> moves_;
  detail::Pairs<Spins> pairs_;
  std::optional<detail::Helmholtz<Real, Memory>> exchange_;
  std::array<double, 3> couplings_{};
  double strongest_field_ = 0, first_shift_ = 1, shift_ = 1, step_square_ = 1;
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

}  // namespace cayspin
