// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Streaming stores, which steppers choose for large fields, give the same results as plain stores.
#include "equal_bits.hpp"

#include <limits>

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Real>
using Streaming = InHostMemory<Real>;
TYPED_TEST_SUITE(Streaming, Precisions, PrecisionName);

TYPED_TEST(Streaming, StoresEveryLane) {
  using Value = detail::Pack<TypeParam>;
  constexpr int lanes = detail::lanes_of<Value>, packs = 64;
  alignas(64) TypeParam plain[packs * lanes] = {}, streamed[packs * lanes] = {};
  alignas(64) TypeParam numbers[lanes];
  for (int p = 0; p < packs; ++p) {
    for (int lane = 0; lane < lanes; ++lane)
      numbers[lane] = TypeParam(1) / TypeParam(p * lanes + lane + 1);
    if (p == 5) numbers[0] = std::numeric_limits<TypeParam>::denorm_min();
    auto const value = detail::load<Value>(numbers);
    detail::store(value, plain + p * lanes);
    detail::store_streaming(value, streamed + p * lanes);
  }
  detail::streaming_fence();
  EXPECT_EQ(std::memcmp(plain, streamed, sizeof plain), 0);
  EXPECT_EQ(streamed[packs * lanes - 1], TypeParam(1) / TypeParam(packs * lanes));
}

/// Functor that turns every spin, with streaming or plain stores.
template <class Real>
struct Turn {
  SiteArray<Real, 3> from;
  OutputArray<Real, 3> to;
  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    auto const m = site.load(from);
    site.store(Cayley::rotate(Vec3<Value>{Value(Real(0.3)), m.x, m.y}, m), to);
  }
};

TYPED_TEST(Streaming, SameFieldOnEveryLattice) {
  using Field = typename TestFixture::Field;
  for (Lattice const& lattice : odd_lattices()) {
    auto const from = random_spins<Field>(lattice, 5);
    Field plain("plain", lattice), streamed("streamed", lattice);
    Threaded const exec;
    for (bool const streaming : {false, true}) {
      auto const& to = streaming ? streamed : plain;
      detail::for_each_site<TypeParam>(exec, "cayspin::test::turn", from.layout(),
                                       Turn<TypeParam>{from.array(), to.output(streaming)});
    }
    exec.fence();
    auto const numbers = copy_to_host(streamed);
    ASSERT_NE(numbers, copy_to_host(from));
    expect_equal_bits(copy_to_host(plain), numbers, name_of(lattice));
  }
}

}  // namespace
