// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Ranges of one, two and three dimensions on the emulated device: each index is visited once, and
// not before the fence.
#include "../support/backends.hpp"

using namespace cayspin::test;

namespace {

using Counts = Kokkos::View<int***, Kokkos::LayoutLeft, HostDeviceMemory>;
constexpr int extents[3] = {37, 19, 11}, begins[3] = {3, 2, 5};

template <class Index>
struct CountVisits {
  Counts counts;
  template <class Given>
  KOKKOS_FUNCTION void operator()(Given x, Given y, Given z) const {
    ++counts(x, y, z);
  }
  template <class Given>
  KOKKOS_FUNCTION void operator()(Given x, Given y) const {
    ++counts(x, y, begins[2]);
  }
  template <class Given>
  KOKKOS_FUNCTION void operator()(Given x) const {
    static_assert(std::is_same_v<Given, Index>);
    ++counts(x, begins[1], begins[2]);
  }
};

template <class Policy>
void expect_each_index_once(int rank, Policy const& policy) {
  Counts const counts("counts", extents[0], extents[1], extents[2]);
  auto const here = Kokkos::create_mirror_view(counts);
  HostDevice const exec;
  Kokkos::parallel_for("cayspin::test::count_visits", policy,
                       CountVisits<typename Policy::index_type>{counts});
  Kokkos::deep_copy(exec, here, counts);
  EXPECT_EQ(here(begins[0], begins[1], begins[2]), 0) << "before the fence";
  exec.fence();
  for (int x = 0; x < extents[0]; ++x)
    for (int y = 0; y < extents[1]; ++y)
      for (int z = 0; z < extents[2]; ++z) {
        bool const inside = x >= begins[0] && (rank > 1 ? y >= begins[1] : y == begins[1]) &&
                            (rank > 2 ? z >= begins[2] : z == begins[2]);
        ASSERT_EQ(here(x, y, z), inside) << x << ' ' << y << ' ' << z;
      }
}

template <class Index>
struct Ranges : ::testing::Test {};
using Indices = ::testing::Types<std::int32_t, std::int64_t>;
TYPED_TEST_SUITE(Ranges, Indices);

TYPED_TEST(Ranges, OfOneDimension) {
  using Policy = Kokkos::RangePolicy<HostDevice, Kokkos::IndexType<TypeParam>>;
  expect_each_index_once(1, Policy(HostDevice(), begins[0], extents[0]));
}

TYPED_TEST(Ranges, OfTwoDimensions) {
  using Policy = Kokkos::MDRangePolicy<HostDevice, Kokkos::Rank<2>, Kokkos::IndexType<TypeParam>>;
  expect_each_index_once(2, Policy(HostDevice(), {begins[0], begins[1]}, {extents[0], extents[1]}));
}

TYPED_TEST(Ranges, OfThreeDimensions) {
  using Policy = Kokkos::MDRangePolicy<HostDevice, Kokkos::Rank<3>, Kokkos::IndexType<TypeParam>>;
  expect_each_index_once(3, Policy(HostDevice(), {begins[0], begins[1], begins[2]},
                                   {extents[0], extents[1], extents[2]}));
  expect_each_index_once(3, Policy(HostDevice(), {begins[0], begins[1], begins[2]},
                                   {extents[0], extents[1], extents[2]}, {4, 4, 2}));
}

}  // namespace
