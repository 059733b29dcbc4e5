// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Serial and the threaded space give bitwise identical results with steppers that remember the
// previous step, that iterate, or that differentiate the generator, and with one that changes some
// sites in place while it reads others.
#include "equal_bits.hpp"

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using namespace isotropy;

template <class Real>
using HostSpacesOfSigma = InHostMemory<Real>;
TYPED_TEST_SUITE(HostSpacesOfSigma, Precisions, PrecisionName);

template <class Field>
struct ByNewton : ImplicitMidpoint<Field> {
  explicit ByNewton(Field const& like) : ImplicitMidpoint<Field>(like, {8, 2, 30}) {}
};

TYPED_TEST(HostSpacesOfSigma, StepAlike) {
  using Field = typename TestFixture::Field;
  expect_same_on_host_spaces<LieEuler<Field, Analytic>, LieEuler<Field, FiniteDifferenceBackward>,
                             LieAdamsBashforth2<Field>, LieHeun<Field>,
                             StereographicRungeKutta<Field, tableau::Kutta3>,
                             ImplicitLieEuler<Field, Analytic>, ByNewton<Field>, Series4<Field>>(
      natural);
}

// Red-black splitting needs a checkerboard: along periodic axes, extents must be even or 1.
TYPED_TEST(HostSpacesOfSigma, RedBlack) {
  auto checkerboards = odd_lattices();
  for (Lattice& lattice : checkerboards)
    if (lattice.boundary[0] == Boundary::periodic)
      for (auto& extent : lattice.shape)
        if (extent > 1) extent += extent % 2;
  expect_same_on_host_spaces<RedBlack4<typename TestFixture::Field>>(natural, checkerboards);
}

}  // namespace
