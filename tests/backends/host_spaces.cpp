// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Trajectories and reductions have the same bits on Serial and on the threaded space.
#include "../support/coefficients.hpp"
#include "equal_bits.hpp"

#include <cstdlib>

using namespace cayspin;
using namespace cayspin::test;

namespace {

static_assert(!std::is_same_v<Threaded, Kokkos::Serial>);

constexpr auto natural = [](Slab const& slab) { return slab.natural(); };
constexpr auto orthogonal_part = [](Slab const& slab) { return slab.orthogonal(); };

TEST(HostSpacesSetting, ThreadsAsAskedFor) {
  if (char const* const count = std::getenv("OMP_NUM_THREADS")) {
    EXPECT_EQ(Threaded().concurrency(), std::atoi(count));
  }
}

template <class Real>
struct HostSpaces : ::testing::Test {
  using Field = SpinField<Real, Kokkos::HostSpace>;
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(HostSpaces, Precisions);

TYPED_TEST(HostSpaces, LieEuler) {
  expect_same_on_host_spaces<LieEuler<typename TestFixture::Field>>(natural);
}

TYPED_TEST(HostSpaces, Rkmk4) {
  expect_same_on_host_spaces<Rkmk4<typename TestFixture::Field>>(natural);
}

TYPED_TEST(HostSpaces, Rkmk4Orthogonal) {
  expect_same_on_host_spaces<Rkmk4<typename TestFixture::Field>>(orthogonal_part);
}

TYPED_TEST(HostSpaces, Rkmk4Exponential) {
  expect_same_on_host_spaces<Rkmk4<typename TestFixture::Field, isotropy::Zero, Exponential>>(
      natural);
}

// Coefficients that differ from site to site, and vacancies.
TYPED_TEST(HostSpaces, SiteDependentCoefficients) {
  using Field = typename TestFixture::Field;
  expect_same_on_host_spaces<Rkmk4<Field>>([](Slab const& slab) {
    auto const& lattice = slab.lattice;
    EffectiveField const field(
        SiteDependentExchange(
            numbers_on<Field>(lattice, [](auto site) { return 0.1 * (site % 8); })),
        SiteDependentUniaxialAnisotropy(
            numbers_on<Field>(lattice, [](auto site) { return 0.4 - 0.1 * (site % 9); }),
            random_spins<Field>(lattice, 3)),
        Zeeman{slab.applied});
    return LandauLifshitz(
        FieldWithVacancies(
            field, numbers_on<Field>(lattice, [](auto site) { return site % 6 == 1 ? 0 : 1; })),
        numbers_on<Field>(lattice, [](auto site) { return 0.05 * (site % 5); }));
  });
}

TYPED_TEST(HostSpaces, ProjectedRk4) {
  expect_same_on_host_spaces<ProjectedRk4<typename TestFixture::Field>>(natural);
}

}  // namespace
