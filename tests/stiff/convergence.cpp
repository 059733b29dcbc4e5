// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Numbers of evaluations in stiff steps, and what happens if dt is too large.
#include "../support/figures.hpp"
#include "../support/unit_slab.hpp"
#include "../support/wrong_call.hpp"

#include <cayspin/stepper/stiff_gauss.hpp>

namespace cayspin::test {
namespace {

template <class Field>
class StiffGaussOn : public ::testing::Test {};
using Fields = ::testing::Types<SpinField<float, Space::memory_space>, Spins>;
TYPED_TEST_SUITE(StiffGaussOn, Fields);

TYPED_TEST(StiffGaussOn, FinerMeshesTakesNoMoreEvaluations) {
  for (std::int64_t const cells : {100, 400, 1600}) {
    // In single precision, differences between neighbours are round-off on finer meshes.
    constexpr bool is_single = std::is_same_v<typename TypeParam::value_type, float>;
    if (is_single && cells > 400) continue;
    SCOPED_TRACE(cells);
    Slab const slab = thin_slab(cells, 0.05);
    auto spins = smooth_start<TypeParam>(slab.lattice);
    auto const count = [&]<class Stepper>(Stepper stepper, int steps) {
      auto moved = copy_of(spins);
      advance(stepper, slab.natural(), moved, 0.5 / steps, steps);
      EXPECT_EQ(stepper.halvings_done(), 0);
      return stepper.evaluations_done();
    };
    EXPECT_LE(count(StiffGauss2<TypeParam>(spins), 200), is_single ? 450 : 260);
    EXPECT_LE(count(StiffGauss4<TypeParam>(spins), 40), is_single ? 200 : 110);
  }
}

// The second step starts from a prediction, so its corrections need not add up to the whole
// rotation.
TYPED_TEST(StiffGaussOn, TheSecondStepTakesFewerCorrections) {
  Slab const film{.lattice = Lattice::square(64, 64), .exchange = 2, .demag = 1, .damping = 0.05};
  auto const start = make_spins<TypeParam>(film.lattice, [](auto i, auto j, auto) {
    double const x = std::numbers::pi * (static_cast<double>(i) + 0.5) / 64,
                 y = std::numbers::pi * (static_cast<double>(j) + 0.5) / 64;
    return Vector{0.1 + 0.4 * std::cos(x) * std::cos(2 * y), 0.3 + std::cos(y),
                  0.2 + 0.5 * std::cos(x)};
  });
  auto const expect_fewer = [&]<class Stepper>(Stepper stepper, double dt) {
    auto spins = copy_of(start);
    advance(stepper, film.natural(), spins, dt, 1);
    auto const first = stepper.evaluations_done();
    advance(stepper, film.natural(), spins, dt, 1);
    EXPECT_LE(stepper.evaluations_done() - first, 3 * first / 5);
  };
  expect_fewer(StiffGauss2<TypeParam>(start), 0.3);
  expect_fewer(StiffGauss4<TypeParam>(start), 0.6);
}

TEST(StiffGauss, ErrorDoesNotDependOnTheMesh) {
  // On the finest of these meshes, steps of RK4 would have to be about 4500 times shorter.
  double first = 0;
  for (std::int64_t const cells : {50, 200, 800}) {
    Slab const slab = thin_slab(cells, 0.05);
    auto const start = smooth_start(slab.lattice);
    auto const end = run<StiffGauss2<Spins>>(slab.natural(), start, 0.5 / 100, 100);
    auto const finer = run<StiffGauss4<Spins>>(slab.natural(), start, 0.5 / 200, 200);
    double const error = largest_distance(end, finer);
    std::printf("    %4ld cells: %.3e\n", static_cast<long>(cells), error);
    if (first == 0) first = error;
    EXPECT_LT(error, 4e-3);
    EXPECT_NEAR(error, first, 0.1 * first);
  }
}

TYPED_TEST(StiffGaussOn, HotSpinsHalveStepsThatAreTooLarge) {
  Slab const slab{.lattice = Lattice::chain(40),
                  .exchange = 30,
                  .anisotropy = 1,
                  .applied = {0.3, 0, 1},
                  .damping = 0.1};
  auto const start = random_spins<TypeParam>(slab.lattice, 7);
  // For this short time an accurate solution exists, and other roots would be far from it.
  double const end_time = 0.1;
  auto const exact =
      run<Rkmk4<Spins>>(slab.natural(), random_spins(slab.lattice, 7), end_time / 4000, 4000);
  auto spins = copy_of(start);
  StiffGauss4<TypeParam> stepper(spins, {.tolerance = 1e-5});
  advance(stepper, slab.natural(), spins, end_time / 4, 4);
  EXPECT_GT(stepper.halvings_done(), 0);
  double const coarse = largest_distance(spins, exact);
  EXPECT_LT(coarse, 0.3);
  auto fine = copy_of(start);
  StiffGauss4<TypeParam> other(fine);
  advance(other, slab.natural(), fine, end_time / 200, 200);
  EXPECT_EQ(other.halvings_done(), 0);
  EXPECT_LT(largest_distance(fine, exact), 1e-4);
}

TYPED_TEST(StiffGaussOn, StepWithoutSolutionLeavesTheSpins) {
  Slab const slab{.lattice = Lattice::chain(40), .exchange = 30, .damping = 0.1};
  auto spins = random_spins<TypeParam>(slab.lattice, 7);
  auto const before = copy_to_host(spins);
  StiffGauss4<TypeParam> stepper(spins, {.halvings = 2});
  EXPECT_THROW(advance(stepper, slab.natural(), spins, 5.0, 1), NotConverged);
  EXPECT_EQ(copy_to_host(spins), before);
  // The stepper can still be used.
  EXPECT_NO_THROW(advance(stepper, slab.natural(), spins, 1e-3, 5));
}

TEST(StiffGauss, NumbersThatAreNotFiniteHaveNoSolution) {
  Slab const slab{.lattice = Lattice::chain(5), .exchange = 1, .applied = {1e300, 0, 1e300}};
  auto spins = random_spins(slab.lattice, 7);
  StiffGauss2<Spins> stepper(spins);
  EXPECT_EQ(refusal<NotConverged>([&] { advance(stepper, slab.natural(), spins, 1e30, 1); }),
            "cayspin::StiffGauss2::step: the equation of the step from t = 0 is not solved: dt = "
            "1e+30 is too large, or the numbers are not finite");
}

}  // namespace
}  // namespace cayspin::test
