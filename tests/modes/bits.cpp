// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Modes and counts are bitwise identical on Serial and on the threaded space.
#include "../backends/equal_bits.hpp"
#include "modes.hpp"

namespace cayspin::test {
namespace {

#if defined(KOKKOS_ENABLE_SERIAL)
template <class Real>
class ModesBits : public ::testing::Test {};
TYPED_TEST_SUITE(ModesBits, Precisions, PrecisionName);

TYPED_TEST(ModesBits, AreTheSame) {
  using Spins = SpinField<TypeParam, Kokkos::HostSpace>;
  Lattice const lattice{{53, 47, 2}, {1, 0.9, 1.1}, {}};
  EffectiveField const field(Exchange(lattice, 3), SlabDemag({0, 0, 1}, 1.0),
                             UniaxialAnisotropy(0.2, {1, 0, 0}));
  std::vector<double> numbers;
  for (std::int64_t i = 0; i < lattice.sites(); ++i)
    for (double const c : {1.0, 0.0, 0.0}) numbers.push_back(c);
  auto const m = spins_of<Spins>(lattice, numbers);
  LandauLifshitz const generator(field, 0.05);
  auto const one = normal_modes(Host(), generator, m, {.count = 3});
  auto const many = normal_modes(Threaded(), generator, m, {.count = 3});
  EXPECT_EQ(one.evaluations, many.evaluations);
  ASSERT_EQ(one.modes.size(), many.modes.size());
  for (std::size_t i = 0; i < one.modes.size(); ++i) {
    expect_equal_bits(one.modes[i].frequency, many.modes[i].frequency, "frequency");
    expect_equal_bits(one.modes[i].decay, many.modes[i].decay, "decay");
    expect_equal_bits(copy_to_host(one.modes[i].real), copy_to_host(many.modes[i].real), "real");
    expect_equal_bits(copy_to_host(one.modes[i].imaginary), copy_to_host(many.modes[i].imaginary),
                      "imaginary");
  }
}
#endif

}  // namespace
}  // namespace cayspin::test
