// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "found_modes.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

// Equilibria and modes of spins with torques of currents. There is no energy that falls, and the
// linearised equation of motion has a general matrix, which is stored.
namespace cayspin::simulation {

/// Unit spins, or the spins' rates dm/dt: sites x 3.
using Vectors = std::vector<double>;

struct TorqueMotion {
  std::function<Vectors(Vectors const& spins)> rates;
  std::vector<unsigned char> frozen;  ///< as returned by io::frozen
  double epsilon = 0;                 ///< relative round-off of the rates
  std::vector<double> turning;  ///< of each site: |dm/dt| / |m x H|, with the torque's field in H
  std::function<bool()> is_interrupted;
};

/// Largest number of sites for modes of scenes with torques: the matrix has 2 x 2 numbers for each
/// pair of sites.
constexpr std::int64_t most_sites_with_torques = 1024;

struct RestWithTorques {
  Vectors spins;
  double torque = 0;  ///< max |m x H|, with the torque's field in H
  std::int64_t evaluations = 0;
  bool is_interrupted = false;
};

double largest_torque(TorqueMotion const& motion, Vectors const& spins);

/// Searches for a state with max |m x H| <= torque by Newton's method. If it finds none, the torque
/// of the result is larger or not finite.
RestWithTorques find_rest_with_torques(TorqueMotion const& motion, Vectors const& start,
                                       double torque, std::int64_t evaluations);

/// Returns the modes about a state of rest, in reduced units. The shapes are not normalised. Throws
/// NumbersFailed if the spins are not at rest, or if the motion is not finite.
FoundModes find_modes_with_torques(TorqueMotion const& motion, Vectors const& spins,
                                   std::size_t count, std::int64_t evaluations);

}  // namespace cayspin::simulation
