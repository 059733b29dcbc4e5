// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The emulated device catches errors like a real one, or more often: host code that reads its
// memory, and results that are read before a fence.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>

#include <cstdlib>
#include <vector>

using namespace cayspin;
using namespace cayspin::test;

namespace {

static_assert(std::is_same_v<Kokkos::DefaultExecutionSpace, HostDevice>);
static_assert(!detail::is_host_execution<HostDevice>);

template <class Real>
struct Strictness : ::testing::Test {
  using Spins = SpinField<Real, HostDeviceMemory>;
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};
TYPED_TEST_SUITE(Strictness, Precisions, PrecisionName);

TYPED_TEST(Strictness, HostDereferenceEndsTheProgram) {
  typename TestFixture::Spins const spins("spins", Lattice::chain(5));
  auto const array = spins.array();
  EXPECT_DEATH(
      {
        auto volatile const z = array.data[2 * array.stride];
        std::exit(z == 7);
      },
      "");
  EXPECT_DEATH(
      {
        array.data[0] = 1;
        std::exit(0);
      },
      "");
}

TYPED_TEST(Strictness, HostAccessToAViewEndsTheProgram) {
  Kokkos::View<TypeParam*, HostDeviceMemory> const numbers("numbers", 3);
  EXPECT_DEATH(numbers(0) = 1, "host code reads or writes a View on the device");
}

TYPED_TEST(Strictness, FreshMemoryHoldsNoNumbers) {
  Kokkos::View<TypeParam*, HostDeviceMemory> const numbers(
      Kokkos::view_alloc(Kokkos::WithoutInitializing, "numbers"), 1000);
  auto const here = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbers);
  for (std::size_t i = 0; i < here.size(); ++i) ASSERT_TRUE(std::isnan(here(i))) << i;
}

TYPED_TEST(Strictness, NothingIsThereBeforeAFence) {
  using Spins = typename TestFixture::Spins;
  HostDevice const exec;
  Spins spins("spins", Lattice::chain(4));
  using Numbers = Kokkos::View<TypeParam* [3], Kokkos::LayoutLeft, HostDeviceMemory>;
  Numbers const there("there", 4);
  auto const here = Kokkos::create_mirror_view(there);
  LieEuler<Spins> euler(spins);
  euler.step(exec, LandauLifshitz(EffectiveField(Zeeman{{1, 0, 0}}), 0.1), spins, 0, 0.1);
  copy(exec, spins, there);
  Kokkos::deep_copy(exec, here, there);
  EXPECT_EQ(here(2, 2), 0);
  exec.fence();
  EXPECT_NEAR(here(2, 2), 0.995, 1e-3);
}

// Reads the spins through another instance, which does not wait for the work of `exec`.
TYPED_TEST(Strictness, IntegrateWaitsForItsObserversAndItsEnd) {
  using Spins = typename TestFixture::Spins;
  HostDevice const exec;
  auto const other = Kokkos::Experimental::partition_space(exec, 1)[0];
  Spins spins("spins", Lattice::chain(4));
  using Numbers = Kokkos::View<TypeParam* [3], Kokkos::LayoutLeft, HostDeviceMemory>;
  Numbers const there("there", 4);
  auto const here = Kokkos::create_mirror_view(there);
  auto const z_now = [&] {
    copy(other, spins, there);
    Kokkos::deep_copy(other, here, there);
    other.fence();
    return here(2, 2);
  };
  std::vector<TypeParam> seen;
  auto const look = [&](HostDevice const&, Step const&, Spins const&) { seen.push_back(z_now()); };
  LandauLifshitz const generator(EffectiveField(Zeeman{{1, 0, 0}}), 0.1);
  Rkmk4<Spins> stepper(spins);
  integrate(exec, stepper, generator, spins, {0, 0.5, 3}, look);
  ASSERT_EQ(seen.size(), 4u);
  for (std::size_t i = 0; i < seen.size(); ++i)  // m turns about H, and towards it
    EXPECT_NEAR(seen[i], std::cos(0.5 * i) / std::cosh(0.05 * i), 1e-3) << i;
  integrate(exec, stepper, generator, spins, {1.5, 0.5, 1});
  EXPECT_NEAR(z_now(), std::cos(2.) / std::cosh(0.2), 1e-3);
}

// Constructors of terms and copies to the host get no instance from the caller, so they have to
// wait for all instances.
TYPED_TEST(Strictness, TermsAndCopiesWaitForWorkOnAnyInstance) {
  auto const other = Kokkos::Experimental::partition_space(HostDevice(), 1)[0];
  auto const lattice = Lattice::chain(4);
  Kokkos::View<TypeParam* [1], Kokkos::LayoutLeft, HostDeviceMemory> const twos("twos", 4);
  Kokkos::deep_copy(twos, TypeParam(2));
  using Numbers = ScalarField<TypeParam, HostDeviceMemory>;
  Numbers const copied("copied", lattice), damping("damping", lattice), constant("c", lattice);
  copy(other, twos, copied);
  EXPECT_EQ(copy_to_host(copied), std::vector<TypeParam>(4, TypeParam(2)));
  copy(other, twos, damping);
  EXPECT_TRUE(LandauLifshitz(EffectiveField(Zeeman{{1, 0, 0}}), damping).is_damped());

  auto const spins = [&] {
    typename TestFixture::Spins all("spins", lattice);
    copy_from_host(std::vector<TypeParam>{1, 0, 0, /**/ 0, 1, 0, /**/ 1, 0, 0, /**/ 0, 1, 0}, all);
    return all;
  }();
  typename TestFixture::Spins const field("field", lattice);
  copy(other, twos, constant);
  SiteDependentExchange const exchange(constant);
  evaluate_field(HostDevice(), exchange, spins, 0, field);
  auto const numbers = copy_to_host(field);
  EXPECT_EQ(numbers[0], -2);  // 2 * (m1 - m0) at the free end
  EXPECT_EQ(numbers[1], 2);
}

TYPED_TEST(Strictness, AnInstanceWaitsForItselfAlone) {
  using Numbers = Kokkos::View<TypeParam*, HostDeviceMemory>;
  auto const instances = Kokkos::Experimental::partition_space(HostDevice(), 1, 1);
  ASSERT_NE(instances[0], instances[1]);
  Numbers const there("there", 1);
  auto const here = Kokkos::create_mirror_view(there);
  Kokkos::deep_copy(instances[0], there, TypeParam(3));
  instances[1].fence();
  Kokkos::deep_copy(instances[1], here, there);
  instances[1].fence();
  EXPECT_EQ(here(0), 0);
  Kokkos::fence();
  Kokkos::deep_copy(here, there);
  EXPECT_EQ(here(0), 3);
}

}  // namespace
