// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Minimising the energy of films: the number of evaluations hardly depends on the exchange, and the
// result is an equilibrium.
#include "films.hpp"

namespace cayspin::test {
namespace {

constexpr std::int64_t width = 32;

template <class Backend>
class Films : public MinimizerTest<Backend> {
 protected:
  using typename MinimizerTest<Backend>::Spins;

  Minimum relax(double exchange, std::vector<double> const& start,
                MinimizeOptions const& options = {}) {
    auto const lattice = Lattice::square(width, width);
    spins = spins_of<Spins>(lattice, start);
    return minimize(this->exec, film(lattice, exchange), spins, options);
  }
  Spins spins;
};
TYPED_TEST_SUITE(Films, Backends, BackendName);

TYPED_TEST(Films, TakeSeventyEvaluations) {
  double const easy = -0.05 * width * width;  // energy along the easy axis
  // In single precision, round-off slows down the search's way out of saddles.
  int const most = TestFixture::is_double ? 70 : 105;
  for (double const exchange : {2.0, 50.0, 1000.0}) {
    std::vector<std::vector<double>> starts{vortex(width)};
    for (unsigned const seed : {1U, 2U, 3U})
      starts.push_back(random_directions(width * width, seed));
    for (std::size_t i = 0; i < starts.size(); ++i) {
      auto const found = this->relax(exchange, starts[i]);
      EXPECT_EQ(found.end, MinimizeEnd::converged) << exchange << " " << i;
      EXPECT_LT(found.torque, 1e-6) << exchange << " " << i;
      EXPECT_LE(found.evaluations, most) << exchange << " " << i;
      EXPECT_LT(norm_defect(this->exec, this->spins), 4 * epsilon<typename TypeParam::Real>);
      // Checks the torque with code that the minimiser does not use.
      LandauLifshitz const generator(film(this->spins.lattice(), exchange), 0);
      EXPECT_LT(largest_rate(this->exec, generator, this->spins), 1.1e-6);
      // With weak exchange, a vortex relaxes to a state with walls.
      if (exchange > 2 || i > 0)
        EXPECT_NEAR(found.energy.value, easy, 1e-9 * width * width) << exchange << " " << i;
      else
        EXPECT_LT(found.energy.value, -10);
    }
  }
}

// Long waves have to vanish before walls form. Otherwise there are vortices in the walls, which
// move by only one cell per iteration.
TYPED_TEST(Films, TakeFewEvaluationsFarWiderThanAWall) {
  auto const lattice = Lattice::square(96, 96);
  for (unsigned const seed : {1U, 2U, 3U, 4U, 5U}) {
    this->spins = this->random_spins(lattice, seed);
    auto const found = minimize(this->exec, film(lattice, 2), this->spins, {.torque = 1e-3});
    EXPECT_EQ(found.end, MinimizeEnd::converged) << seed;
    EXPECT_LE(found.evaluations, 150) << seed;
  }
}

// Without the preconditioner, the number of evaluations grows as the square root of the exchange.
TYPED_TEST(Films, TakeManyMoreWithoutThePreconditioner) {
  auto const start = random_directions(width * width, 1);
  auto const with = this->relax(1000, start, {.torque = 1e-2});
  auto const without = this->relax(1000, start, {.torque = 1e-2, .preconditioned = false});
  EXPECT_EQ(without.end, MinimizeEnd::converged);
  EXPECT_GT(without.evaluations, 8 * with.evaluations);
  EXPECT_NEAR(with.energy.value, without.energy.value, 1e-3 * width * width);
}

TYPED_TEST(Films, EndEarly) {
  auto const start = random_directions(width * width, 1);
  auto const limited = this->relax(50, start, {.evaluations = 12});
  EXPECT_EQ(limited.end, MinimizeEnd::evaluation_limit);
  EXPECT_GE(limited.evaluations, 12);
  EXPECT_LT(limited.evaluations, 40);
  EXPECT_GT(limited.torque, 1e-6);
  int calls = 0;
  auto const stopped = this->relax(50, start, {.observer = [&](Minimum const& so_far) {
                                     EXPECT_EQ(so_far.iterations, ++calls);
                                     return calls == 5 ? Next::stop : Next::proceed;
                                   }});
  EXPECT_EQ(stopped.end, MinimizeEnd::interrupted);
  EXPECT_EQ(stopped.iterations, 5);
}

// If round-off keeps the torque above the bound, the result says so.
TYPED_TEST(Films, StagnateAboveRoundOff) {
  auto const found = this->relax(2, vortex(width), {.torque = 1e-30});
  EXPECT_EQ(found.end, MinimizeEnd::stagnated);
  double const field = 2 * 8;
  EXPECT_LT(found.torque, 16 * epsilon<typename TypeParam::Real> * field);
}

}  // namespace
}  // namespace cayspin::test
