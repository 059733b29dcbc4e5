// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Without damping, stiff steps conserve the energy, the lengths of spins and, with exchange only,
// the total spin.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <cayspin/stepper/stiff_gauss.hpp>

#include <cstdlib>

namespace cayspin::test {
namespace {

class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : engine_(seed) {
    slab.lattice.shape = {pick(1, 14), pick(1, 9), pick(1, 4)};
    for (auto& boundary : slab.lattice.boundary)
      boundary = pick(0, 1) == 0 ? Boundary::open : Boundary::periodic;
    slab.lattice.spacing = {uniform(0.5, 1), uniform(0.5, 1), uniform(0.5, 1)};
    slab.exchange = uniform(0.1, 20);
    dt = std::min(0.05, 8 / exchange_bound(slab.lattice, slab.exchange));
    spread = uniform(0.05, 0.5);
    if (pick(0, 2) == 0) return;  // only exchange
    is_isotropic = false;
    slab.anisotropy = uniform(-2, 2);
    slab.axis = {uniform(-1, 1), uniform(-1, 1), 1};
    slab.demag = uniform(0, 1);
    slab.applied = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
  }

  /// Spins about a mean direction.
  template <class Field>
  Field start() {
    return make_spins<Field>(slab.lattice, [&](auto, auto, auto) {
      return Vector{0.5 + spread * uniform(-1, 1), spread * uniform(-1, 1), 0.8};
    });
  }

  Slab slab;
  double dt = 0, spread = 0;
  bool is_isotropic = true;

 private:
  double uniform(double low, double high) { return low + (high - low) * engine_() * 0x1p-32; }
  std::int64_t pick(int low, int high) {
    return static_cast<std::int64_t>(std::floor(uniform(low, high + 1)));
  }
  std::mt19937 engine_;
};

int scenes() {
  char const* const count = std::getenv("CAYSPIN_RANDOM_SCENES");
  return count == nullptr ? 60 : std::atoi(count);
}

template <class Stepper>
class Conservation : public ::testing::Test {};
using Steppers = ::testing::Types<StiffGauss2<Spins>, StiffGauss4<Spins>,
                                  StiffGauss2<SpinField<float, Space::memory_space>>,
                                  StiffGauss4<SpinField<float, Space::memory_space>>>;
TYPED_TEST_SUITE(Conservation, Steppers);

TYPED_TEST(Conservation, OfRandomScenes) {
  using Field = typename TypeParam::spins_type;
  double const epsilon = std::numeric_limits<typename Field::value_type>::epsilon();
  constexpr int steps = 20;
  int moved = 0;
  for (int seed = 1; seed <= scenes(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomScene scene(static_cast<unsigned>(seed));
    Field const start = scene.template start<Field>();
    Field spins = copy_of(start);
    auto const generator = scene.slab.natural();
    Space const exec;
    auto const sum = [&] { return magnetization(exec, spins); };
    double const sites = static_cast<double>(scene.slab.lattice.sites());
    double const before = energy(exec, generator, spins, 0).value;
    Vector const spin = sum();
    TypeParam stepper(spins);
    advance(stepper, generator, spins, scene.dt, steps);
    // Each step leaves an error of a few epsilons in the rotation vectors. The energy of a site
    // changes by that error times the field.
    double const rounding = 16 * epsilon * steps * TypeParam::stages;
    EXPECT_NEAR(energy(exec, generator, spins, 0).value, before,
                rounding * sites * scene.slab.field_bound());
    if (scene.is_isotropic) {
      EXPECT_LT(length(sum() - spin), rounding);
    }
    EXPECT_LT(norm_defect(exec, spins), 4 * epsilon * steps * TypeParam::stages);
    moved += largest_distance(spins, start) > 0.01;
  }
  EXPECT_GT(2 * moved, scenes());
}

}  // namespace
}  // namespace cayspin::test
