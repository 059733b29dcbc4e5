// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"
#include "../support/oracles.hpp"

#include <cayspin/cayspin.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::test {

/// 1e-13 in double; as many epsilons, 450, in float.
template <class Real>
inline constexpr double step_tolerance = 1e-13 / epsilon<double>* epsilon<Real>;

/// One step of the method that the oracles call `method`; `constant` is its sigma.
template <class Exec, class Spins, class Generator>
std::vector<double> one_step(std::string const& method, Generator const& generator, double constant,
                             Lattice const& lattice, std::vector<double> const& start, double dt) {
  Exec const exec;
  auto spins = spins_of<Spins>(lattice, start);
  isotropy::Constant const sigma{constant};
  auto const with = [&](auto stepper, auto const& of) {
    stepper.step(exec, of, spins, 0, dt);
    exec.fence();
    return numbers_of(spins);
  };
  if (method == "euler_def") return with(LieEuler(spins), generator);
  if (method == "euler_orth") return with(LieEuler(spins), orthogonal(generator));
  if (method == "euler_const") return with(LieEuler(spins, sigma), generator);
  if (method == "rkmk4_def") return with(Rkmk4(spins), generator);
  if (method == "rkmk4_orth") return with(Rkmk4(spins), orthogonal(generator));
  if (method == "rkmk4_const") return with(Rkmk4(spins, sigma), generator);
  if (method == "rkmk4_def_printed") return with(Rkmk4AsPrinted(spins), generator);
  throw std::invalid_argument("no stepper for " + method);
}

}  // namespace cayspin::test
