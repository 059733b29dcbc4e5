// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// An adaptive method takes bitwise identical steps by sweeps and by passes, also if steps are
// rejected, or end at or after a requested time.
#include "sweeping.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Real>
using AdaptiveSweep = InHostMemory<Real>;
TYPED_TEST_SUITE(AdaptiveSweep, Precisions, PrecisionName);

/// The first step is too long, and the last one ends with the run.
StepOptions const options{.tolerance = 3e-3, .first_dt = 1.5, .end = 0.9};

/// The spins at several times, and the stepper's counts and next dt at these times.
template <class Real>
struct Run {
  std::vector<std::vector<Real>> spins;
  std::vector<double> counts;
  std::int64_t rejected = 0;
};

template <class Exec, class Stepper, class Generator>
auto run(Path path, Generator const& generator, typename Stepper::spins_type const& start) {
  Exec const exec;
  auto spins = copy_of(start);
  Stepper stepper(spins, options);
  stepper.use(path);
  Run<typename Stepper::Real> seen;
  double t = 0;
  for (double const asked : {0.6, 0.61, 0.62, 0.9}) {
    stepper.step(exec, generator, spins, t, asked - t);
    t = asked;
    seen.spins.push_back(copy_to_host(spins));
    seen.counts.insert(seen.counts.end(),
                       {static_cast<double>(stepper.evaluations_done()),
                        static_cast<double>(stepper.accepted_steps()),
                        static_cast<double>(stepper.rejected_steps()), stepper.next_dt()});
  }
  EXPECT_EQ(stepper.path(), path);
  seen.rejected = stepper.rejected_steps();
  return seen;
}

template <class Real>
void expect_same(Run<Real> const& one, Run<Real> const& other, std::string const& where) {
  ASSERT_EQ(one.counts, other.counts) << where;
  for (std::size_t i = 0; i < one.spins.size(); ++i)
    expect_equal_bits(one.spins[i], other.spins[i], where + ", time " + std::to_string(i));
}

template <class Stepper>
void expect_same_on_both_paths() {
  using Field = typename Stepper::spins_type;
  std::int64_t rejected = 0, lattices = 0;
  for (Lattice const& lattice : smaller_swept_lattices()) {
    if (!can_sweep(lattice, Stepper::ghosts)) continue;
    auto const generator = turning(every_term(lattice));
    auto const start = random_spins<Field>(lattice, 13);
    auto const passed = run<Threaded, Stepper>(Path::pass, generator, start);
    rejected += passed.rejected;
    ++lattices;
    ASSERT_NE(passed.spins[1], passed.spins[2]) << name_of(lattice);
    expect_same(passed, run<Threaded, Stepper>(Path::sweep, generator, start), name_of(lattice));
    expect_same(passed, run<Kokkos::Serial, Stepper>(Path::sweep, generator, start),
                name_of(lattice) + "on Serial");
  }
  EXPECT_GT(2 * rejected, lattices);
}

TYPED_TEST(AdaptiveSweep, OnTheGroup) {
  using Field = typename TestFixture::Field;
  expect_same_on_both_paths<AdaptiveRkmk<Field, tableau::Tsitouras5>>();
  expect_same_on_both_paths<AdaptiveRkmk<Field, tableau::DormandPrince5, isotropy::Constant>>();
}

TYPED_TEST(AdaptiveSweep, InTheChart) {
  expect_same_on_both_paths<
      AdaptiveStereographic<typename TestFixture::Field, tableau::BogackiShampine3>>();
}

TYPED_TEST(AdaptiveSweep, InSpace) {
  expect_same_on_both_paths<AdaptiveProjected<typename TestFixture::Field>>();
}

// A sweep leaves out the increments of a step that ends before the wanted time.
TYPED_TEST(AdaptiveSweep, GivesSpinsBeforeTheTimeThatAnEarlierCallWanted) {
  using Field = typename TestFixture::Field;
  auto const lattice = Lattice::cubic(70, 20, 20);
  auto const generator = turning(every_term(lattice));
  auto const start = random_spins<Field>(lattice, 13);
  Threaded const exec;
  std::vector<std::vector<TypeParam>> seen;
  for (Path const path : {Path::pass, Path::sweep}) {
    auto spins = copy_of(start);
    AdaptiveRkmk<Field> stepper(spins,
                                {.tolerance = 1, .first_dt = 0.05, .min_dt = 0.05, .max_dt = 0.05});
    stepper.use(path);
    stepper.step_towards(exec, generator, spins, 0, 0.01, 0.5);
    expect_equal_bits(copy_to_host(spins), copy_to_host(start), "not yet wanted");
    stepper.step(exec, generator, spins, 0.01, 0.02);
    EXPECT_EQ(stepper.accepted_steps(), 1);
    seen.push_back(copy_to_host(spins));
    stepper.step(exec, generator, spins, 0.03, 0.04);
    EXPECT_EQ(stepper.accepted_steps(), 2);
    EXPECT_EQ(stepper.path(), path);
    seen.push_back(copy_to_host(spins));
  }
  expect_equal_bits(seen[0], seen[2], "within the first step");
  expect_equal_bits(seen[1], seen[3], "within the second step");
}

TYPED_TEST(AdaptiveSweep, LeavesOffUnderANonlocalField) {
  expect_passes_under_a_nonlocal_field<AdaptiveRkmk<typename TestFixture::Field>>(0.5, options);
}

TYPED_TEST(AdaptiveSweep, ChosenAndPredictedBySize) {
  using Stepper = AdaptiveRkmk<typename TestFixture::Field>;
  expect_chosen_and_predicted<Stepper>(120, options);
  auto const lattice = Lattice::cubic(120, 120, 120);
  PredictedRun const run{.threads = Threaded().concurrency(), .by_time_only = false};
  EXPECT_EQ(Stepper::work_bytes(lattice, run),
            11 * typename TestFixture::Field("spins", lattice).bytes() +
                ScalarField<TypeParam>("square", lattice).bytes());
}

}  // namespace
