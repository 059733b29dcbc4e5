// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/scalars.hpp>
#include <cayspin/step.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace cayspin::inline v0_2 {

/// Why a minimisation ended.
enum class MinimizeEnd {
  converged,  ///< max |m x H| is below the bound, at a minimum (with keep_saddles also at a saddle)
  stagnated,  ///< max |m x H| stays above the bound, or a saddle cannot be left; mostly round-off
  evaluation_limit,  ///< the largest number of evaluations was reached
  interrupted        ///< the observer returned Next::stop
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

/// Thrown when the field, or its energy, is not finite at the start of a minimisation.
class FieldNotFinite : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Progress of a minimisation, and its result at the end.
struct Minimum {
  MinimizeEnd end = MinimizeEnd::evaluation_limit;
  double torque = std::numeric_limits<double>::infinity();  ///< max |m x H|
  Energy energy = {};
  std::int64_t iterations = 0, evaluations = 0;  ///< evaluations of the field at all sites
  std::int64_t saddles = 0;                      ///< saddles met on the way
  /// For a converged state, an upper bound of the least eigenvalue of the energy's Hessian on the
  /// tangent planes of mobile spins; with lowest_curvature, the eigenvalue. With keep_saddles and
  /// without lowest_curvature it is not computed and stays infinite.
  double curvature = std::numeric_limits<double>::infinity();
};

/// Options of minimize.
struct MinimizeOptions {
  double torque = 1e-6;  ///< bound on max |m x H|, in the units of H
  /// Limit on the number of evaluations of the field. It may be exceeded by the measurement of the
  /// field at the start, one more iteration, and one search for a saddle and a way out of it.
  std::int64_t evaluations = 10000;
  double time = 0;             ///< time at which H is evaluated
  bool preconditioned = true;  ///< by the exchange measured on the field
  bool keep_saddles = false;   ///< accept any state without torque, also a saddle
  /// Curvatures between -least_curvature and 0 do not make a state a saddle; 0 or more, by default
  /// `torque`.
  std::optional<double> least_curvature = {};
  /// Compute Minimum::curvature to about 1e-6 of the strongest field; otherwise only its sign.
  bool lowest_curvature = false;
  std::function<Next(Minimum const&)> observer = {};  ///< called after each iteration
};

}  // namespace cayspin::inline v0_2
