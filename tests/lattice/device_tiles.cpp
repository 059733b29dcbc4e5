// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// How the threads of a device find their sites and the memory of these sites and their neighbours,
// and how they compute quotients.
#include <cayspin/detail/device_site.hpp>
#include <cayspin/detail/device_tiles.hpp>
#include <cayspin/detail/quotient.hpp>
#include <cayspin/detail/unrolled.hpp>

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace cayspin::test {
namespace {

TEST(DeviceTiles, QuickDivisionIsExact) {
  std::uint32_t const most = std::numeric_limits<std::int32_t>::max();
  std::mt19937 random(1);
  std::vector<std::uint32_t> divisors{1, 2, 3, 5, 6, 7, 9, 641, 65535, 65537, most - 1, most};
  for (int bit = 2; bit < 31; ++bit)
    for (std::uint32_t const near : {0u, 1u, 2u}) divisors.push_back((1u << bit) - 1 + near);
  std::uniform_int_distribution<std::uint32_t> any(1, most);
  for (int i = 0; i < 200; ++i) divisors.push_back(any(random));
  for (std::uint32_t const divisor : divisors) {
    detail::QuickDivision const quick(divisor);
    std::vector<std::uint32_t> numbers{0, 1, divisor - 1, divisor, most - 1, most};
    for (int i = 0; i < 200; ++i) {
      std::uint32_t const multiple = any(random) % (most / divisor + 1) * divisor;
      numbers.insert(numbers.end(), {multiple, multiple > 0 ? multiple - 1 : 0});
    }
    for (std::uint32_t const number : numbers)
      EXPECT_EQ(quick(number), number / divisor) << number << " / " << divisor;
  }
}

std::size_t number_of(std::array<std::int32_t, 3> const& shape, std::int32_t x, std::int32_t y,
                      std::int32_t z) {
  return static_cast<std::size_t>((std::int64_t(z) * shape[1] + y) * shape[0] + x);
}

/// Returns how often each site of the shape is visited by the threads that cover `rows`.
std::vector<int> visits(std::array<std::int32_t, 3> const& shape, RowRange const& rows) {
  std::vector<int> count(number_of(shape, 0, 0, shape[2]));
  detail::DeviceTiles const tiles(shape[0], rows);
  auto const visit = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    EXPECT_TRUE(0 <= x && x < shape[0] && 0 <= y && y < shape[1] && 0 <= z && z < shape[2]);
    ++count.at(number_of(shape, x, y, z));
  };
  for (std::int64_t thread = 0; thread < tiles.thread_count(); ++thread)
    tiles.for_each(thread, visit);
  return count;
}

TEST(DeviceTiles, EachSiteOfARangeOnce) {
  for (auto const& [shape, rows] :
       std::vector<std::pair<std::array<std::int32_t, 3>,
                             RowRange>>{{{1, 1, 1}, {0, 1, 0, 1}},
                                        {{2, 1, 1}, {0, 1, 0, 1}},
                                        {{129, 1, 1}, {0, 1, 0, 1}},
                                        {{1, 200, 1}, {0, 200, 0, 1}},
                                        {{1, 1, 9}, {0, 1, 0, 9}},
                                        {{5, 7, 3}, {0, 7, 0, 3}},
                                        {{33, 6, 4}, {2, 5, 1, 3}},
                                        {{31, 9, 6}, {8, 9, 5, 6}},
                                        {{257, 130, 67}, {0, 130, 0, 67}},  // walks of 4
                                        {{257, 130, 150},
                                         {3, 129, 2, 147}}})  // walks of 8, not all complete
  {
    auto const count = visits(shape, rows);
    for (std::int32_t z = 0; z < shape[2]; ++z)
      for (std::int32_t y = 0; y < shape[1]; ++y)
        for (std::int32_t x = 0; x < shape[0]; ++x) {
          bool const inside =
              rows.y_begin <= y && y < rows.y_end && rows.z_begin <= z && z < rows.z_end;
          ASSERT_EQ(count.at(number_of(shape, x, y, z)), inside)
              << x << " " << y << " " << z << " of " << shape[0] << " " << shape[1];
        }
  }
}

/// Returns the offset of a site's neighbour, computed from the definition; at an open end, that of
/// the site.
std::int64_t beside(RowLayout const& layout, std::array<std::int32_t, 3> at, int axis, int step) {
  auto const along = static_cast<std::size_t>(axis);
  std::int32_t const extent = std::array{layout.nx, layout.ny, layout.nz}[along];
  std::int32_t& index = at[along];
  if (layout.periodic[axis])
    index = (index + step + extent) % extent;
  else if (0 <= index + step && index + step < extent)
    index += step;
  return layout.row_offset(at[1], at[2]) + at[0];
}

template <class Index, int Axis, int Direction>
void expect_neighbor(RowLayout const& layout, std::array<std::int32_t, 3> const& at,
                     SiteArray<double, 1> const& numbers) {
  detail::DeviceLayout<Index> const known(layout);
  detail::DeviceSite<double, Index> const site(known, at[0], at[1], at[2]);
  std::int64_t const expected = beside(layout, at, Axis, 2 * Direction - 1);
  EXPECT_EQ(site.offset(), beside(layout, at, Axis, 0));
  EXPECT_EQ((site.template neighbor<Axis, Direction>(numbers, 0)), expected)
      << at[0] << " " << at[1] << " " << at[2] << " along " << Axis;
  if constexpr (Axis == 0) {
    bool const is_end = at[0] == (Direction == 0 ? 0 : layout.nx - 1);
    Vec3<double> const found{1, 1, 1}, missing{2, 2, 2};
    EXPECT_EQ((site.template unless_past_end<Direction>(found, missing).x),
              is_end && !layout.periodic[0] ? 2 : 1);
  } else {
    EXPECT_EQ((site.template has_neighbor<Axis, Direction>()), expected != site.offset());
  }
}

template <class Index>
void expect_neighbors(RowLayout const& layout, SiteArray<double, 1> const& numbers,
                      std::array<std::int32_t, 3> const& at) {
  detail::unrolled<3>([&](auto axis) {
    expect_neighbor<Index, axis(), 0>(layout, at, numbers);
    expect_neighbor<Index, axis(), 1>(layout, at, numbers);
  });
}

TEST(DeviceSites, NeighborsAtAllEnds) {
  for (std::array<std::int64_t, 3> const shape :
       {std::array<std::int64_t, 3>{1, 1, 1}, {2, 2, 2}, {5, 1, 3}, {3, 4, 1}, {17, 3, 4}})
    for (int ends = 0; ends < 8; ++ends) {
      Lattice lattice{shape};
      for (std::size_t axis = 0; axis < 3; ++axis)
        lattice.boundary[axis] = ends >> axis & 1 ? Boundary::periodic : Boundary::open;
      auto const layout = RowLayout::of<double>(lattice);
      std::vector<double> offsets(static_cast<std::size_t>(layout.component_stride));
      std::iota(offsets.begin(), offsets.end(), 0.);
      SiteArray<double, 1> const numbers{offsets.data(), layout.component_stride};
      for (std::int32_t z = 0; z < layout.nz; ++z)
        for (std::int32_t y = 0; y < layout.ny; ++y)
          for (std::int32_t x = 0; x < layout.nx; ++x) {
            expect_neighbors<std::int32_t>(layout, numbers, {x, y, z});
            expect_neighbors<std::int64_t>(layout, numbers, {x, y, z});
          }
    }
}

/// Returns a layout of nz planes of 2^20 numbers, for which no memory is allocated.
RowLayout large_layout(std::int32_t nz) {
  RowLayout layout;
  layout.nx = layout.ny = 1 << 10;
  layout.pitch = layout.nx;
  layout.plane = layout.ny * layout.pitch;
  layout.nz = layout.replica_planes = nz;
  return layout;
}

TEST(DeviceSites, LongIndicesWhereNumbersNeedThem) {
  // reaches() counts one plane more than there is, and 2^11 planes have 2^31 numbers, too many for
  // an int32.
  std::int32_t const most = (1 << 11) - 2;
  using Short = detail::DeviceLayout<std::int32_t>;
  auto const fits = large_layout(most), beyond = large_layout(most + 1);
  EXPECT_TRUE(Short::reaches(fits, 1));
  EXPECT_FALSE(Short::reaches(beyond, 1));
  EXPECT_FALSE(Short::reaches(fits, std::int64_t(1) << 31));
  EXPECT_TRUE(detail::DeviceLayout<std::int64_t>::reaches(beyond, std::int64_t(1) << 31));

  for (auto const& layout : {fits, beyond, large_layout(1 << 12)}) {
    detail::DeviceLayout<std::int64_t> const known(layout);
    detail::DeviceSite<double, std::int64_t> const last(known, layout.nx - 1, layout.ny - 1,
                                                        layout.nz - 1);
    EXPECT_EQ(last.offset(), layout.sites() - 1);
  }
  Short const known(fits);
  detail::DeviceSite<double, std::int32_t> const last(known, fits.nx - 1, fits.ny - 1, fits.nz - 1);
  EXPECT_EQ(last.offset(), fits.sites() - 1);
}

TEST(DeviceTiles, NoThreadsWithoutSites) {
  EXPECT_EQ(detail::DeviceTiles(0, {0, 0, 0, 0}).thread_count(), 0);
  EXPECT_EQ(detail::DeviceTiles(5, {2, 2, 0, 3}).thread_count(), 0);
  EXPECT_EQ(detail::DeviceTiles(5, {0, 3, 1, 1}).thread_count(), 0);
}

TEST(DeviceTiles, ManyThreadsOfALongChain) {
  // For 2^28 sites along z each tile has 128 threads, most of which have no site.
  detail::DeviceTiles const tiles(1, {0, 1, 0, 1 << 28});
  EXPECT_GT(tiles.thread_count(), std::numeric_limits<std::int32_t>::max());
  std::int64_t met = 0;
  auto const last = tiles.thread_count() - 128;  // the first thread of the last tile
  tiles.for_each(last, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    EXPECT_EQ(x, 0);
    EXPECT_EQ(y, 0);
    EXPECT_EQ(z, (1 << 28) - 8 + met++);
  });
  EXPECT_EQ(met, 8);
}

/// Returns 1 / b with only `bits` bits after the leading one, like a device's approximation.
template <class Real, class Bits>
Real rough_inverse(Real b, int bits) {
  Bits const dropped = (Bits(1) << (std::numeric_limits<Real>::digits - 1 - bits)) - 1;
  return std::bit_cast<Real>(std::bit_cast<Bits>(1 / b) & ~dropped);
}

template <class Real, class Bits>
void expect_quotients(int bits) {
  std::mt19937 random(2);
  std::uniform_real_distribution<Real> mantissa(1, 2);
  std::uniform_int_distribution<int> exponent(-std::numeric_limits<Real>::max_exponent / 4,
                                              std::numeric_limits<Real>::max_exponent / 4);
  for (int i = 0; i < 100000; ++i) {
    Real const a = std::ldexp(mantissa(random), exponent(random));
    Real const b = std::ldexp(mantissa(random), exponent(random));
    Real const found = detail::refined_quotient(a, b, rough_inverse<Real, Bits>(b, bits));
    Real const exact = a / b, unit = std::nextafter(exact, 2 * exact) - exact;
    ASSERT_LE(std::abs(found - exact), unit) << a << " / " << b;
  }
}

TEST(Quotient, WithinAUnitInTheLastPlace) {
  expect_quotients<double, std::uint64_t>(18);
  expect_quotients<float, std::uint32_t>(18);
}

}  // namespace
}  // namespace cayspin::test
