// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hand_written.hpp"

#include <cstddef>
#include <cstdint>

namespace hand_written {

/// n sites along x with open ends, in double, on one thread.
struct Chain {
  std::size_t n;
  double exchange, anisotropy, applied, damping;
};

/// One source, compiled twice: number by number, and with packs that the compiler makes of it.
enum class Loops { scalar, vectorized };

/// Steps of few spins: a loop over numbers for each stage, renormalised at the end of the step.
template <Loops>
class ChainSteps {
 public:
  explicit ChainSteps(Chain const& chain);

  void euler(Vectors<double>& m, double dt, std::int64_t steps);
  void heun(Vectors<double>& m, double dt, std::int64_t steps);
  void runge_kutta4(Vectors<double>& m, double dt, std::int64_t steps);

 private:
  Chain chain_;
  Vectors<double> v_, w_, sum_;
};

}  // namespace hand_written
