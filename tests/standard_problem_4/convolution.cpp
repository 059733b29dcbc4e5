// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The convolution by FFTs against the sum over all pairs of cells, in both precisions.
#include "../../examples/standard_problem_4/demagnetising_field.hpp"
#include "../../examples/standard_problem_4/newell.hpp"

#include <cayspin/cayspin.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace cayspin;

namespace {

using Vector = Vec3<double>;

std::vector<Vector> direct_sum(Lattice const& lattice, std::vector<Vector> const& m) {
  auto const index = [&](std::int64_t site) {
    return std::array<std::int64_t, 3>{site % lattice.shape[0],
                                       site / lattice.shape[0] % lattice.shape[1],
                                       site / (lattice.shape[0] * lattice.shape[1])};
  };
  std::vector<Vector> field(m.size(), {0, 0, 0});
  for (std::size_t i = 0; i < m.size(); ++i)
    for (std::size_t j = 0; j < m.size(); ++j) {
      auto const a = index(static_cast<std::int64_t>(i)), b = index(static_cast<std::int64_t>(j));
      std::array<double, 3> r{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        r[axis] = static_cast<double>(a[axis] - b[axis]) * lattice.spacing[axis];
      Tensor const n = newell::tensor(r, lattice.spacing);
      Vector const& s = m[j];
      field[i] -= Vector{n.xx * s.x + n.xy * s.y + n.xz * s.z, n.xy * s.x + n.yy * s.y + n.yz * s.z,
                         n.xz * s.x + n.yz * s.y + n.zz * s.z};
    }
  return field;
}

template <class Real>
class DemagnetisingFieldTest : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DemagnetisingFieldTest, Precisions);

TYPED_TEST(DemagnetisingFieldTest, IsTheSumOverAllCells) {
  using Real = TypeParam;
  for (Lattice const& lattice : {Lattice{.shape = {6, 5, 3}, .spacing = {2, 1.5, 1}},
                                 Lattice{.shape = {7, 4, 1}, .spacing = {1, 1, 3}},
                                 Lattice{.shape = {1, 1, 5}, .spacing = {1, 2, 1}}}) {
    SpinField<Real, Kokkos::HostSpace> spins("spins", lattice), field("field", lattice);
    std::mt19937 random(7);
    std::normal_distribution<double> number;
    std::vector<Vector> m;
    for (std::int64_t site = 0; site < lattice.sites(); ++site) {
      spins.set(site, {static_cast<Real>(number(random)), static_cast<Real>(number(random)),
                       static_cast<Real>(number(random))});
      auto const stored = spins.get(site);
      m.push_back({stored.x, stored.y, stored.z});
    }
    DemagnetisingField const demag(lattice, newell::tensor);
    demag(spins, field, 0);  // work memory starts as the first call leaves it
    demag(spins, field, 0);
    auto const expected = direct_sum(lattice, m);
    for (std::size_t site = 0; site < m.size(); ++site) {
      auto const h = field.get(static_cast<std::int64_t>(site));
      double const limit = 4 * std::numeric_limits<Real>::epsilon() + 1e-14;
      EXPECT_NEAR(h.x, expected[site].x, limit);
      EXPECT_NEAR(h.y, expected[site].y, limit);
      EXPECT_NEAR(h.z, expected[site].z, limit);
    }
  }
}

TEST(DemagnetisingFieldUses, RefusesPeriodicBoundaries) {
  EXPECT_THROW(DemagnetisingField(Lattice::square(4, 4, 1, Boundary::periodic), newell::tensor),
               std::invalid_argument);
}

}  // namespace
