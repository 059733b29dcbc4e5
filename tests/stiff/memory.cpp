// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Stiff steppers hold as much memory as their work_fields say, also while they are stored.
#include "../support/held_memory.hpp"
#include "../support/landau_lifshitz.hpp"

#include <gtest/gtest.h>

namespace cayspin::test {
namespace {

template <class Stepper>
void expect_memory_of_work_fields() {
  using Field = typename Stepper::spins_type;
  auto const lattice = Lattice::cubic(48, 32, 24);
  LandauLifshitz const generator(EffectiveField(Exchange(lattice, 20)), 0.1);
  auto spins = make_spins<Field>(lattice, [](auto i, auto j, auto k) {
    return Vector{1 + 0.01 * i, 0.02 * j, 0.01 * k};
  });
  HeldMemory const held("cayspin::StiffGauss");
  Stepper stepper(spins);
  stepper.step(Kokkos::DefaultExecutionSpace(), generator, spins, 0, 0.01);
  CheckpointInMemory checkpoint;
  serialize(stepper, checkpoint);
  checkpoint.close();
  serialize(stepper, checkpoint);
  auto const expected = static_cast<double>(Stepper::work_fields * spins.bytes());
  EXPECT_LT(held.most(), 1.1 * expected);
  EXPECT_GT(held.most(), 0.85 * expected);
}

TEST(StiffMemory, IsThatOfTheWorkFields) {
  expect_memory_of_work_fields<StiffGauss2<SpinField<double>>>();
  expect_memory_of_work_fields<StiffGauss2<SpinField<float>>>();
  expect_memory_of_work_fields<StiffGauss4<SpinField<double>>>();
  expect_memory_of_work_fields<StiffGauss4<SpinField<float>>>();
}

}  // namespace
}  // namespace cayspin::test
