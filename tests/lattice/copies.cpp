// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Copies of numbers into and out of fields, and the memory layout of fields.
#include "../support/backends.hpp"

#include <cstdint>

namespace cayspin::test {
namespace {

std::vector<Lattice> const lattices{Lattice::chain(1),        Lattice::chain(8),
                                    Lattice::chain(17),       Lattice::square(3, 5),
                                    Lattice::cubic(40, 3, 2), Lattice::cubic(1, 2, 7),
                                    Lattice::cubic(40, 4, 3)};

template <class Backend>
class Copies : public ::testing::Test {};
TYPED_TEST_SUITE(Copies, Backends, BackendName);

TYPED_TEST(Copies, FieldsStartAlongZ) {
  for (auto const& lattice : lattices) {
    auto const numbers = numbers_of(typename TypeParam::Spins("spins", lattice));
    ASSERT_EQ(static_cast<std::int64_t>(numbers.size()), 3 * lattice.sites());
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], i % 3 == 2 ? 1 : 0);
  }
  ScalarField<typename TypeParam::Real, typename TypeParam::MemorySpace> const scalar(
      "scalar", Lattice::chain(11), 2.5f);
  for (double const number : numbers_of(scalar)) EXPECT_EQ(number, 2.5);
}

TYPED_TEST(Copies, FromHostAndBack) {
  using Real = typename TypeParam::Real;
  for (auto const& lattice : lattices) {
    auto const numbers = random_directions(lattice.sites(), 7);
    auto const found = copy_to_host(spins_of<typename TypeParam::Spins>(lattice, numbers));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      EXPECT_EQ(found[i], static_cast<Real>(numbers[i])) << i;
  }
}

// Another execution space instance reads the field without a fence.
TYPED_TEST(Copies, FromHostIsOverWhenItReturns) {
  using Real = typename TypeParam::Real;
  auto const numbers = random_directions(33, 8);
  typename TypeParam::Spins const field("spins", Lattice::chain(33));
  Kokkos::View<Real* [3], typename TypeParam::MemorySpace> const view("view", 33);
  Kokkos::fence();
  copy_from_host(numbers, field);
  auto const other = Kokkos::Experimental::partition_space(typename TypeParam::Exec(), 1)[0];
  copy(other, field, view);
  other.fence();
  auto const found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    EXPECT_EQ(found(i / 3, i % 3), static_cast<Real>(numbers[i])) << i;
}

TYPED_TEST(Copies, SixComponents) {
  SiteField<typename TypeParam::Real, 6, typename TypeParam::MemorySpace> const field(
      "six", Lattice::square(9, 2));
  std::vector<float> numbers(6 * 18);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
  copy_from_host(numbers, field);
  auto const found = copy_to_host(field);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(found[i], numbers[i]);
}

template <class TypeParam, class Layout, class Number>
void round_trip() {
  using View = Kokkos::View<Number* [3], Layout, typename TypeParam::MemorySpace>;
  typename TypeParam::Exec const exec;
  for (auto const& lattice : lattices) {
    View const from("from", lattice.sites()), to("to", lattice.sites());
    auto const host = Kokkos::create_mirror_view(from);
    for (std::int64_t site = 0; site < lattice.sites(); ++site)
      for (int c = 0; c < 3; ++c) host(site, c) = static_cast<Number>(10 * site + c);
    Kokkos::deep_copy(from, host);
    typename TypeParam::Spins const spins("spins", lattice);
    copy(exec, from, spins);
    copy(exec, spins, to);
    exec.fence();
    auto const numbers = numbers_of(spins);
    auto const back = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), to);
    for (std::int64_t site = 0; site < lattice.sites(); ++site)
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(numbers[3 * site + c], 10.0 * site + c);
        EXPECT_EQ(back(site, c), static_cast<Number>(10 * site + c));
      }
  }
}

TYPED_TEST(Copies, ViewsOfEitherLayoutAndPrecision) {
  round_trip<TypeParam, Kokkos::LayoutLeft, double>();
  round_trip<TypeParam, Kokkos::LayoutRight, double>();
  round_trip<TypeParam, Kokkos::LayoutRight, float>();
}

// Handles share memory; swap exchanges lattices too.
TYPED_TEST(Copies, HandlesAndSwap) {
  using Spins = typename TypeParam::Spins;
  Spins a("a", Lattice::chain(3)), b("b", Lattice::square(2, 2));
  Spins const same = a;
  auto const numbers = random_directions(3, 3);
  copy_from_host(numbers, a);
  EXPECT_EQ(copy_to_host(same), copy_to_host(a));
  swap(a, b);
  EXPECT_EQ(a.sites(), 4);
  EXPECT_EQ(a.lattice(), Lattice::square(2, 2));
  EXPECT_EQ(copy_to_host(b), copy_to_host(same));
}

// Streaming stores and whole packs need rows and components that begin at a cache line. A pack that
// starts in a row never leaves the allocation.
TYPED_TEST(Copies, RowsLieOnCacheLines) {
  using Real = typename TypeParam::Real;
  auto const line = static_cast<std::ptrdiff_t>(detail::cache_line_bytes / sizeof(Real));
  for (auto const& lattice : lattices) {
    typename TypeParam::Spins const spins("spins", lattice);
    auto const& layout = spins.layout();
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(spins.array().data) % detail::cache_line_bytes, 0U);
    EXPECT_EQ(layout.pitch % line, 0);
    EXPECT_GE(layout.pitch, lattice.shape[0]);
    EXPECT_EQ(layout.component_stride / line % 2, 1);
    EXPECT_EQ(layout.plane % line, 0);
    EXPECT_GE(layout.plane, layout.ny * layout.pitch);
    if (layout.nx > line && layout.nz > 1) {
      EXPECT_EQ(layout.plane / line % 2, 1);
    }
    EXPECT_GE(layout.component_stride, layout.nz * layout.plane);
    EXPECT_GE(layout.origin, 1);
    EXPECT_GE(static_cast<std::ptrdiff_t>(spins.allocation().size()),
              layout.origin + 3 * layout.component_stride + line);
  }
}

// Bonds read rows of several planes at once. If planes were whole pages apart, these rows would
// compete for the same cache sets.
TEST(Layouts, PlanesAreNoWholePagesApart) {
  for (std::int64_t const nx : {17, 32, 64, 100})
    for (std::int64_t const ny : {16, 31, 32, 64, 128}) {
      auto const layout = RowLayout::of<double>(Lattice::cubic(nx, ny, 2));
      auto const lines = layout.plane * 8 / detail::cache_line_bytes, least = ny * layout.pitch / 8;
      EXPECT_LE(lines, least + least / 4 + 1) << nx << " " << ny;
      if (lines < 64) continue;
      EXPECT_GE(lines % 64, 64 / 6) << nx << " " << ny;
      EXPECT_LE(lines % 64, 64 - 64 / 6) << nx << " " << ny;
    }
}

template <class Spins>
void expect_get_and_set(Lattice const& lattice) {
  if constexpr (std::is_same_v<typename Spins::memory_space, Kokkos::HostSpace>) {
    auto const numbers = random_directions(lattice.sites(), 5);
    auto const spins = spins_of<Spins>(lattice, numbers);
    Spins const other("other", lattice);
    for (std::int64_t site = 0; site < lattice.sites(); ++site) other.set(site, spins.get(site));
    EXPECT_EQ(copy_to_host(other), copy_to_host(spins));
  }
}

TYPED_TEST(Copies, SingleSitesInHostMemory) {
  for (auto const& lattice : lattices) expect_get_and_set<typename TypeParam::Spins>(lattice);
}

}  // namespace
}  // namespace cayspin::test
