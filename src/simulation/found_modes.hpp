// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/modes/normal_mode.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::simulation {

/// Modes of a scene, in host memory, slowest first. In reduced units the frequencies are angular;
/// in SI they are in Hz, and the decays in 1/s.
struct FoundModes {
  ModesEnd end = ModesEnd::evaluation_limit;
  std::vector<double> frequencies, decays, errors;
  std::size_t growing = 0;  ///< under [torque]: growing modes of the state, also those left out
  /// sites x 3 x 2: real and imaginary parts, sites in the order of io::initial_spins.
  std::vector<std::vector<double>> shapes;
  std::int64_t evaluations = 0;
};

/// The lowest eigenvalues of the Hessian of the energy, in units of energy, and their eigenvectors.
struct FoundCurvatures {
  ModesEnd end = ModesEnd::evaluation_limit;
  std::vector<double> values, value_errors;
  std::vector<double> errors;                // relative errors of the vectors, in the energy norm
  std::vector<std::vector<double>> vectors;  // sites x 3
  std::int64_t evaluations = 0;
};

/// Spin waves of given wave vectors, in the units of FoundModes.
struct FoundBands {
  std::vector<std::vector<double>> frequencies, decays;  // of the branches of each wave vector
  std::int64_t evaluations = 0;
  bool is_interrupted = false;
};

}  // namespace cayspin::simulation
