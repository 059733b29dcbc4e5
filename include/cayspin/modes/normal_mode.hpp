// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/spin_field.hpp>
#include <cayspin/step.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2 {

/// Why a search for modes ended.
enum class ModesEnd {
  converged,         ///< the modes are as accurate as requested, or as round-off allows
  stagnated,         ///< the search no longer improves the modes; mostly round-off
  evaluation_limit,  ///< the largest number of evaluations was reached
  interrupted        ///< poll returned Next::stop
};

constexpr std::string_view to_string(ModesEnd end) {
  switch (end) {
    case ModesEnd::converged:
      return "converged";
    case ModesEnd::stagnated:
      return "stagnated";
    case ModesEnd::evaluation_limit:
      return "evaluation limit";
    case ModesEnd::interrupted:
      return "interrupted";
  }
  return "";
}

/// A normal mode
/// dm = e^(-decay * t) * (real * cos(frequency * t) - imaginary * sin(frequency * t)).
template <class Spins>
struct NormalMode {
  double frequency = 0;   ///< angular, not negative
  double decay = 0;       ///< negative if the motion grows
  double error = 0;       ///< relative error of the shape, in the energy norm
  Spins real, imaginary;  ///< tangent to the spins; the longest complex vector has length 1
};

template <class Spins>
struct NormalModes {
  ModesEnd end = ModesEnd::evaluation_limit;
  std::vector<NormalMode<Spins>> modes;  ///< the slowest first, by |decay + i * frequency|
  std::int64_t evaluations = 0;          ///< evaluations of the field at all sites
};

/// An eigenvalue of the energy's Hessian on the tangent planes, and its eigenvector.
template <class Spins>
struct Curvature {
  double value = 0;
  double value_error = 0;  ///< estimate for spins that are exactly at rest
  double error = 0;        ///< relative error of the vector, in the energy norm
  Spins vector;            ///< one tangent vector per site; the longest has length 1
};

template <class Spins>
struct Curvatures {
  ModesEnd end = ModesEnd::evaluation_limit;
  std::vector<Curvature<Spins>> curvatures;  ///< the lowest first
  std::int64_t evaluations = 0;
};

/// Options of normal_modes and lowest_curvatures.
struct ModesOptions {
  std::size_t count = 8;              ///< number of modes; fewer are found if the spins have fewer
  double tolerance = 1e-9;            ///< relative error of shapes; frequencies are more accurate
  std::int64_t evaluations = 100000;  ///< approximate upper limit
  double time = 0;                    ///< time at which H is evaluated
  bool preconditioned = true;         ///< by the exchange measured on the field
  std::function<Next()> poll = {};    ///< called in each step of the search

  static constexpr std::size_t most = 128;
};

/// A wave of a periodic lattice.
struct Wave {
  double frequency = 0;  ///< angular, of e^(i * (k.r - frequency * t)); >= 0 at stable states
  double decay = 0;
};

struct BlochModes {
  std::vector<std::vector<Wave>> bands;  ///< one for each wave vector: its branches, lowest first
  std::int64_t evaluations = 0;
};

/// Coefficients of dm/dt = -precession * m x H - damping * m x (m x H), one number for each site,
/// with H = -dE/dm. The two must not both be 0 where a spin moves.
template <class Real, class MemorySpace>
struct Turning {
  ScalarField<Real, MemorySpace> precession, damping;
};

}  // namespace cayspin::inline v0_2
