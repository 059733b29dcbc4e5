// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// What is kept from step to step: counts, new starts, jumps of the fields; precisions and spaces.
#include "rotating_slab.hpp"

#include <array>

#if defined(KOKKOS_ENABLE_SERIAL) && \
    (defined(KOKKOS_ENABLE_OPENMP) || defined(KOKKOS_ENABLE_THREADS))
#include "../backends/equal_bits.hpp"
#define CAYSPIN_TEST_TWO_HOST_SPACES
#endif

using namespace cayspin;
using namespace cayspin::test;

namespace {

Lattice const block{{5, 4, 3}, {1, 1.1, 0.9}, {Boundary::periodic, Boundary::open, Boundary::open}};

using Plain = FieldExtrapolation4<Spins>;
using Estimating = FieldExtrapolation4<Spins, true>;

TEST(FieldExtrapolation, CountsEvaluations) {
  auto const generator = rotating_slab(hard_magnet(block, 0.1), 0.6);
  Spins spins = random_spins(block, 3);
  Plain stepper(spins);
  for (int run = 0; run < 2; ++run) {
    auto const summary = integrate(Space{}, stepper, generator, spins, Times{0, 0.01, 20});
    EXPECT_EQ(summary.evaluations, 3 * 5 + 17);
    EXPECT_EQ(stepper.starts(), run + 1);
  }
  std::size_t const field = spins.bytes();
  EXPECT_EQ(Plain::work_fields, 8);
  EXPECT_EQ(stepper.work_bytes(), 8 * field);
  EXPECT_EQ(Plain::work_bytes(block, true, 2), stepper.work_bytes());
  EXPECT_EQ(Estimating(spins).work_bytes(), Estimating::work_bytes(block, true, 2));
  EXPECT_GT(Estimating(spins).work_bytes(), 9 * field);
}

TEST(FieldExtrapolation, StartsAnew) {
  auto const generator = rotating_slab(hard_magnet(block, 0.1), 0);
  Spins const start = random_spins(block, 5);
  auto const fresh = copy_to_host(run<Plain>(generator, start, 0.05, 6));
  Plain stepper(start);
  auto const again = [&] {
    Spins spins = copy_of(start);
    advance(stepper, generator, spins, 0.05, 6);
    return copy_to_host(spins);
  };
  EXPECT_EQ(again(), fresh);
  EXPECT_NE(again(), fresh);
  stepper.reset();
  EXPECT_EQ(again(), fresh);

  // Steps that grow too much or turn round start anew; those of length 0 do nothing.
  Spins spins = copy_of(start);
  auto const starts_after = [&](double dt) {
    stepper.step(Space{}, generator, spins, 0, dt);
    return stepper.starts();
  };
  stepper.reset();
  auto const before = starts_after(0.01);
  for (double const dt : {0.02, 0.04, 0.001, 0.0, 0.002}) EXPECT_EQ(starts_after(dt), before);
  EXPECT_EQ(starts_after(0.005), before + 1);
  EXPECT_EQ(starts_after(-0.005), before + 2);
}

TEST(FieldExtrapolation, UnequalStepsKeepTheOrder) {
  auto const generator = rotating_slab(hard_magnet(block, 0.1), 0.6);
  Spins const start = random_spins(block, 5);
  Spins const exact = run<Rkmk4<Spins>>(generator, start, 5e-4, 1000);
  std::array const ladder{20, 40, 80, 160};  // pairs
  expect_convergence("unequal steps", 0.5, ladder, 4, 0.2, [&](int pairs, double) {
    Spins spins = copy_of(start);
    Plain stepper(spins);
    double t = 0;
    for (int n = 0; n < 2 * pairs; ++n) {
      double const dt = (n % 2 == 0 ? 1 : 2) * 0.5 / (3 * pairs);
      stepper.step(Space{}, generator, spins, t, dt);
      t += dt;
    }
    EXPECT_EQ(stepper.starts(), 1);
    return largest_distance(spins, exact);
  });
}

/// The error at the end of a run whose exchange is doubled half way.
template <class Stepper>
double error_past_a_jump(double dt, bool told, std::int64_t starts,
                         FieldExtrapolationOptions const& options = {}) {
  Slab slab = hard_magnet(block, 0.1);
  Spins spins = random_spins(block, 5), exact = copy_of(spins);
  auto stepper = [&] {
    if constexpr (std::is_same_v<Stepper, Plain>)
      return Stepper(spins);
    else
      return Stepper(spins, options);
  }();
  Rkmk4<Spins> fine(spins);
  int const half = static_cast<int>(std::lround(0.5 / dt));
  for (int part = 0; part < 2; ++part) {
    auto const generator = rotating_slab(slab, 0);
    advance(stepper, generator, spins, dt, half);
    advance(fine, generator, exact, dt / 4, 4 * half);
    slab.exchange *= 2;
    if (told) stepper.reset();
  }
  EXPECT_EQ(stepper.starts(), starts);
  return largest_distance(spins, exact);
}

TEST(FieldExtrapolation, NoticesAJumpOfTheNeighborField) {
  double const never = std::numeric_limits<double>::infinity();
  for (double const dt : {0.02, 0.01, 0.005}) {
    double const told = error_past_a_jump<Plain>(dt, true, 2);
    double const untold = error_past_a_jump<Plain>(dt, false, 1);
    double const noticed = error_past_a_jump<Estimating>(dt, false, 2);
    double const by_angle = error_past_a_jump<Estimating>(dt, false, 2, {dt / 20, never});
    double const by_growth = error_past_a_jump<Estimating>(dt, false, 2, {never, 50});
    std::printf("    dt %-6g errors: told %.2e, noticed %.2e, unnoticed %.2e\n", dt, told, noticed,
                untold);
    EXPECT_EQ(noticed, told);
    EXPECT_EQ(by_angle, told);
    EXPECT_EQ(by_growth, told);
    EXPECT_GT(untold, 20 * told);
    EXPECT_EQ(error_past_a_jump<Estimating>(dt, false, 1, {never, never}), untold);
  }
}

TEST(FieldExtrapolation, SinglePrecision) {
  using Floats = SpinField<float, Space::memory_space>;
  auto const generator = rotating_slab(hard_magnet(block, 0.1), 0.6);
  auto const end = run<Estimating>(generator, random_spins(block, 5), 0.01, 50);
  auto const rounded =
      run<FieldExtrapolation4<Floats, true>>(generator, random_spins<Floats>(block, 5), 0.01, 50);
  double const distance = largest_distance(end, rounded);
  expect_below("float beside double, 50 steps", distance, 50 * 1.2e-7);
  EXPECT_GT(distance, 1e-8);
  EXPECT_EQ(largest_distance(end, run<Plain>(generator, random_spins(block, 5), 0.01, 50)), 0);
}

#if defined(CAYSPIN_TEST_TWO_HOST_SPACES)
template <class Stepper>
void expect_same_bits() {
  for (std::size_t const which : {10, 13, 19, 22}) {  // some of many tasks, open and periodic
    Lattice const lattice = odd_lattices()[which];
    auto const generator = rotating_slab(every_term(lattice), 0.6);
    auto const start = random_spins<typename Stepper::spins_type>(lattice, 11);
    Outcome<Kokkos::Serial, Stepper, RotatingSlab> const one(generator, start);
    Outcome<Threaded, Stepper, RotatingSlab> const many(generator, start);
    ASSERT_NE(one.numbers, copy_to_host(start));
    expect_equal_bits(one.numbers, many.numbers, name_of(lattice));
  }
}

TEST(FieldExtrapolation, SameBitsOnHostSpaces) {
  expect_same_bits<FieldExtrapolation4<SpinField<double, Kokkos::HostSpace>, true>>();
  expect_same_bits<FieldExtrapolation4<SpinField<float, Kokkos::HostSpace>, true>>();
}
#endif

// Rows of an even and odd number of packs, and those that are cut up: spins that are alike stay so.
TEST(FieldExtrapolation, StepsEverySiteOnce) {
  for (std::int64_t const sites : {4, 8, 24, 32, 40, 48, 104, 9000, 20008}) {
    Lattice const ring{
        {sites, 1, 1}, {1, 1, 1}, {Boundary::periodic, Boundary::open, Boundary::open}};
    auto const generator = rotating_slab(hard_magnet(ring, 0.1), 0.6);
    auto const four = copy_to_host(random_spins(Lattice::chain(4), 7));
    auto const start = make_spins(ring, [&](auto i, auto, auto) {
      auto const* const m = four.data() + 3 * (i % 4);
      return Vector{m[0], m[1], m[2]};
    });
    auto const end = copy_to_host(run<Plain>(generator, start, 0.05, 6));
    EXPECT_NE(end, copy_to_host(start));
    for (std::size_t i = 12; i < end.size(); ++i)
      ASSERT_EQ(end[i], end[i - 12]) << sites << ' ' << i;
  }
}

TEST(FieldExtrapolation, RefusesAnotherLattice) {
  auto const generator = rotating_slab(hard_magnet(block, 0.1), 0);
  Spins other("other", Lattice::chain(5));
  Plain stepper(random_spins(block, 3));
  EXPECT_THROW(stepper.step(Space{}, generator, other, 0, 0.1), std::invalid_argument);
}

}  // namespace
