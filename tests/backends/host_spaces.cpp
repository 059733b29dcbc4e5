// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Trajectories and reductions are bitwise identical on Serial and on the threaded space.
#include "equal_bits.hpp"

#include <cstdlib>

using namespace cayspin;
using namespace cayspin::test;

namespace {

static_assert(!std::is_same_v<Threaded, Kokkos::Serial>);

TEST(HostSpacesSetting, ThreadsAsAskedFor) {
  if (char const* const count = std::getenv("OMP_NUM_THREADS")) {
    EXPECT_EQ(Threaded().concurrency(), std::atoi(count));
  }
}

template <class Real>
using HostSpaces = InHostMemory<Real>;
TYPED_TEST_SUITE(HostSpaces, Precisions, PrecisionName);

TYPED_TEST(HostSpaces, StepAlike) {
  using Field = typename TestFixture::Field;
  expect_same_on_host_spaces<LieEuler<Field>, Rkmk4<Field>,
                             Rkmk4<Field, isotropy::Zero, Exponential>, ProjectedRk4<Field>>(
      natural);
  expect_same_on_host_spaces<Rkmk4<Field>>([](Slab const& slab) { return slab.orthogonal(); });
}

TYPED_TEST(HostSpaces, SiteDependentCoefficients) {
  using Field = typename TestFixture::Field;
  expect_same_on_host_spaces<Rkmk4<Field>>(site_dependent<Field>);
}

}  // namespace
