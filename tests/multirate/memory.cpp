// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Expensive fields: counts, memory from step to step, precisions, spaces and wrong calls.
#include "../support/wrong_call.hpp"
#include "long_range.hpp"

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#if defined(KOKKOS_ENABLE_SERIAL) && \
    (defined(KOKKOS_ENABLE_OPENMP) || defined(KOKKOS_ENABLE_THREADS))
#include "../backends/equal_bits.hpp"
#define CAYSPIN_TEST_TWO_HOST_SPACES
#endif

using namespace cayspin;
using namespace cayspin::test;

namespace {

Lattice const small_block{
    {5, 4, 3}, {1, 1.1, 0.9}, {Boundary::periodic, Boundary::open, Boundary::open}};

TEST(SlowField, CountsEvaluations) {
  Spins spins = random_spins(small_block, 3);
  auto const slow = multirate_long_range(spins, 0.4);
  auto const generator = with_multirate(small_block, 0.5, slow, 0.1);
  auto stepper = multirate(spins, slow, 3);
  static_assert(Stepper<decltype(stepper)>);
  for (int run = 1; run <= 2; ++run) {
    auto const summary = integrate(Space{}, stepper, generator, spins, Times{0, 0.05, 20});
    EXPECT_EQ(summary.evaluations, 3 * 4 * (1 + 2 * 19));
    EXPECT_EQ(stepper.slow_evaluations_done(), run * (19 + 3 * 4 + 2));
    EXPECT_EQ(slow.evaluations_done(), stepper.slow_evaluations_done());
  }
  EXPECT_EQ(stepper.work_bytes(), (5 + Rkmk4<Spins>::work_fields) * spins.bytes());
  EXPECT_EQ(decltype(stepper)::work_fields, 5 + Rkmk4<Spins>::work_fields);
}

TEST(SlowField, StartsAnew) {
  Spins const start = random_spins(small_block, 5);
  auto const slow = multirate_long_range(start, 0.4);
  auto const generator = with_multirate(small_block, 0.5, slow, 0.1);
  auto stepper = multirate(start, slow, 2);
  auto const again = [&] {
    Spins spins = copy_of(start);
    advance(stepper, generator, spins, 0.05, 6);
    return copy_to_host(spins);
  };
  auto const fresh = again();
  EXPECT_NE(again(), fresh);
  stepper.reset();
  EXPECT_EQ(again(), fresh);

  // A step that is more than twice as long as the last one, or has the other sign, is treated as a
  // first step. A step of length 0 does nothing.
  Spins spins = copy_of(start);
  auto const evaluations_of = [&](double dt) {
    auto const before = stepper.slow_evaluations_done();
    stepper.step(Space{}, generator, spins, 0, dt);
    return stepper.slow_evaluations_done() - before;
  };
  stepper.reset();
  EXPECT_EQ(evaluations_of(0.01), 2 + 2 * 4);
  for (double const dt : {0.02, 0.04, 0.001, 0.002}) EXPECT_EQ(evaluations_of(dt), 1);
  EXPECT_EQ(evaluations_of(0), 0);
  EXPECT_EQ(evaluations_of(0.005), 2 + 2 * 4);
  EXPECT_EQ(evaluations_of(-0.005), 2 + 2 * 4);
}

template <class Field>
void expect_same_bits_after_a_break(int steps_before) {
  Field const start = random_spins<Field>(small_block, 5);
  auto const slow = multirate_long_range(start, 0.4);
  auto const generator = with_multirate(small_block, 0.5, slow, 0.1, 0.6);
  auto const whole = [&] {
    Field spins = copy_of(start);
    auto stepper = multirate<4>(spins, slow, 2);
    advance(stepper, generator, spins, 0.05, 12);
    return copy_to_host(spins);
  }();

  CheckpointInMemory kept;
  Field spins = copy_of(start);
  auto first = multirate<4>(spins, slow, 2);
  advance(first, generator, spins, 0.05, steps_before);
  serialize(first, kept);
  kept.close();
  Field others = copy_of(spins);
  auto const other_multirate = multirate_long_range(others, 0.4);
  auto second = multirate<4>(others, other_multirate, 2);
  serialize(second, kept);
  advance(second, with_multirate(small_block, 0.5, other_multirate, 0.1, 0.6), others, 0.05,
          12 - steps_before, steps_before);
  EXPECT_EQ(copy_to_host(others), whole) << steps_before;
  EXPECT_EQ(second.slow_evaluations_done(), 2 + 2 * 4 + 11);
}

TEST(SlowField, SameBitsAfterABreak) {
  for (int const steps : {0, 1, 2, 3, 4, 9}) {
    expect_same_bits_after_a_break<SpinField<double, Space::memory_space>>(steps);
    expect_same_bits_after_a_break<SpinField<float, Space::memory_space>>(steps);
  }
}

TEST(SlowField, SinglePrecision) {
  using Floats = SpinField<float, Space::memory_space>;
  auto const end_of = [&]<class Field>(Field spins) {
    auto const slow = multirate_long_range(spins, 0.4);
    auto stepper = multirate(spins, slow, 2);
    advance(stepper, with_multirate(small_block, 0.5, slow, 0.1, 0.6), spins, 0.02, 50);
    return spins;
  };
  double const distance = largest_distance(end_of(random_spins(small_block, 5)),
                                           end_of(random_spins<Floats>(small_block, 5)));
  expect_below("float beside double, 50 steps", distance, 50 * 2 * 1.2e-7);
  EXPECT_GT(distance, 1e-8);
}

#if defined(CAYSPIN_TEST_TWO_HOST_SPACES)
template <class Exec, class Field>
std::vector<typename Field::value_type> end_in(Field const& start) {
  Field spins = copy_of(start);
  auto const slow = multirate_long_range(spins, 0.2);
  auto const generator = with_multirate(start.lattice(), 0.5, slow, 0.1, 0.6);
  auto stepper = multirate(spins, slow, 2);
  Exec const exec;
  for (int n = 0; n < 5; ++n) stepper.step(exec, generator, spins, n * 0.05, 0.05);
  exec.fence();
  return copy_to_host(spins);
}
TEST(SlowField, SameBitsOnHostSpaces) {
  // a few that are split into many tasks, open and periodic
  for (std::size_t const which : {10, 13, 19, 22}) {
    Lattice const lattice = odd_lattices()[which];
    auto const check = [&]<class Field>(Field const& start) {
      auto const one = end_in<Kokkos::Serial>(start);
      ASSERT_NE(one, copy_to_host(start));
      expect_equal_bits(one, end_in<Threaded>(start), name_of(lattice));
    };
    check(random_spins<SpinField<double, Kokkos::HostSpace>>(lattice, 11));
    check(random_spins<SpinField<float, Kokkos::HostSpace>>(lattice, 11));
  }
}
#endif

/// The expensive term is one of the library, whose field is computed in kernels, not on the host.
TEST(SlowField, TakesAnyTermOfKnownDegree) {
  Spins spins = random_spins(small_block, 5);
  SlabDemag const slab{Vector{1, 2, 0}, 0.7};
  SlowField const slow(spins, slab);
  EffectiveField const field(Exchange{small_block, 0.5}, slow);
  EffectiveField const cheap(Exchange{small_block, 0.5}, slab);
  double const energy = sample(Space{}, LandauLifshitz{cheap, 0.1}, Step{}, spins).energy.value;
  EXPECT_NEAR(sample(Space{}, LandauLifshitz{field, 0.1}, Step{}, spins).energy.value, energy,
              1e-14 * 60);
  Spins const exact = run<Rkmk4<Spins>>(LandauLifshitz{cheap, 0.1}, spins, 0.01, 100);
  Multirate stepper(spins, Rkmk4<Spins>(spins), slow, {.substeps = 4});
  advance(stepper, LandauLifshitz{field, 0.1}, spins, 0.04, 25);
  double const distance = largest_distance(spins, exact);
  expect_below("apart from RK4", distance, 1e-4);
  EXPECT_GT(distance, 1e-9);
}

/// A field that throws from a given time on.
struct Failing : LongRange {
  double from = 0;

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double t) const {
    if (t >= from) throw std::runtime_error("from here on");
    LongRange::operator()(spins, field, t);
  }
};

// The field fails within the first step, at its end, or in the third step.
TEST(SlowField, LeavesTheSpinsOfAStepThatFails) {
  Spins const start = random_spins(small_block, 5);
  for (double const from : {0.07, 0.1, 0.25}) {
    Spins spins = copy_of(start);
    SlowField const slow(spins, HostField<Spins, Failing>(spins, Failing{{0.4}, from}));
    auto const generator = with_multirate(small_block, 0.5, slow, 0.1);
    Multirate stepper(spins, Rkmk4<Spins>(spins), slow, {.substeps = 2});
    std::vector<double> before;
    int whole = 0;
    for (bool failed = false; !failed; whole += !failed) {
      before = copy_to_host(spins);
      try {
        stepper.step(Space{}, generator, spins, 0.1 * whole, 0.1);
      } catch (std::runtime_error const&) {
        failed = true;
      }
    }
    EXPECT_EQ(whole, from < 0.2 ? 0 : 2);
    EXPECT_EQ(copy_to_host(spins), before);
    auto const evaluations = slow.evaluations_done();
    stepper.step(Space{}, generator, spins, -1, 0.1);
    EXPECT_EQ(slow.evaluations_done() - evaluations, 2 + 2 * 4);
  }
}

template <class Field>
void expect_unit_spins_at_any_step() {
  double const eps = std::numeric_limits<typename Field::value_type>::epsilon();
  for (double const dt : {5e-324, 1e-300, 1e-12, 1., 10.}) {
    Field const start = random_spins<Field>(small_block, 5);
    Field spins = copy_of(start);
    auto const slow = multirate_long_range(spins, 0.4);
    auto stepper = multirate(spins, slow, 3);
    auto const generator = with_multirate(small_block, 0.5, slow, 0.1);
    for (double const t : {0., 1., 1e20}) stepper.step(Space{}, generator, spins, t, dt);
    auto const seen = sample(Space{}, generator, Step{}, spins);
    EXPECT_LT(seen.norm_defect, 100 * eps) << dt;
    EXPECT_TRUE(std::isfinite(seen.energy.value)) << dt;
    EXPECT_EQ(stepper.slow_evaluations_done(), 2 + 3 * 4 + 2) << dt;
    if (dt < 1e-200) {
      EXPECT_LT(largest_distance(spins, start), 20 * eps) << dt;
    }
  }
}
TEST(SlowField, KeepsUnitSpinsAtAnyStep) {
  expect_unit_spins_at_any_step<SpinField<double, Space::memory_space>>();
  expect_unit_spins_at_any_step<SpinField<float, Space::memory_space>>();
}

TEST(SlowField, RestsWhereNothingTurns) {
  Spins spins("spins", small_block);  // all along z
  auto const start = copy_to_host(spins);
  auto const slow = multirate_long_range(spins, 0);
  LandauLifshitz const generator(EffectiveField(Exchange{small_block, 0.5}, slow), 0.1);
  auto stepper = multirate(spins, slow, 3);
  advance(stepper, generator, spins, 0.1, 10);
  EXPECT_EQ(copy_to_host(spins), start);
}

TEST(SlowField, RefusesWrongCalls) {
  Spins spins = random_spins(small_block, 3);
  Spins elsewhere("other", Lattice::chain(5));
  auto const slow = multirate_long_range(spins, 0.4), other = multirate_long_range(spins, 0.4);
  auto const generator = with_multirate(small_block, 0.5, other, 0.1);
  auto stepper = multirate(spins, slow, 2);
  advance(stepper, generator, spins, 0.05, 1);
  expect_refused({{"no substeps", [&] { multirate(spins, slow, 0); }},
                  {"another lattice", [&] { multirate(elsewhere, slow, 1); }},
                  {"another expensive term", [&] { advance(stepper, generator, spins, 0.05, 1); }},
                  {"other spins", [&] { stepper.step(Space{}, generator, elsewhere, 0, 0.1); }}});
  // The refused step has stored no field.
  auto const before = other.evaluations_done();
  sample(Space{}, generator, Step{}, spins);
  EXPECT_EQ(other.evaluations_done(), before + 1);
}

}  // namespace
