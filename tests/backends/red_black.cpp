// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Sites are changed in place while others are read: the same bits on Serial and on the threaded
// space, on lattices that have a checkerboard.
#include "equal_bits.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

std::vector<Lattice> checkerboards() {
  std::vector<Lattice> lattices;
  for (Lattice lattice : odd_lattices()) {
    if (lattice.boundary[0] == Boundary::periodic)
      for (auto& extent : lattice.shape)
        if (extent > 1) extent += extent % 2;
    lattices.push_back(lattice);
  }
  return lattices;
}

template <class Real>
struct RedBlackSpaces : ::testing::Test {
  using Field = SpinField<Real, Kokkos::HostSpace>;
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(RedBlackSpaces, Precisions);

TYPED_TEST(RedBlackSpaces, SameBits) {
  expect_same_on_host_spaces<RedBlack4<typename TestFixture::Field>>(
      [](Slab const& slab) { return slab.natural(); }, checkerboards());
}

}  // namespace
