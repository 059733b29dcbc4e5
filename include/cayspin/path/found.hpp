// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/step.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2 {

/// Why a search for a path ended.
enum class PathEnd {
  converged,         ///< the path and every saddle on it have converged
  ends_not_at_rest,  ///< one of the two states could not be relaxed
  same_ends,         ///< both states relaxed to the same state
  no_saddle,         ///< a maximum of the energy led to no saddle, or there is no maximum
  unsettled,         ///< the path between the saddles does not converge, or needs more images
  not_finite,        ///< the field or its energy is not finite
  evaluation_limit,  ///< the largest number of evaluations was reached
  interrupted        ///< the observer returned Next::stop
};

constexpr std::string_view to_string(PathEnd end) {
  switch (end) {
    case PathEnd::converged:
      return "converged";
    case PathEnd::ends_not_at_rest:
      return "an end could not be relaxed";
    case PathEnd::same_ends:
      return "both ends relaxed to the same state";
    case PathEnd::no_saddle:
      return "no saddle found";
    case PathEnd::unsettled:
      return "the path between the saddles does not settle";
    case PathEnd::not_finite:
      return "the field is not finite";
    case PathEnd::evaluation_limit:
      return "evaluation limit";
    case PathEnd::interrupted:
      return "interrupted";
  }
  return "";
}

/// A state without torque on a path. From it, the energy falls only in one direction and in the
/// opposite one.
struct PathSaddle {
  double energy = 0;
  double curvature = 0;       ///< lowest eigenvalue of the Hessian, negative or about 0
  double next_curvature = 0;  ///< upper bound of the next eigenvalue
  double torque = 0;          ///< max |m x H|
  std::size_t image = 0;      ///< index of its image on the path
};

/// The result of a search for a path.
struct MinimumEnergyPath {
  PathEnd end = PathEnd::evaluation_limit;
  /// Energy of each image, and its distance from the first one along the path. Between neighbouring
  /// images, the path follows great circles of all spins.
  std::vector<double> energy, distance;
  std::vector<PathSaddle> saddles;  ///< highest first
  /// Largest |g| of a spin, for the gradient g of the energy without its part along the path.
  double across = std::numeric_limits<double>::infinity();
  std::int64_t evaluations = 0;  ///< of the field at all sites
  bool needs_images = false;     ///< unsettled because the path has too few images for all saddles

  /// Return the highest saddle, and the barriers that it makes. Throw std::logic_error if no saddle
  /// was found; if `end` is not converged, there may be none.
  PathSaddle const& saddle() const {
    if (saddles.empty())
      throw std::logic_error("cayspin::MinimumEnergyPath: the search found no saddle");
    return saddles.front();
  }
  double barrier_forward() const { return saddle().energy - energy.front(); }
  double barrier_backward() const { return saddle().energy - energy.back(); }
};

/// Progress of a search.
struct PathProgress {
  std::int64_t evaluations = 0;
  double energy = 0;    ///< of the highest image, or of a state on its way to a saddle or minimum
  double gradient = 0;  ///< largest |g| of a spin; for a path, of the part of g across it
};

/// Options of minimum_energy_path.
struct PathOptions {
  double torque = 1e-6;  ///< bound on max |m x H| of the ends and saddles, in the units of H
  std::int64_t evaluations = 1000000;  ///< approximate upper limit
  double time = 0;                     ///< time at which H is evaluated
  bool preconditioned = true;          ///< by the exchange measured on the field
  bool starts_from_images = false;     ///< start from the given images, not great circles
  std::function<Next(PathProgress const&)> observer = {};  ///< called after each step
};

}  // namespace cayspin::inline v0_2
