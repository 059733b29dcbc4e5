// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"
#include "../support/oracles.hpp"

#include <cayspin/cayspin.hpp>

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/rkmk4_as_printed.hpp>
#include <cayspin_paper/series4.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::test {

/// Tolerance of a step: 1e-13 in double; the same number of epsilons, 450, in float.
template <class Real>
inline constexpr double step_tolerance = 1e-13 / epsilon<double> * epsilon<Real>;

/// Compares the results of two ways to compute one sigma.
inline void expect_same(std::vector<double> const& a, std::vector<double> const& b, double bound,
                        std::string const& where) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], bound) << where;
}

/// Both precisions, only on the default space: host spaces agree bit for bit (tests/backends).
using OracleBackends = ::testing::Types<Backend<float, Kokkos::DefaultExecutionSpace>,
                                        Backend<double, Kokkos::DefaultExecutionSpace>>;

/// The spins from which a step starts and, for methods that use them, those of the previous step.
struct Start {
  Lattice lattice;
  std::vector<double> spins, before;
  double dt = 0;
};

template <class Exec, class Stepper, class Generator>
std::vector<double> step_once(Stepper& stepper, Generator const& generator, Start const& start) {
  using Spins = typename Stepper::spins_type;
  Exec const exec;
  auto spins = spins_of<Spins>(start.lattice, start.spins);
  if constexpr (requires { stepper.remember(exec, generator, spins, 0, 0); })
    stepper.remember(exec, generator, spins_of<Spins>(start.lattice, start.before), -start.dt,
                     start.dt);
  stepper.step(exec, generator, spins, 0, start.dt);
  exec.fence();
  return numbers_of(spins);
}

/// Calls with(stepper, generator) for the method that the oracles call `method`. `constant` is
/// sigma in methods with a constant one.
template <class Spins, class Generator, class With>
auto with_method(std::string const& method, Generator const& generator, double constant,
                 Spins const& like, With const& with) {
  using namespace isotropy;
  Constant const sigma{constant};
  auto const w = orthogonal(generator);

  if (method == "euler_def") return with(LieEuler(like), generator);
  if (method == "euler_orth") return with(LieEuler(like), w);
  if (method == "euler_const") return with(LieEuler(like, sigma), generator);
  if (method == "euler_cor_analytic") return with(LieEuler(like, Analytic{}), generator);
  if (method == "euler_cor_connection") return with(LieEuler(like, Connection{}), generator);
  if (method == "euler_cor_fdfwd") return with(LieEuler(like, FiniteDifference{}), generator);
  if (method == "euler_cor_fdbwd")
    return with(LieEuler(like, FiniteDifferenceBackward{}), generator);
  if (method == "ab2_def") return with(LieAdamsBashforth2(like), generator);
  if (method == "ab2_orth") return with(LieAdamsBashforth2(like), w);
  if (method == "implicit_def") return with(ImplicitLieEuler(like), generator);
  if (method == "implicit_orth") return with(ImplicitLieEuler(like), w);
  if (method == "implicit_cor") return with(ImplicitLieEuler(like, Analytic{}), generator);
  if (method == "midpoint") return with(ImplicitMidpoint(like), generator);
  if (method == "heun_def") return with(LieHeun(like), generator);
  if (method == "heun_orth") return with(LieHeun(like), w);
  if (method == "heun_exp") return with(LieHeun(like, Zero{}, Exponential{}), generator);
  if (method == "rkmk4_def") return with(Rkmk4(like), generator);
  if (method == "rkmk4_orth") return with(Rkmk4(like), w);
  if (method == "rkmk4_const") return with(Rkmk4(like, sigma), generator);
  if (method == "rkmk4_exp") return with(Rkmk4(like, Zero{}, Exponential{}), generator);
  if (method == "rkmk4_def_printed") return with(Rkmk4AsPrinted(like), generator);
  if (method == "rkmk_kutta3") return with(Rkmk<Spins, tableau::Kutta3>(like), generator);
  if (method == "rkmk_three_eighths")
    return with(Rkmk<Spins, tableau::ThreeEighths4>(like), generator);
  if (method == "stereographic_heun")
    return with(StereographicRungeKutta<Spins, tableau::Heun>(like), generator);
  if (method == "stereographic_rk4")
    return with(StereographicRungeKutta<Spins, tableau::Classical4>(like), generator);
  if (method == "sy4_def") return with(Series4(like), generator);
  if (method == "sy4_orth") return with(Series4(like), w);
  if (method == "sy4_orth_paper") return with(Series4Paper(like), generator);
  throw std::invalid_argument("no stepper for " + method);
}

/// Takes one step of the method that the oracles call `method`.
template <class Exec, class Spins, class Generator>
std::vector<double> one_step(std::string const& method, Generator const& generator, double constant,
                             Start const& start) {
  return with_method(
      method, generator, constant, Spins("like", start.lattice),
      [&](auto stepper, auto const& of) { return step_once<Exec>(stepper, of, start); });
}

}  // namespace cayspin::test
