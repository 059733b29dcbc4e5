// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A skyrmion that slides: its energy depends on its position by a few parts in 1e9.
#include "films.hpp"

#include <numbers>

namespace cayspin::test {
namespace {

constexpr std::int64_t columns = 16;
using Host = SpinField<double, Kokkos::HostSpace>;

Host skyrmion(Lattice const& lattice, double x, double y) {
  std::vector<double> m;
  for (std::int64_t j = 0; j < columns; ++j)
    for (std::int64_t i = 0; i < columns; ++i) {
      double const r = std::hypot(i - x, j - y), turn = std::max(0.0, 1 - r / 6.5);
      double const sine = std::sin(std::numbers::pi * turn) / std::max(r, 1e-9);
      for (double const c : {-sine * (j - y), sine * (i - x), std::cos(std::numbers::pi * turn)})
        m.push_back(c);
    }
  return spins_of<Host>(lattice, m);
}

template <class Field>
void expect_minimum(Lattice const& lattice, Field const& field, double parallel) {
  Kokkos::DefaultHostExecutionSpace const exec;
  for (auto const& [x, y] : {std::pair{7.5, 7.5}, {8.0, 7.5}, {7.5, 8.0}, {8.0, 8.0}}) {
    SCOPED_TRACE(::testing::Message() << "centre " << x << ", " << y);
    bool const is_minimum = x == 8 && y == 8;
    auto spins = skyrmion(lattice, x, y);
    auto const saddle = minimize(exec, field, spins, {.torque = 1e-9, .keep_saddles = true});
    ASSERT_EQ(saddle.end, MinimizeEnd::converged);
    if (!is_minimum) {
      EXPECT_GT(saddle.energy.value, parallel - 729.691499 + 4e-6);
    }
    auto const found = minimize(exec, field, spins, {.torque = 1e-9});
    EXPECT_EQ(found.end, MinimizeEnd::converged);
    EXPECT_EQ(found.saddles, is_minimum ? 0 : 1);
    EXPECT_LT(found.torque, 1e-9);
    EXPECT_LE(found.evaluations, 250);
    EXPECT_NEAR(found.energy.value, parallel - 729.691499, 1e-6);
    EXPECT_NEAR(magnetization(exec, spins).z, 0.799759, 1e-6);
    EXPECT_NEAR(found.curvature, 1.085e-5, 1e-7);
  }
}

TEST(SlidingSkyrmion, LeavesTheSaddlesOfItsPosition) {
  Lattice const lattice{
      {columns, columns, 1}, {1, 1, 1}, {Boundary::periodic, Boundary::periodic, Boundary::open}};
  Zeeman const applied{{0, 0, 2.894190905}};
  expect_minimum(lattice, EffectiveField(Exchange(lattice, 10), BulkDmi(lattice, 6), applied), 0);
  std::vector<Coupling> const bonds{Coupling::of({0, 0}, {1, 0, 0}, 10, {6, 0, 0}),
                                    Coupling::of({0, 0}, {0, 1, 0}, 10, {0, 6, 0})};
  expect_minimum(lattice, EffectiveField(PairCouplings<Kokkos::HostSpace>(lattice, bonds), applied),
                 -10.0 * 2 * columns * columns);
}

}  // namespace
}  // namespace cayspin::test
