// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders of multistep and implicit methods, of methods with derivatives, and of the policies for
// sigma, on a coupled chain with fixed step sizes.
#include "chain.hpp"

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using namespace isotropy;

TEST_P(ChainOrder, LieEulerWithSigma) {
  expect<LieEuler<Spins, Analytic>>("analytic", 1, slab.natural());
  expect<LieEuler<Spins, Connection>>("connection", 1, slab.natural());
  expect<LieEuler<Spins, FiniteDifference>>("forward", 1, slab.natural());
  expect<LieEuler<Spins, FiniteDifferenceBackward>>("backward", 1, slab.natural());
  expect<LieEuler<Spins, Analytic, Exponential>>("analytic, exp", 1, slab.natural());
  expect<LieEuler<Spins, FiniteDifferenceBackward, Exponential>>("backward, exp", 1,
                                                                 slab.natural());
}

TEST_P(ChainOrder, LieAdamsBashforth2) {
  expect<LieAdamsBashforth2<Spins>>("default", 2, slab.natural());
  expect<LieAdamsBashforth2<Spins>>("orthogonal", 2, slab.orthogonal());
  expect<LieAdamsBashforth2<Spins, Constant>>("sigma 3", 2, slab.natural(), Constant{3});
  expect<LieAdamsBashforth2<Spins, Zero, Exponential>>("exponential", 2, slab.natural());
}

TEST_P(ChainOrder, Implicit) {
  expect<ImplicitLieEuler<Spins>>("default", 1, slab.natural());
  expect<ImplicitLieEuler<Spins>>("orthogonal", 1, slab.orthogonal());
  expect<ImplicitLieEuler<Spins, Constant>>("sigma 3", 1, slab.natural(), Constant{3});
  expect<ImplicitLieEuler<Spins, Analytic>>("analytic", 1, slab.natural());
  expect<ImplicitLieEuler<Spins, Zero, Exponential>>("exponential", 1, slab.natural());
  expect<ImplicitMidpoint<Spins>>("midpoint", 2, slab.natural());
}

TEST_P(ChainOrder, Series4) {
  expect<Series4<Spins>>("default", 4, slab.natural());
  expect<Series4<Spins>>("orthogonal", 4, slab.orthogonal());
  expect<Series4Paper<Spins>>("as printed", 4, slab.natural());
}

INSTANTIATE_TEST_SUITE_P(Damping, ChainOrder, chain_dampings);

}  // namespace
