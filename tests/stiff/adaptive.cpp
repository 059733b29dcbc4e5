// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Stiff steps whose length is chosen from a tolerance.
#include "../support/field_that_jumps.hpp"
#include "../support/figures.hpp"
#include "../support/larger.hpp"
#include "../support/unit_slab.hpp"

#include <cayspin/stepper/adaptive_stiff_gauss.hpp>

namespace cayspin::test {
namespace {

using Stepper = AdaptiveStiffGauss2<Spins>;
constexpr double end_time = 2;

/// Returns the largest error at the times end_time / 2^8, ..., end_time / 2 and end_time.
double error_of(Stepper& stepper, Slab const& slab, std::vector<Spins> const& exact) {
  auto spins = smooth_start(slab.lattice);
  double largest = 0, t = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    double const next = end_time / std::exp2(static_cast<double>(exact.size() - 1 - i));
    stepper.step(Space(), slab.natural(), spins, t, next - t);
    t = next;
    largest = larger(largest, largest_distance(spins, exact[i]));
  }
  return largest;
}

std::vector<Spins> exact_spins(Slab const& slab) {
  auto spins = smooth_start(slab.lattice);
  AdaptiveRkmk<Spins> stepper(spins, {.tolerance = 1e-10});
  std::vector<Spins> all;
  double t = 0;
  for (int i = 8; i >= 0; --i) {
    double const next = end_time / std::exp2(i);
    stepper.step(Space(), slab.natural(), spins, t, next - t);
    t = next;
    all.push_back(copy_of(spins));
  }
  return all;
}

TEST(AdaptiveStiff, TheErrorFollowsTheTolerance) {
  Slab const slab = thin_slab(40, 0.05);
  auto const exact = exact_spins(slab);
  std::vector<double> tolerances, errors;
  for (double const tolerance : {1.0, 1e-1, 1e-2, 1e-3, 1e-4}) {
    Stepper stepper(smooth_start(slab.lattice), {.tolerance = tolerance});
    tolerances.push_back(tolerance);
    errors.push_back(error_of(stepper, slab, exact));
    std::printf("    tolerance %.0e: error %.2e, %ld steps\n", tolerance, errors.back(),
                static_cast<long>(stepper.accepted_steps()));
    EXPECT_LT(errors.back(), tolerance);
  }
  // A step has an error of order dt^3, which the tolerance limits; the errors of all steps add up
  // to order dt^2.
  expect_order("error over tolerance", fitted_order(tolerances, errors), 2.0 / 3, 0.15);
}

// Without damping A is constant, so the whole error is that of the rotation.
TEST(AdaptiveStiff, APrecessingSpinFollowsTheTolerance) {
  auto const lattice = Lattice::chain(1);
  auto const start = make_spins(lattice, [](auto...) { return Vector{0.6, 0, 0.8}; });
  constexpr double t = 20;
  for (double const damping : {0.0, 1e-3, 1e-2, 0.1})
    for (double const tolerance : {1e-3, 1e-5}) {
      auto const near_rest = make_spins(lattice, [](auto...) { return Vector{0.02, 0, 0.9998}; });
      for (auto const& from : {start, near_rest}) {
        LandauLifshitz const generator(EffectiveField(Zeeman{{0, 0, 1}}), damping);
        auto spins = copy_of(from);
        Stepper stepper(spins, {.tolerance = tolerance});
        stepper.step(Space(), generator, spins, 0, t);
        auto exact = copy_of(from);
        AdaptiveRkmk<Spins> fine(exact, {.tolerance = 1e-11});
        fine.step(Space(), generator, exact, 0, t);
        EXPECT_LT(largest_distance(spins, exact), 30 * tolerance) << damping << " " << tolerance;
        EXPECT_GT(largest_distance(spins, exact), 1e-3 * tolerance) << damping << " " << tolerance;
      }
    }
}

TEST(AdaptiveStiff, LooksWithinStepsAreAsGood) {
  Slab const slab = thin_slab(40, 0.5);
  auto spins = smooth_start(slab.lattice);
  AdaptiveRkmk<Spins> fine(copy_of(spins), {.tolerance = 1e-10});
  Stepper stepper(spins, {.tolerance = 1e-2});
  auto exact = copy_of(spins);
  double largest = 0;
  constexpr int looks = 400;
  for (int i = 0; i < looks; ++i) {
    double const dt = end_time / looks;
    stepper.step(Space(), slab.natural(), spins, i * dt, dt);
    fine.step(Space(), slab.natural(), exact, i * dt, dt);
    largest = larger(largest, largest_distance(spins, exact));
  }
  EXPECT_LT(stepper.accepted_steps(), looks / 2);
  expect_below("at any look", largest, 1e-3);  // if steps took A as constant: 1.4e-3
}

// At equilibrium steps lengthen: a run ten times as long takes at most four times the evaluations.
TEST(AdaptiveStiff, RestTakesFewSteps) {
  for (std::int64_t const cells : {100, 400}) {
    SCOPED_TRACE(cells);
    Slab const slab = thin_slab(cells, 0.5);
    auto spins = smooth_start(slab.lattice);
    Stepper stepper(spins, {.tolerance = 0.1});
    stepper.step(Space(), slab.natural(), spins, 0, 20);
    auto const soon = stepper.evaluations_done();
    EXPECT_LE(soon, 180);
    for (int i = 1; i < 10; ++i) stepper.step(Space(), slab.natural(), spins, 20. * i, 20);
    EXPECT_LE(stepper.evaluations_done(), 4 * soon);
    EXPECT_LT(norm_defect(Space(), spins), 64 * std::numeric_limits<double>::epsilon());
  }
}

TEST(AdaptiveStiff, AFieldSwitchedOnAtRestIsFollowed) {
  auto const lattice = Lattice::chain(10, 0.1);
  auto const start = make_spins(lattice, [](auto...) { return Vector{0, 0, 1}; });
  double const tolerance = 1e-2;
  LandauLifshitz const late(
      EffectiveField(Exchange(lattice, 1), FieldThatJumps{5, {0, 0, 0.5}, {1, 0, 0.5}}), 0.5);
  LandauLifshitz const on(EffectiveField(Exchange(lattice, 1), Zeeman{{1, 0, 0.5}}), 0.5);
  auto spins = copy_of(start);
  Stepper stepper(spins, {.tolerance = tolerance});
  stepper.step(Space(), late, spins, 0, 7);
  auto const exact = run<Rkmk4<Spins>>(on, start, 2. / 4000, 4000);
  expect_below("after the jump", largest_distance(spins, exact), 30 * tolerance);
}

// Near equilibrium, corrections are round-off, which must not determine the length of steps.
TEST(AdaptiveStiff, ShortStepsAtRestAreTakenAndLeftAgain) {
  auto const lattice = Lattice::chain(1);
  Vector const field{0.14205055664220612, 0.17394872326938271, 1};
  LandauLifshitz const generator(FieldThatJumps{100, field, field}, 0.32755298957973433);
  auto const start =
      make_spins(lattice, [&](auto...) { return (1 / std::sqrt(dot(field, field))) * field; });
  for (double const max_dt : {0.01, 0.02, 0.05}) {
    auto spins = copy_of(start);
    Stepper stepper(spins, {.tolerance = 1e-3, .end = 60, .bounds = {{10, 40, max_dt}}});
    stepper.step(Space(), generator, spins, 0, 60);
    auto const steps = static_cast<double>(stepper.accepted_steps());
    EXPECT_LT(steps, 30 / max_dt + 100);
    EXPECT_LT(largest_distance(spins, start), 8 * steps * std::numeric_limits<double>::epsilon());
  }
}

TEST(AdaptiveStiff, InSinglePrecisionIsTheSameMethod) {
  using Single = SpinField<float, Space::memory_space>;
  Slab const slab = thin_slab(40, 0.5);
  auto single = smooth_start<Single>(slab.lattice);
  auto full = smooth_start(slab.lattice);
  AdaptiveStiffGauss2<Single> one(single, {.tolerance = 1e-2});
  Stepper other(full, {.tolerance = 1e-2});
  one.step(Space(), slab.natural(), single, 0, end_time);
  other.step(Space(), slab.natural(), full, 0, end_time);
  EXPECT_LT(largest_distance(single, full), 1e-3);
}

}  // namespace
}  // namespace cayspin::test
