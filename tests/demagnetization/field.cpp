// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The demagnetising field by FFTs against the sum over all pairs of cells, in both precisions.
#include "films.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace cayspin::test {
namespace {

template <class Real>
using HostSpins = SpinField<Real, Kokkos::HostSpace>;

/// Returns the distances along an axis from a cell to another cell and its images, and the weight
/// of each. `apart`: difference of the indices of the two cells.
std::vector<std::pair<double, double>> seen(Film const& film, std::size_t axis,
                                            std::int64_t apart) {
  int const n = static_cast<int>(film.shape[axis]), images = film.images[axis];
  auto nearest = static_cast<int>(apart);
  if (images == 0) return {{nearest * film.spacing[axis], 1}};
  while (2 * nearest > n) nearest -= n;
  while (2 * nearest < -n) nearest += n;
  std::vector<std::pair<double, double>> found;
  for (int image = -images; image <= images; ++image)
    if (2 * std::abs(nearest) == n)
      for (int const side : {1, -1})
        found.emplace_back((side * nearest + image * n) * film.spacing[axis], 0.5);
    else
      found.emplace_back((nearest + image * n) * film.spacing[axis], 1);
  return found;
}

template <class Real>
Vec3<double> summed(Film const& film, HostSpins<Real> const& spins, std::int64_t site) {
  auto const index = [&](std::int64_t i, std::size_t axis) {
    std::int64_t const strides[] = {1, film.shape[0], film.shape[0] * film.shape[1]};
    return i / strides[axis] % film.shape[axis];
  };
  Vec3<double> h{0, 0, 0};
  for (std::int64_t other = 0; other < spins.sites(); ++other) {
    auto const stored = spins.get(other);
    Vec3<double> const m{stored.x, stored.y, stored.z};
    auto const along = [&](std::size_t axis) {
      return seen(film, axis, index(site, axis) - index(other, axis));
    };
    for (auto const& [x, of_x] : along(0))
      for (auto const& [y, of_y] : along(1))
        for (auto const& [z, of_z] : along(2)) {
          auto const n = demagnetizing_tensor({x, y, z}, film.spacing);
          h -= of_x * of_y * of_z *
               Vec3<double>{n.xx * m.x + n.xy * m.y + n.xz * m.z,
                            n.xy * m.x + n.yy * m.y + n.yz * m.z,
                            n.xz * m.x + n.yz * m.y + n.zz * m.z};
        }
  }
  return h;
}

template <class Real>
class DemagnetizingFields : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DemagnetizingFields, Precisions);

TYPED_TEST(DemagnetizingFields, AreSumsOverAllCells) {
  using Real = TypeParam;
  for (auto const& film : films) {
    auto const lattice = film.lattice();
    auto const directions = random_directions(lattice.sites(), 3);
    auto const spins = spins_of<HostSpins<Real>>(lattice, directions);
    auto const field = field_on_host<Real>(lattice, directions, {2, film.images});
    double const limit = 80 * std::numeric_limits<Real>::epsilon();
    for (std::int64_t site = 0; site < lattice.sites(); ++site) {
      auto const expected = 2 * summed(film, spins, site);
      auto const h = field.get(site);
      ASSERT_NEAR(h.x, expected.x, limit) << site << " of " << lattice.shape[0];
      ASSERT_NEAR(h.y, expected.y, limit) << site << " of " << lattice.shape[0];
      ASSERT_NEAR(h.z, expected.z, limit) << site << " of " << lattice.shape[0];
    }
  }
}

std::vector<double> along_z(Lattice const& lattice) {
  std::vector<double> directions;
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    directions.insert(directions.end(), {0, 0, 1});
  return directions;
}

// The mean field in a uniformly magnetised cube is -1/3, however many cells it is divided into.
TYPED_TEST(DemagnetizingFields, OfAUniformCubeHaveItsMean) {
  using Real = TypeParam;
  auto const lattice = Lattice::cubic(20, 20, 20);
  auto const field = field_on_host<Real>(lattice, along_z(lattice));
  double mean = 0;
  for (std::int64_t site = 0; site < lattice.sites(); ++site) mean += field.get(site).z;
  EXPECT_NEAR(mean / static_cast<double>(lattice.sites()), -1. / 3,
              64 * std::numeric_limits<Real>::epsilon());
}

// A periodic film with m along its normal has H = -m, apart from the field of the images that are
// not summed.
TEST(DemagnetizingField, OfAPeriodicFilmIsThatOfASheet) {
  Film const film{{4, 4, 1}, {30, 30, 0}, {1, 1, 1}};
  auto const lattice = film.lattice();
  auto const field = field_on_host<double>(lattice, along_z(lattice), {1, film.images});
  double const edge = 61 * 4, beyond = 2 * std::sqrt(2.) / (std::numbers::pi * edge);
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    EXPECT_NEAR(field.get(site).z, beyond - 1, 1e-5);
}

TEST(DemagnetizingField, OfWhatItCannotTake) {
  using Field = DemagnetizingField<double>;
  auto const film = Lattice::square(4, 4);
  EXPECT_THROW(Field(Crystal::bcc().lattice({2, 2, 2})), std::invalid_argument);
  EXPECT_THROW(Field(film, {std::nan("")}), std::invalid_argument);
  EXPECT_THROW(Field(film, {1, {0, -1, 0}}), std::invalid_argument);
  DemagnetizingTensors of_larger;
  using Compute = std::function<DemagnetizingTensors()>;
  Field(Lattice::square(4, 5),
        {.kept = [&](Compute const& compute) { return of_larger = compute(); }});
  EXPECT_FALSE(of_larger.empty());
  EXPECT_THROW(Field(film, {.kept = [&](Compute const&) { return of_larger; }}),
               std::invalid_argument);
  HostSpins<double> const other("other", Lattice::square(4, 5));
  Field const of_film(film);
  EXPECT_THROW(of_film(other, other, 0), std::invalid_argument);
}

// Prints a hash of the bits for same_bits.cmake, which compares it for several numbers of threads.
TYPED_TEST(DemagnetizingFields, HaveBitsToCompare) {
  using Real = TypeParam;
  std::uint64_t hash = 0;
  for (auto const& lattice : {Lattice::cubic(13, 11, 9), Lattice::square(70, 53)}) {
    auto const field = field_on_host<Real>(lattice, random_directions(lattice.sites(), 5));
    for (Real const number : copy_to_host(field)) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &number, sizeof number);
      hash = (hash ^ bits) * 0x100000001b3u;
    }
  }
  EXPECT_NE(hash, 0u);
  std::printf("bits %016llx\n", static_cast<unsigned long long>(hash));
}

}  // namespace
}  // namespace cayspin::test
