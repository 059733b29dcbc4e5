// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The same bits on Serial and on the threaded space: steppers that remember, iterate, differentiate
// and project.
#include "equal_bits.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

using namespace isotropy;

constexpr auto natural = [](Slab const& slab) { return slab.natural(); };
constexpr auto undamped = [](Slab slab) {
  slab.damping = 0;
  return slab.natural();
};

template <class Real>
struct HostSpacesOfSigma : ::testing::Test {
  using Field = SpinField<Real, Kokkos::HostSpace>;
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(HostSpacesOfSigma, Precisions);

template <class Field>
struct ByNewton : ImplicitMidpoint<Field> {
  explicit ByNewton(Field const& like) : ImplicitMidpoint<Field>(like, {8, 2, 30}) {}
};

template <class Field>
struct Projected : EnergyProjection<LieHeun<Field>> {
  explicit Projected(Field const& like) : Projected::EnergyProjection(like, LieHeun(like)) {}
};

TYPED_TEST(HostSpacesOfSigma, LieEuler) {
  using Field = typename TestFixture::Field;
  expect_same_on_host_spaces<LieEuler<Field, Analytic>>(natural);
  expect_same_on_host_spaces<LieEuler<Field, FiniteDifferenceBackward>>(natural);
}

TYPED_TEST(HostSpacesOfSigma, LieAdamsBashforth2) {
  expect_same_on_host_spaces<LieAdamsBashforth2<typename TestFixture::Field>>(natural);
}

TYPED_TEST(HostSpacesOfSigma, LieHeun) {
  expect_same_on_host_spaces<LieHeun<typename TestFixture::Field>>(natural);
}

TYPED_TEST(HostSpacesOfSigma, Stereographic) {
  using Field = typename TestFixture::Field;
  expect_same_on_host_spaces<StereographicRungeKutta<Field, tableau::Kutta3>>(natural);
}

TYPED_TEST(HostSpacesOfSigma, Implicit) {
  using Field = typename TestFixture::Field;
  expect_same_on_host_spaces<ImplicitLieEuler<Field, Analytic>>(natural);
  expect_same_on_host_spaces<ByNewton<Field>>(natural);
}

TYPED_TEST(HostSpacesOfSigma, Series4) {
  expect_same_on_host_spaces<Series4<typename TestFixture::Field>>(natural);
}

TYPED_TEST(HostSpacesOfSigma, EnergyProjection) {
  expect_same_on_host_spaces<Projected<typename TestFixture::Field>>(undamped);
}

}  // namespace
