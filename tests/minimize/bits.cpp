// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Minimising gives bitwise identical results and equal counts on Serial and on the threaded space.
#include "../backends/equal_bits.hpp"
#include "films.hpp"

namespace cayspin::test {
namespace {

#if defined(KOKKOS_ENABLE_SERIAL)
template <class Real>
class MinimizerBits : public ::testing::Test {};
TYPED_TEST_SUITE(MinimizerBits, Precisions, PrecisionName);

TYPED_TEST(MinimizerBits, AreTheSame) {
  using Field = SpinField<TypeParam, Kokkos::HostSpace>;
  for (auto const& shape : std::vector<std::array<std::int64_t, 3>>{
           {1, 1, 1}, {100, 1, 1}, {1, 43, 1}, {53, 67, 1}, {15, 14, 13}})
    for (Boundary const b : {Boundary::open, Boundary::periodic}) {
      Lattice const lattice{shape, {1, 0.9, 1.1}, {b, b, b}};
      auto const field = every_term(lattice).field();
      auto const start = random_directions(lattice.sites(), 8);
      auto one = spins_of<Field>(lattice, start), many = spins_of<Field>(lattice, start);
      auto const a = minimize(Host(), field, one, {.torque = 1e-3});
      auto const c = minimize(Threaded(), field, many, {.torque = 1e-3});
      auto const where = name_of(lattice);
      expect_equal_bits(copy_to_host(one), copy_to_host(many), where);
      EXPECT_EQ(a.evaluations, c.evaluations) << where;
      EXPECT_EQ(a.iterations, c.iterations) << where;
      expect_equal_bits(a.energy.value, c.energy.value, where);
      expect_equal_bits(a.curvature, c.curvature, where);
    }
}
#endif

}  // namespace
}  // namespace cayspin::test
