// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The field of a crystal's dipoles by FFTs against sums over all pairs.
#include "../support/larger.hpp"
#include "crystals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

namespace cayspin::test {
namespace {

Vec3<double> dipole(Crystal::Point const& r, Vec3<double> const& m) {
  double const r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], r5 = r2 * r2 * std::sqrt(r2);
  double const along = 3 * (r[0] * m.x + r[1] * m.y + r[2] * m.z);
  return 1 / (4 * std::numbers::pi * r5) *
         Vec3<double>{along * r[0] - r2 * m.x, along * r[1] - r2 * m.y, along * r[2] - r2 * m.z};
}

template <class Real>
struct Evaluated {
  using Spins = SpinField<Real, Kokkos::HostSpace>;
  Spins spins, field;

  // Gives the moments different lengths. The second evaluation uses work memory left by the first.
  Evaluated(Sample const& sample, DipolarOptions const& options,
            std::vector<double> const& directions)
      : spins(spins_of<Spins>(sample.lattice(), directions)), field("field", sample.lattice()) {
    for (std::int64_t site = 0; site < spins.sites(); ++site) {
      auto const m = spins.get(site);
      spins.set(site, Real(0.5 + 0.25 * (site % 5)) * m);
    }
    DipolarField<Real> const dipoles(sample.lattice(), sample.crystal, options);
    for (int again = 0; again < 2; ++again) dipoles(spins, field, 0);
  }
  Evaluated(Sample const& sample, DipolarOptions const& options)
      : Evaluated(sample, options, random_directions(sample.lattice().sites(), 7)) {}

  Vec3<double> m(std::int64_t site) const { return in_double(spins.get(site)); }
  Vec3<double> h(std::int64_t site) const { return in_double(field.get(site)); }
  static Vec3<double> in_double(Vec3<Real> const& v) { return {v.x, v.y, v.z}; }
};

/// Returns the largest error of the field, relative to the largest field.
template <class Real, class Sum>
double largest_error(Evaluated<Real> const& found, Sum const& expected) {
  double error = 0, largest = 0;
  for (std::int64_t site = 0; site < found.spins.sites(); ++site) {
    auto const h = expected(site), off = found.h(site) - h;
    error = larger(error, std::sqrt(dot(off, off)));
    largest = larger(largest, std::sqrt(dot(h, h)));
  }
  return error / largest;
}

template <class Real>
class DipolarFields : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DipolarFields, Precisions);

TYPED_TEST(DipolarFields, OfOpenCrystalsAreSumsOverPairs) {
  using Real = TypeParam;
  for (auto const& sample : open_crystals) {
    Evaluated<Real> const found(sample, {.strength = 1.5});
    auto const expected = [&](std::int64_t site) {
      auto const at = sample.place(site);
      Vec3<double> h{0, 0, 0};
      for (std::int64_t other = 0; other < found.spins.sites(); ++other) {
        if (other == site) continue;
        auto r = sample.place(other);
        for (std::size_t axis = 0; axis < 3; ++axis) r[axis] = at[axis] - r[axis];
        h = h + dipole(r, found.m(other));
      }
      return 1.5 * sample.volume() * h;
    };
    EXPECT_LT(largest_error(found, expected), 40 * std::numeric_limits<Real>::epsilon())
        << sample.crystal.basis.size() << " sites, " << sample.cells[0];
  }
}

// Images less than periodic_images + 1/2 periods away are summed; those at exactly this distance
// count half.
TYPED_TEST(DipolarFields, SumSomeImages) {
  using Real = TypeParam;
  for (auto const& sample : {open_crystals[2], open_crystals[4], open_crystals[6]})
    for (auto const& images : {Images{1, 0, 0}, {0, 2, 1}, {1, 1, 1}}) {
      Evaluated<Real> const found(sample, {.periodic_images = images});
      auto const& [nx, ny, nz] = sample.cells;
      auto const basis = static_cast<std::int64_t>(sample.crystal.basis.size());
      auto const cell_of = [&](std::int64_t site) {
        return Numbers{site % nx, site / nx % ny, site / (nx * ny) / basis};
      };
      auto const expected = [&](std::int64_t site) {
        Vec3<double> h{0, 0, 0};
        auto const at = sample.place(site);
        for (std::int64_t other = 0; other < found.spins.sites(); ++other)
          for (int i = -3; i <= 3; ++i)
            for (int j = -3; j <= 3; ++j)
              for (int k = -3; k <= 3; ++k) {
                double weight = 1;
                Crystal::Point r = sample.place(other);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                  int const image = std::array{i, j, k}[axis];
                  if (images[axis] == 0 && image != 0) weight = 0;
                  double const n = static_cast<double>(sample.cells[axis]);
                  double const apart = static_cast<double>(cell_of(site)[axis]) -
                                       static_cast<double>(cell_of(other)[axis]) - image * n;
                  double const end = (images[axis] + 0.5) * n;
                  if (images[axis] > 0 && std::abs(apart) >= end)
                    weight *= std::abs(apart) == end ? 0.5 : 0;
                  for (std::size_t c = 0; c < 3; ++c)
                    r[c] += image * n * sample.crystal.cell[axis][c] * sample.spacing[c];
                }
                if (weight == 0) continue;
                for (std::size_t c = 0; c < 3; ++c) r[c] = at[c] - r[c];
                if (r == Crystal::Point{0, 0, 0}) continue;
                h = h + weight * dipole(r, found.m(other));
              }
        return sample.volume() * h;
      };
      EXPECT_LT(largest_error(found, expected), 60 * std::numeric_limits<Real>::epsilon())
          << sample.crystal.basis.size() << " sites, " << images[0] << images[1] << images[2];
    }
}

// The field does not change if the lattice has two periods along each periodic axis, with repeated
// spins.
TYPED_TEST(DipolarFields, OfPeriodicCrystalsAreThoseOfLargerOnes) {
  using Real = TypeParam;
  for (auto const& sample : open_crystals)
    for (auto const& images : {Images{all, 0, 0},
                               {0, all, 0},
                               {all, all, 0},
                               {0, all, all},
                               {all, 0, all},
                               {all, all, all}}) {
      auto twice = sample;
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (images[axis] > 0) twice.cells[axis] *= 2;
      auto const few = random_directions(sample.lattice().sites(), 7);
      auto const basis = static_cast<std::int64_t>(sample.crystal.basis.size());
      auto const& n = sample.cells;
      auto const inside = [&](std::int64_t site) {
        auto const& many = twice.cells;
        std::int64_t const x = site % many[0] % n[0], y = site / many[0] % many[1] % n[1];
        std::int64_t const plane = site / (many[0] * many[1]);
        return ((plane / basis % n[2] * basis + plane % basis) * n[1] + y) * n[0] + x;
      };
      DipolarOptions const options{.periodic_images = images};
      Evaluated<Real> const one(sample, options, few);
      using Spins = typename Evaluated<Real>::Spins;
      Spins spins("spins", twice.lattice()), field("field", twice.lattice());
      for (std::int64_t site = 0; site < spins.sites(); ++site)
        spins.set(site, one.spins.get(inside(site)));
      DipolarField<Real>(twice.lattice(), twice.crystal, options)(spins, field, 0);
      double error = 0;
      for (std::int64_t site = 0; site < spins.sites(); ++site) {
        auto const off = Evaluated<Real>::in_double(field.get(site)) - one.h(inside(site));
        error = larger(error, std::sqrt(dot(off, off)));
      }
      EXPECT_LT(error, 400 * std::numeric_limits<Real>::epsilon())
          << basis << " sites, " << images[0] << " " << images[1] << " " << images[2];
    }
}

// The matrix from spins to fields is symmetric, so that E = -m.H/2 has the derivative -H.
TYPED_TEST(DipolarFields, AreSymmetric) {
  using Real = TypeParam;
  for (auto const& sample : open_crystals)
    for (auto const& images : {Images{}, {1, 0, 2}, {all, all, 0}, {all, all, all}}) {
      DipolarOptions const options{.periodic_images = images};
      auto const sites = sample.lattice().sites();
      Evaluated<Real> const a(sample, options), b(sample, options, random_directions(sites, 8));
      double first = 0, second = 0;
      for (std::int64_t site = 0; site < sites; ++site) {
        first += dot(a.m(site), b.h(site));
        second += dot(b.m(site), a.h(site));
      }
      EXPECT_NEAR(first, second,
                  4 * static_cast<double>(sites) * std::numeric_limits<Real>::epsilon());
    }
}

TYPED_TEST(DipolarFields, HaveBitsToCompare) {
  using Real = TypeParam;
  std::uint64_t bits = 14695981039346656037U;
  for (auto const& images : {Images{}, {all, all, 0}, {all, all, all}}) {
    Evaluated<Real> const found(open_crystals[1], {.periodic_images = images});
    for (std::int64_t site = 0; site < found.field.sites(); ++site) {
      auto const h = found.field.get(site);
      for (Real const component : {h.x, h.y, h.z}) {
        std::uint64_t word = 0;
        std::memcpy(&word, &component, sizeof(Real));
        bits = (bits ^ word) * 1099511628211U;
      }
    }
  }
  std::printf("bits %016llx\n", static_cast<unsigned long long>(bits));
}

TEST(DipolarFieldsOfOneLattice, RefuseWhatDoesNotFit) {
  auto const bcc = Crystal::bcc();
  auto const lattice = bcc.lattice({2, 2, 2});
  using Field = DipolarField<double>;
  EXPECT_THROW(Field(lattice, Crystal::fcc()), std::invalid_argument);
  EXPECT_THROW(Field(lattice, bcc, {.periodic_images = {-1, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(Field(lattice, bcc, {.periodic_images = {1, all, 0}}), std::invalid_argument);
  Crystal const flat{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1e-5}}}, {{0, 0, 0}}};
  EXPECT_THROW(Field(flat.lattice({2, 2, 1}), flat, {.periodic_images = {all, all, all}}),
               std::invalid_argument);
  EXPECT_THROW(Field(lattice, bcc, {.strength = std::numeric_limits<double>::infinity()}),
               std::invalid_argument);
  EXPECT_THROW(Field(lattice, bcc, {.demagnetizing_factors = {0, 0, std::nan("")}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
