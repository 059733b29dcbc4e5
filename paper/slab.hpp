// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "ensemble.hpp"

#include <string_view>
#include <vector>

namespace cayspin::paper {

/// The paper's slab of 100 spins with all constants 1 (its Sec. 6). The paper does not give the
/// start, the easy axis or the spacing: we use spacing 1, and the start of
/// scenes/slab_switching.toml.
struct Slab {
  std::string_view name;
  std::array<double, 3> applied;
  double damping;
  bool precession;
  double end;
  std::array<double, 3> axis = {0, 0, 1};
};

inline constexpr std::array<double, 3> weak_field{0.05, 0.05, 0}, strong_field{5, 0, 0};
inline constexpr Slab weak_overdamped{"weak_overdamped", weak_field, 1, false, 20};
inline constexpr Slab strong_overdamped{"strong_overdamped", strong_field, 1, false, 20};
inline constexpr Slab full{"full", strong_field, 0.05, true, 60};
inline constexpr Slab full_to_10{"full_to_10", strong_field, 0.05, true, 10};
inline constexpr Slab strong_damping{"strong_damping", weak_field, 10, true, 1, {1, 0, 0}};
inline constexpr Slab strong_damping_strong_field{
    "strong_damping_strong_field", strong_field, 10, true, 0.1, {1, 0, 0}};

/// The path of the spin at site 37, with other observables.
struct SlabPath {
  std::vector<double> times;
  std::vector<Vector> spin;        // site 37
  std::vector<double> logarithms;  // ln|m| of the site where |ln|m|| is largest
  std::vector<double> sigma;       // of site 37; only from run_slab_with_sigma
  std::vector<Vector> end;         // spins of all sites at the end
};

/// Runs the slab. Samples the start and `looks` equally spaced times; dt must divide the time
/// between them.
SlabPath run_slab(Slab const& slab, MethodChoice const& choice, double dt, int looks);

/// Runs geometric Euler in plain host code, with sigma = -factor * <A_o', A_o x m> / |A_o|^2. A_o'
/// is a backward difference, in the first step a forward difference. Factor 1 is correct, -1 is the
/// paper's.
SlabPath run_slab_with_sigma(Slab const& slab, double factor, double dt, int looks);

/// Returns the sigma of every site at the start, by forward differences over dt.
std::vector<double> sigma_at_start(Slab const& slab, double dt);

/// Returns the largest distance between two paths at corresponding samples.
double largest_distance(SlabPath const& a, SlabPath const& b);

/// Returns the largest distance over the sites between the spins at the ends of two paths.
double distance_at_end(SlabPath const& a, SlabPath const& b);

/// Errors at the end of a run for five step sizes, `coarsest` and four successive halvings. Sizes
/// whose error is only rounding are left out.
struct Convergence {
  std::vector<double> dts, errors;             // largest over the sites
  std::vector<double> first_component_errors;  // of site 37

  double order() const;  // fitted
  double order_of_first_component() const;
  double order_of_finest_pair() const;
};
Convergence converge(Slab const& slab, MethodChoice const& choice, SlabPath const& reference,
                     double coarsest = 0.02);

/// Runs rkmk4 with a much smaller step than those of `converge`.
SlabPath reference_run(Slab const& slab);

}  // namespace cayspin::paper
