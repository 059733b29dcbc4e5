// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A search for a minimum holds as much memory as its work_fields say.
#include "../support/held_memory.hpp"
#include "films.hpp"

namespace cayspin::test {
namespace {

template <class Backend>
class MinimizerMemory : public MinimizerTest<Backend> {};
TYPED_TEST_SUITE(MinimizerMemory, Backends, BackendName);

TYPED_TEST(MinimizerMemory, IsThatOfTheWorkFields) {
  using Spins = typename TestFixture::Spins;
  auto const lattice = Lattice::cubic(48, 32, 24);
  auto spins = this->random_spins(lattice, 3);
  HeldMemory const held("cayspin::Minimizer");
  Minimizer<Spins> minimizer(spins);
  minimizer.minimize(this->exec, film(lattice, 20), spins, {.evaluations = 10});
  auto const expected = static_cast<double>(Minimizer<Spins>::work_fields * spins.bytes());
  EXPECT_LT(held.most(), 1.04 * expected);
  EXPECT_GT(held.most(), 0.85 * expected);
}

}  // namespace
}  // namespace cayspin::test
