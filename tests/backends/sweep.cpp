// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A sweep, which takes all stages through the lattice together, gives results that are bitwise
// identical to those of one kernel per stage.
#include "sweeping.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Real>
using Sweep = InHostMemory<Real>;
TYPED_TEST_SUITE(Sweep, Precisions, PrecisionName);

template <class Exec, class Stepper, class Generator>
auto numbers_after_steps(Path path, Generator const& generator,
                         typename Stepper::spins_type const& start) {
  Exec const exec;
  auto spins = copy_of(start);
  Stepper stepper(spins);
  stepper.use(path);
  for (int n = 0; n < 2; ++n) stepper.step(exec, generator, spins, n * 0.1, 0.1);
  exec.fence();
  EXPECT_EQ(stepper.path(), path);
  return copy_to_host(spins);
}

template <class Stepper, class Choose>
void expect_same_on_both_paths(Choose const& choose,
                               std::vector<Lattice> const& lattices = swept_lattices()) {
  using Field = typename Stepper::spins_type;
  int swept = 0;
  for (Lattice const& lattice : lattices) {
    if (!can_sweep(lattice, Stepper::evaluations)) continue;
    ++swept;
    auto const generator = choose(every_term(lattice));
    auto const start = random_spins<Field>(lattice, 13);
    auto const passed = numbers_after_steps<Threaded, Stepper>(Path::pass, generator, start);
    ASSERT_NE(passed, copy_to_host(start)) << "nothing moved: " << name_of(lattice);
    expect_equal_bits(passed, numbers_after_steps<Threaded, Stepper>(Path::sweep, generator, start),
                      name_of(lattice));
    expect_equal_bits(passed,
                      numbers_after_steps<Kokkos::Serial, Stepper>(Path::sweep, generator, start),
                      name_of(lattice) + "on Serial");
  }
  EXPECT_GT(swept, 0);
}

TYPED_TEST(Sweep, LieHeun) {
  expect_same_on_both_paths<LieHeun<typename TestFixture::Field>>(turning);
}

TYPED_TEST(Sweep, Rkmk4) { expect_same_on_both_paths<Rkmk4<typename TestFixture::Field>>(turning); }

TYPED_TEST(Sweep, StagesThatReadAllBeforeThem) {
  expect_same_on_both_paths<Rkmk<typename TestFixture::Field, tableau::ThreeEighths4>>(turning);
}

TYPED_TEST(Sweep, EightAndTwelveStages) {
  using Field = typename TestFixture::Field;
  expect_same_on_both_paths<ProjectedRungeKutta<Field, tableau::Oscillatory86>>(turning);
  expect_same_on_both_paths<Rkmk<Field, tableau::DormandPrince8>>(turning,
                                                                  smaller_swept_lattices());
  expect_same_on_both_paths<StereographicRungeKutta<Field, tableau::DormandPrince8>>(
      turning, smaller_swept_lattices());
}

TYPED_TEST(Sweep, TwoRotations) {
  expect_same_on_both_paths<CommutatorFree4<typename TestFixture::Field>>(turning);
}

TYPED_TEST(Sweep, StereographicRungeKutta) {
  expect_same_on_both_paths<
      StereographicRungeKutta<typename TestFixture::Field, tableau::Classical4>>(turning);
}

TYPED_TEST(Sweep, IncrementsRecoveredFromSpins) {
  expect_same_on_both_paths<
      ProjectedRungeKutta<typename TestFixture::Field, tableau::Oscillatory74>>(turning);
}

TYPED_TEST(Sweep, Compensated) {
  expect_same_on_both_paths<Compensated<Rkmk4<typename TestFixture::Field>>>(turning);
}

// Coefficients and vacancies are read from fields on the whole lattice, not from a sweep's buffers.
TYPED_TEST(Sweep, SiteDependentCoefficients) {
  using Field = typename TestFixture::Field;
  expect_same_on_both_paths<LieHeun<Field>>(site_dependent<Field>);
}

TYPED_TEST(Sweep, LeavesOffUnderANonlocalField) {
  expect_passes_under_a_nonlocal_field<LieHeun<typename TestFixture::Field>>(0.1);
}

template <class Stepper>
void expect_memory(std::size_t fields_of_sweep, std::size_t fields_of_pass) {
  expect_chosen_and_predicted<Stepper>(150);
  auto const lattice = Lattice::cubic(150, 150, 150);
  std::size_t const field = typename Stepper::spins_type("spins", lattice).bytes();
  PredictedRun run{.threads = Threaded().concurrency()};
  EXPECT_LT(Stepper::work_bytes(lattice, run), fields_of_sweep * field);
  run.by_time_only = false;
  EXPECT_EQ(Stepper::work_bytes(lattice, run), fields_of_pass * field);
}

TYPED_TEST(Sweep, ChosenAndPredictedBySize) {
  using Field = typename TestFixture::Field;
  expect_memory<Rkmk4<Field>>(2, 4);
  expect_memory<Compensated<Rkmk4<Field>>>(3, 5);
}

// On wide lattices with few rows, a sweep's buffers for twelve stages would take more memory than
// all fields of a pass.
TYPED_TEST(Sweep, IsLeftWhereItsBuffersExceedFields) {
  using Field = typename TestFixture::Field;
  auto const expect_bounded = [](std::size_t (*work_bytes)(Lattice const&, PredictedRun const&)) {
    for (std::array<std::int64_t, 3> const shape :
         {std::array<std::int64_t, 3>{2003, 41, 3}, {3001, 53, 2}, {4000, 64, 64}, {256, 256, 256}})
      for (int const threads : {1, 2, 8, 64}) {
        Lattice const lattice{shape, {1, 1, 1}, {}};
        std::size_t const passes = work_bytes(lattice, {.threads = threads, .by_time_only = false});
        std::size_t const field = RowLayout::of<typename Field::value_type>(lattice).allocation(3) *
                                  sizeof(typename Field::value_type);
        std::size_t const sweep = work_bytes(lattice, {.threads = threads});
        EXPECT_LE(sweep, passes + field) << name_of(lattice) << threads;
      }
  };
  expect_bounded(&Rkmk4<Field>::work_bytes);
  expect_bounded(&Rkmk<Field, tableau::DormandPrince8>::work_bytes);
}

// batch() would read memory that a sweeping stepper does not have, so such a stepper refuses it.
TYPED_TEST(Sweep, RefusesBatches) {
  typename TestFixture::Field spins("spins", Lattice::cubic(8, 8, 8));
  Rkmk4 stepper(spins);
  stepper.use(Path::sweep);
  LandauLifshitz const generator(EffectiveField(Zeeman{{1, 0, 0}}), 0.1);
  EXPECT_THROW(stepper.batch(Threaded(), generator, spins, 0, 0.1, 2), std::invalid_argument);
}

TEST(SweepRefusals, OneStageAndFewPeriodicRows) {
  using Field = SpinField<double, Kokkos::HostSpace>;
  auto const lattice = Lattice::cubic(9, 3, 3, 1, Boundary::periodic);
  Field const like("spins", lattice);
  LieEuler<Field> euler(like);
  EXPECT_THROW(euler.use(Path::sweep), std::invalid_argument);
  Rkmk4<Field> rkmk4(like);
  EXPECT_THROW(rkmk4.use(Path::sweep), std::invalid_argument);
  LieHeun<Field>(like).use(Path::sweep);
}

}  // namespace
