// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/lowest_curvature.hpp>
#include <cayspin/minimizer/newton.hpp>
#include <cayspin/minimizer/preconditioner.hpp>
#include <cayspin/path/string.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace cayspin::inline v0_2::detail {

/// The Hessian restricted to vectors normal to a given unit vector.
template <class Whole, class Exec, class Spins>
class HessianBeside {
 public:
  HessianBeside(Whole& whole, Exec const& exec, Spins const& vector)
      : whole_(whole), exec_(exec), vector_(vector) {}

  auto multiply(Spins const& v, Spins const& hv) {
    auto const product = whole_.multiply(v, hv);
    leave_out_vector(hv);
    return product;
  }
  void keep_tangent(Spins const& v) const {
    whole_.keep_tangent(v);
    leave_out_vector(v);
  }

 private:
  void leave_out_vector(Spins const& v) const {
    combine(exec_, -inner_product(exec_, v, vector_), vector_, 1, v, v);
  }

  Whole& whole_;
  Exec const& exec_;
  Spins const& vector_;
};

/// Options of a search for a saddle.
struct SaddleSearchOptions {
  double time, torque, scale, strongest_field;
  std::int64_t evaluations;  // approximate upper limit
};

struct SaddleFound {
  bool is_saddle = false;  // torque below the bound; only the lowest curvature is negative (or 0)
  bool is_stopped = false;
  double torque = std::numeric_limits<double>::infinity();
  Energy energy = {};
  double curvature = 0, next_curvature = 0;  // the lowest, and an upper bound of the next
  std::int64_t evaluations = 0;
};

/// Climbs by Newton's method to a saddle from a state near it. Steps raise the energy along the
/// vector of the lowest curvature, and lower it across that vector. If another curvature is
/// negative at the end, the state is moved downhill along the vector of that curvature, and the
/// search goes on.
template <class Spins>
class SaddleSearch {
  using Real = typename Spins::value_type;
  using Mobile = ScalarField<Real, typename Spins::memory_space>;
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();
  static constexpr double largest_turn = 0.2;  // of a spin in a step

 public:
  static constexpr int work_fields = 12;

  explicit SaddleSearch(Lattice const& lattice)
      : fields_(numbered_fields<Spins, std::size_t{work_fields}>("path::saddle", lattice)) {}

  /// Return the state, which the search moves, and the vector of the lowest curvature. Set both
  /// before a search, the vector to the direction of the path.
  Spins& spins() { return fields_[0]; }
  Spins const& vector() const { return fields_[1]; }

  /// Searches from spins(), and returns where the search ended. `proceeds(SaddleFound)`: returns
  /// false to stop.
  template <class Exec, class Field, class Proceed>
  SaddleFound find(Exec const& exec, Field const& field, Mobile const& is_mobile,
                   Preconditioner<Spins>& preconditioner, SaddleSearchOptions const& options,
                   Proceed const& proceeds) {
    SaddleFound found;
    auto const precondition = [&](Spins const& from, Spins const& to) {
      preconditioner.apply(exec, from, to);
    };
    double least_torque = std::numeric_limits<double>::infinity(), turn = largest_turn;
    int steps_since = 0, falls = 0;
    for (;;) {
      auto const now = look_at_image(exec, field, options.time, spins(), gradient());
      ++found.evaluations;
      turn =
          now.torque > 2 * found.torque ? std::max(0.1 * largest_turn, 0.5 * turn) : largest_turn;
      found.energy = now.energy;
      found.torque = now.torque;
      if (!std::isfinite(now.torque)) return found;
      steps_since = now.torque < 0.7 * least_torque ? 0 : steps_since + 1;
      least_torque = std::min(least_torque, now.torque);
      bool const is_round_off = now.torque < 16 * epsilon * options.strongest_field;
      bool const is_at_rest = now.torque < options.torque || (is_round_off && steps_since > 3);
      if (!is_at_rest &&
          (found.evaluations > options.evaluations || steps_since > 100 || !proceeds(found))) {
        found.is_stopped = found.evaluations <= options.evaluations && steps_since <= 100;
        return found;
      }

      Hessian hessian(exec, field, options.time, spins(), is_mobile,
                      HessianArrays<Spins>{fields_[3], fields_[4], fields_[5]});
      double const round_off = hessian.round_off(options.strongest_field);
      double const finest = std::max(1e-6 * options.strongest_field, round_off);
      auto const so_far = [&] {
        auto with_hessian = found;
        with_hessian.evaluations += hessian.evaluations();
        return with_hessian;
      };
      // At least a few steps, so that the vector follows the state.
      auto const most_steps = [&] {
        return static_cast<int>(
            std::clamp<std::int64_t>(options.evaluations - so_far().evaluations, 50, 1000));
      };
      auto const find_vector = [&](double error) {
        auto const lowest =
            find_lowest_curvature(hessian, exec, arrays(vector()),
                                  {.scale = options.scale,
                                   .tolerance = std::numeric_limits<double>::infinity(),
                                   .error = error,
                                   .stream = 0,
                                   .has_start = true,
                                   .most_steps = most_steps(),
                                   .proceeds = [&] { return proceeds(so_far()); }},
                                  precondition);
        found.curvature = lowest.value;
        found.is_stopped = found.is_stopped || lowest.is_stopped;
      };
      double const coarse = std::clamp(0.3 * now.torque, 1e-3 * options.strongest_field,
                                       1e-2 * options.strongest_field);
      find_vector(is_at_rest ? finest : coarse);
      if (double const small = 0.1 * std::abs(found.curvature); !is_at_rest && small < coarse)
        find_vector(std::max(small, finest));
      if (found.is_stopped) return so_far();
      HessianBeside beside(hessian, exec, vector());
      if (is_at_rest) {
        double const tolerance = std::max(options.torque, round_off);
        auto const next = find_lowest_curvature(beside, exec, arrays(step()),
                                                {.scale = options.scale,
                                                 .tolerance = tolerance,
                                                 .error = std::numeric_limits<double>::infinity(),
                                                 .stream = falls},
                                                precondition);
        found.evaluations += hessian.evaluations();
        found.next_curvature = next.value;
        if (!next.is_negative || ++falls > 4) {
          found.is_saddle = now.torque < options.torque && !next.is_negative &&
                            found.curvature < tolerance;  // the curvature is 0 on a plateau
          return found;
        }
        combine(exec, 0.3 / largest_length(exec, step()), step(), 0, step(), step());
        least_torque = std::numeric_limits<double>::infinity();
        found.torque = least_torque;
      } else {
        find_step(exec, beside, found.curvature, now.torque, turn, options, precondition);
        found.evaluations += hessian.evaluations();
      }
      for_each_site<Real>(
          exec, "cayspin::path::climb", spins().layout(),
          TurnTowards<Real>{spins().array(), step().array(), spins().output(false), Real(1)});
    }
  }

 private:
  Spins const& gradient() const { return fields_[2]; }
  Spins const& step() const { return fields_[6]; }

  CurvatureArrays<Spins> arrays(Spins const& vector) const {
    return {vector, fields_[7], fields_[8], fields_[9], fields_[10], fields_[11]};
  }

  /// Writes into step() a Newton step that lowers the energy across vector() and raises it along
  /// vector().
  template <class Exec, class Beside, class Precondition>
  void find_step(Exec const& exec, Beside& beside, double curvature, double torque, double turn,
                 SaddleSearchOptions const& options, Precondition const& precondition) {
    auto const& across = fields_[11];
    combine(exec, 1, gradient(), 0, gradient(), across);
    beside.keep_tangent(across);
    double const residual = 0.3 * options.torque;
    if (largest_length(exec, across) < residual)
      combine(exec, 0, across, 0, across, step());
    else
      find_newton_step(beside, exec, across, step(),
                       NewtonArrays<Spins>{fields_[7], fields_[8], fields_[9], fields_[10]},
                       {.error = std::clamp(torque / options.scale, 1e-3, 0.3),
                        .longest = turn,
                        .residual = residual},
                       precondition);
    double const most = turn / largest_length(exec, vector());
    double const slope = inner_product(exec, gradient(), vector());
    // On a plateau, the slope is noise and the curvature about 0: the torque keeps the divisor from
    // vanishing.
    double const climb = curvature > 1e-2 * options.scale
                             ? std::copysign(most, slope)
                             : slope / std::max(std::abs(curvature), 0.1 * torque);
    combine(exec, std::clamp(climb, -most, most), vector(), 1, step(), step());
  }

  std::array<Spins, std::size_t{work_fields}> fields_;
};

}  // namespace cayspin::inline v0_2::detail
