// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Spins at equilibrium beside moving ones, and spins whose rate passes through zero: sigma is never
// 0/0, and spins at equilibrium stay bitwise unchanged.
#include "../support/backends.hpp"
#include "../support/landau_lifshitz.hpp"

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>
#include <gtest/gtest.h>

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Real>
class AtRest : public ::testing::Test {
 protected:
  using Field = SpinField<Real, Space::memory_space>;

  /// Calls check(name, stepper) for LieEuler with each sigma that comes from a derivative or a
  /// difference, and for ImplicitLieEuler.
  template <class Check>
  static void for_each(Field const& like, Check const& check) {
    using namespace isotropy;
    check("analytic", LieEuler(like, Analytic{}));
    check("connection", LieEuler(like, Connection{}));
    check("forward", LieEuler(like, FiniteDifference{}));
    check("backward", LieEuler(like, FiniteDifferenceBackward{}));
    check("implicit", ImplicitLieEuler(like, Analytic{}));
  }
};
TYPED_TEST_SUITE(AtRest, Precisions, PrecisionName);

// The spins are not coupled, and every third one is along the axis of the field.
TYPED_TEST(AtRest, StaysToTheBitBesideMovingSpins) {
  using Field = typename TestFixture::Field;
  auto const lattice = Lattice::chain(37);
  LandauLifshitz const generator{EffectiveField{UniaxialAnisotropy{0.7, {0, 0, 1}},
                                                Zeeman{{0, 0, 0.4}}, SlabDemag{{1, 0, 0}, 1}},
                                 0.1};
  auto const start = make_spins<Field>(lattice, [](auto i, auto, auto) {
    double const z = i % 2 == 0 ? 1 : -1;
    return i % 3 == 0 ? Vector{0, 0, z} : Vector{0.6 * z, 0.1 * i, 0.8};
  });
  this->for_each(start, [&](char const* what, auto stepper) {
    auto spins = copy_of(start);
    advance(stepper, generator, spins, 0.05, 20);
    auto const before = copy_to_host(start), after = copy_to_host(spins);
    for (std::int64_t i = 0; i < lattice.sites(); ++i) {
      Vector const moved = spin(spins, i) - spin(start, i);
      EXPECT_EQ(length(moved) == 0, i % 3 == 0) << what << ' ' << i;
    }
    EXPECT_LT(norm_defect(Space{}, spins), 50 * epsilon<TypeParam>) << what;
  });
}

TYPED_TEST(AtRest, BodiesInTheirPrincipalAxes) {
  using Field = typename TestFixture::Field;
  auto const body = RigidBody::principal(1, 2, 3);
  auto const start = make_spins<Field>(Lattice::chain(5), [](auto i, auto, auto) {
    return Vector{i == 0 ? 1. : 0., i == 1 ? -1. : 0., i > 1 ? 1. : 0.};
  });
  auto const check = [&](char const* what, auto stepper) {
    auto spins = copy_of(start);
    advance(stepper, body, spins, 0.3, 3);
    EXPECT_EQ(copy_to_host(spins), copy_to_host(start)) << what;
  };
  this->for_each(start, check);
  isotropy::Energy const energy;
  check("Heun", LieHeun(start, energy));
  check("rkmk4", Rkmk4(start, energy));
  check("series", Series4(start, energy));
  check("series as printed", Series4Paper(start, energy));
}

// The middle spin is along its field at the start. It moves only after its neighbours have.
TYPED_TEST(AtRest, RateThatPassesZero) {
  using Field = typename TestFixture::Field;
  auto const lattice = Lattice::chain(3);
  Slab const slab{.lattice = lattice, .exchange = 1, .applied = {0, 0, 1}};
  auto const start = make_spins<Field>(lattice, [](auto i, auto, auto) {
    double const side = i - 1.0;
    return Vector{0.6 * side, 0, i == 1 ? 1.0 : 0.8};
  });
  auto const exact = run<Rkmk4<Field>>(slab.natural(), start, 1e-3, 500);
  this->for_each(start, [&](char const* what, auto stepper) {
    auto spins = copy_of(start);
    advance(stepper, slab.natural(), spins, 1e-3, 500);
    EXPECT_LT(norm_defect(Space{}, spins), 500 * epsilon<TypeParam>) << what;
    EXPECT_LT(largest_distance(spins, exact), 2e-3) << what;
  });
}

}  // namespace
