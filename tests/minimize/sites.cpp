// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Vacant sites do not change, site-dependent coefficients work like uniform ones, and wrong calls
// are refused.
#include "../support/coefficients.hpp"
#include "../support/wrong_call.hpp"
#include "films.hpp"

#include <cayspin/path/found.hpp>

namespace cayspin::test {
namespace {

template <class Backend>
class Sites : public MinimizerTest<Backend> {};
TYPED_TEST_SUITE(Sites, Backends, BackendName);

TYPED_TEST(Sites, VacantOnesStay) {
  using Spins = typename TestFixture::Spins;
  auto const lattice = Lattice::cubic(21, 9, 4);
  auto const vacant = [](std::int64_t site) { return site % 7 == 2 || site % 11 == 0; };
  auto spins = this->random_spins(lattice, 5);
  auto const before = numbers_of(spins);
  FieldWithVacancies const field(
      EffectiveField(Exchange(lattice, 20), UniaxialAnisotropy(0.4, {1, 1, 0})),
      numbers_on<Spins>(lattice, [&](std::int64_t site) { return vacant(site) ? 0 : 1; }));
  // In single precision, round-off ends about a third of such runs at torques from 3e-4 to 3e-3.
  double const torque = TestFixture::is_double ? 1e-4 : 4e-3;
  auto const found = minimize(this->exec, field, spins, {.torque = torque});
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  auto const after = numbers_of(spins);
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    for (int c = 0; c < 3; ++c) {
      if (vacant(site)) {
        EXPECT_EQ(after[3 * site + c], before[3 * site + c]) << site;
      }
    }
  LandauLifshitz const generator(field, 0);
  EXPECT_LT(largest_rate(this->exec, generator, spins), 1.2 * torque);
}

TYPED_TEST(Sites, VacantOnesStayWhereTheCallBeforeHadSpins) {
  using Spins = typename TestFixture::Spins;
  auto const lattice = Lattice::square(12, 7);
  constexpr std::int64_t vacant = 40;
  EffectiveField const full(Exchange(lattice, 20), UniaxialAnisotropy(0.4, {1, 1, 0}));
  FieldWithVacancies const field(
      full, numbers_on<Spins>(lattice, [](std::int64_t site) { return site == vacant ? 0 : 1; }));
  auto spins = this->random_spins(lattice, 5);
  Minimizer minimizer(spins);
  minimizer.minimize(this->exec, full, spins, {.evaluations = 1});
  spins = this->random_spins(lattice, 6);
  auto const before = at(numbers_of(spins), vacant);
  minimizer.minimize(this->exec, field, spins, {.torque = 4e-3});
  auto const after = at(numbers_of(spins), vacant);
  EXPECT_EQ(after.x, before.x);
  EXPECT_EQ(after.y, before.y);
  EXPECT_EQ(after.z, before.z);
}

TYPED_TEST(Sites, WhereAllAreVacantNothingMoves) {
  using Spins = typename TestFixture::Spins;
  auto const lattice = Lattice::cubic(7, 5, 3);
  auto spins = this->random_spins(lattice, 5);
  auto const before = numbers_of(spins);
  FieldWithVacancies const field(EffectiveField(Exchange(lattice, 20), Zeeman{{0, 0, 1}}),
                                 numbers_on<Spins>(lattice, [](std::int64_t) { return 0; }));
  auto const found = minimize(this->exec, field, spins);
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_EQ(found.torque, 0);
  EXPECT_EQ(numbers_of(spins), before);
}

TYPED_TEST(Sites, WithExchangeAndAnisotropyOfTheirOwn) {
  using Spins = typename TestFixture::Spins;
  auto const lattice = Lattice::square(30, 23);
  auto spins = this->random_spins(lattice, 6);
  EffectiveField const field(SiteDependentExchange(random_numbers_on<Spins>(lattice, 20, 200, 3)),
                             UniaxialAnisotropy(0.4, {0, 0, 1}));
  auto const found = minimize(this->exec, field, spins, {.torque = 1e-4});
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_NEAR(found.energy.value, -0.2 * 30 * 23, 1e-3);
  EXPECT_LE(found.evaluations, 90);
}

TYPED_TEST(Sites, WrongCalls) {
  auto const lattice = Lattice::square(8, 4);
  auto spins = this->random_spins(lattice, 1);
  auto other = this->random_spins(Lattice::square(4, 8), 1);
  Minimizer minimizer(spins);
  auto const field = film(lattice, 1);
  double const nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused({
      {"torque 0", [&] { minimize(this->exec, field, spins, {.torque = 0}); }},
      {"torque 1e-151", [&] { minimize(this->exec, field, spins, {.torque = 1e-151}); }},
      {"torque nan", [&] { minimize(this->exec, field, spins, {.torque = nan}); }},
      {"least curvature -1", [&] { minimize(this->exec, field, spins, {.least_curvature = -1}); }},
      {"least curvature nan",
       [&] { minimize(this->exec, field, spins, {.least_curvature = nan}); }},
      {"evaluations", [&] { minimize(this->exec, field, spins, {.evaluations = 0}); }},
      {"other spins", [&] { minimizer.minimize(this->exec, field, other); }},
      {"other field", [&] { minimize(this->exec, field, other); }},
      {"not finite",
       [&] {
         minimize(this->exec, Zeeman{{nan, 0, 0}}, spins);
       }},
  });
}

TEST(PathsWithoutASaddle, HaveNoBarrier) {
  MinimumEnergyPath const none;
  expect_refused<std::logic_error>({
      {"saddle", [&] { none.saddle(); }},
      {"forward", [&] { none.barrier_forward(); }},
      {"backward", [&] { none.barrier_backward(); }},
  });
}

}  // namespace
}  // namespace cayspin::test
