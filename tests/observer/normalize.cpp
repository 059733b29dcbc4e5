// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The Newton step towards |m| = 1 by itself, and as an observer that prevents accumulation of
// round-off.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>

namespace cayspin::test {
namespace {

template <class Backend>
using Normalizing = OnBackend<Backend>;
TYPED_TEST_SUITE(Normalizing, Backends, BackendName);

TYPED_TEST(Normalizing, IsNewtonsStep) {
  using Spins = typename TypeParam::Spins;
  double const eps = epsilon<typename TypeParam::Real>;
  for (double const excess : {0.5, 0.1, -0.1, 1e-3, -1e-3, 0.0}) {
    auto const lattice = Lattice::square(19, 5);
    auto numbers = random_directions(lattice.sites(), 5);
    for (auto& number : numbers) number *= 1 + excess;
    auto const spins = spins_of<Spins>(lattice, numbers);
    normalize(this->exec, spins);
    this->exec.fence();
    double const length = (1 + excess) * (3 - (1 + excess) * (1 + excess)) / 2;
    auto const found = numbers_of(spins);
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], numbers[i] / (1 + excess) * length, 4 * eps) << excess;
  }
}

// Lengths of exactly 1 do not change, and NaN is not hidden.
TYPED_TEST(Normalizing, AtRestAndNotFinite) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::chain(20);
  auto numbers = random_directions(lattice.sites(), 6);
  for (std::size_t i = 0; i < 30; ++i) numbers[i] = i % 3 == 1 ? 1 : 0;
  numbers[30] = std::numeric_limits<double>::quiet_NaN();
  auto const spins = spins_of<Spins>(lattice, numbers);
  normalize(this->exec, spins);
  this->exec.fence();
  EXPECT_TRUE(std::isnan(norm_defect(this->exec, spins)));
  auto const found = numbers_of(spins);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_EQ(found[i], numbers[i]);
  for (std::size_t i = 33; i < found.size(); ++i) EXPECT_TRUE(std::isfinite(found[i]));
}

TYPED_TEST(Normalizing, KeepsRoundOffFromAddingUp) {
  using Spins = typename TypeParam::Spins;
  double const eps = epsilon<typename TypeParam::Real>;
  auto const lattice = Lattice::chain(16);
  auto const start = random_directions(lattice.sites(), 7);
  LandauLifshitz const generator(EffectiveField(Zeeman{{0.3, -0.4, 1.2}}), 0);
  auto const defect = [&](auto&&... observers) {
    auto spins = spins_of<Spins>(lattice, start);
    LieEuler stepper(spins);
    integrate(this->exec, stepper, generator, spins, {0, 0.37, 20000}, observers...);
    return norm_defect(this->exec, spins);
  };
  double const alone = defect(), every_tenth = defect(Every(10, Normalize{}));
  std::printf("    20000 steps: | |m| - 1 | = %.1f eps, %.1f eps with a Newton step every 10\n",
              alone / eps, every_tenth / eps);
  EXPECT_LT(every_tenth, 1.5 * eps);
  EXPECT_GT(alone, 5 * eps);
}

TYPED_TEST(Normalizing, SpinsOfOnesOwnAreHeldToLengthOne) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::square(19, 5);
  auto numbers = random_directions(lattice.sites(), 8);
  for (auto& number : numbers)
    number = static_cast<float>(number);  // as read from a file of floats
  EXPECT_NO_THROW(require_unit_spins(this->exec, spins_of<Spins>(lattice, numbers)));
  double const nan = std::numeric_limits<double>::quiet_NaN();
  for (double const factor : {0.0, 0.999, 1.001, 3.0, nan}) {
    auto wrong = numbers;
    for (std::size_t i = 150; i < 153; ++i) wrong[i] *= factor;
    EXPECT_THROW(require_unit_spins(this->exec, spins_of<Spins>(lattice, wrong)),
                 std::invalid_argument)
        << factor;
  }
  for (auto& number : numbers) number *= 0.99;
  auto const short_ones = spins_of<Spins>(lattice, numbers);
  EXPECT_NO_THROW(require_unit_spins(this->exec, short_ones, 0.02));
  for (int i = 0; i < 3; ++i) normalize(this->exec, short_ones);
  EXPECT_NO_THROW(require_unit_spins(this->exec, short_ones));
}

}  // namespace
}  // namespace cayspin::test
