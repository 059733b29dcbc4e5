// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// With compensated sums, round-off does not grow with the number of steps.
#include "../support/backends.hpp"
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Real>
using SpinsOf = SpinField<Real, Space::memory_space>;

template <class Real>
struct Compensation : ::testing::Test {
  using Field = SpinsOf<Real>;
};
TYPED_TEST_SUITE(Compensation, Precisions, PrecisionName);

// By Knuth's theorem, sum + residual equals a + b exactly.
TYPED_TEST(Compensation, SumAndResidualAreTheTwoNumbers) {
  using Real = TypeParam;
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal;
  auto const number = [&](double size) { return static_cast<Real>(size * normal(engine)); };
  int rounded = 0;
  for (double const size : {1e-12, 1e-6, 1e-2, 1.0, 30.0})
    for (int n = 0; n < 100; ++n) {
      Vec3<Real> const a{number(1), number(1), number(1)},
          b{number(size), number(size), number(size)};
      auto const both = detail::rounded_sum(a, b);
      for (auto const c : {&Vec3<Real>::x, &Vec3<Real>::y, &Vec3<Real>::z}) {
        EXPECT_EQ(both.sum.*c, a.*c + b.*c);
        // Both differences are exact: sum - larger is a multiple of the last digit of the smaller.
        bool const a_larger = std::abs(a.*c) > std::abs(b.*c);
        Real const larger = a_larger ? a.*c : b.*c, smaller = a_larger ? b.*c : a.*c;
        EXPECT_EQ(both.residual.*c, smaller - (both.sum.*c - larger));
        rounded += both.residual.*c != 0;
      }
    }
  EXPECT_GT(rounded, 500);
}

/// Returns the error after spins have turned about a constant field by one radian, in `steps`
/// steps.
template <class Stepper>
double error_of_precession(std::int64_t steps) {
  using Field = typename Stepper::spins_type;
  auto const lattice = Lattice::chain(5);
  Vector const axis = (1. / 3) * Vector{1, 2, -2};
  auto const start = random_spins<Field>(lattice, 11);
  Field spins = copy_of(start);
  Stepper stepper(spins);
  LandauLifshitz const generator(EffectiveField(Zeeman{axis}), 0);
  double const dt = 1. / static_cast<double>(steps);
  integrate(Space(), stepper, generator, spins, Times{0, dt, steps});
  double largest = 0;
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    largest =
        larger(largest, length(spin(spins, site) - Exponential::rotate(axis, spin(start, site))));
  return largest;
}

template <class Stepper>
void expect_no_growth(char const* name) {
  using Real = typename Stepper::Real;
  constexpr std::int64_t steps = 100000;
  double const with = error_of_precession<Compensated<Stepper>>(steps) / epsilon<Real>;
  double const without = error_of_precession<Stepper>(steps) / epsilon<Real>;
  std::printf("    %-24s %.3g epsilon, without %.3g\n", name, with, without);
  EXPECT_LT(with, 4) << name;
  EXPECT_GT(without, 40) << name << ": nothing to compensate";
}

TYPED_TEST(Compensation, ManyShortStepsAddNothing) {
  using Field = typename TestFixture::Field;
  expect_no_growth<Rkmk4<Field>>("rkmk4");
  expect_no_growth<StereographicRungeKutta<Field, tableau::Classical4>>("in the chart");
  expect_no_growth<CommutatorFree4<Field>>("two rotations");
  expect_no_growth<ProjectedRk4<Field>>("projected");
}

Slab const rounded_slab{.lattice = {{9, 7, 1}},
                        .exchange = 1,
                        .anisotropy = 0.8,
                        .axis = {1, 2, 3},
                        .demag = 1,
                        .applied = {0.5, -0.7, 0.9},
                        .damping = 0.1};

/// Returns the distance of a run in float from the same steps in double, in epsilons of float.
template <template <class> class Method, template <class> class Sums>
double round_off(std::int64_t steps) {
  auto const start = random_spins<SpinsOf<float>>(rounded_slab.lattice, 3);
  Spins same("same", rounded_slab.lattice);
  copy_from_host(copy_to_host(start), same);
  double const dt = 2. / static_cast<double>(steps);
  auto const end = run<Sums<Method<SpinsOf<float>>>>(rounded_slab.natural(), start, dt, steps);
  auto const exact = run<Method<Spins>>(rounded_slab.natural(), same, dt, steps);
  return largest_distance(end, exact) / epsilon<float>;
}

template <class Stepper>
using Plain = Stepper;
template <class Spins>
using OnGroup = Rkmk4<Spins>;
template <class Spins>
using OnChart = StereographicRungeKutta<Spins, tableau::Classical4>;

template <template <class> class Method>
void expect_round_off_of_increments(char const* name) {
  for (std::int64_t const steps : {100, 10000}) {
    double const with = round_off<Method, Compensated>(steps);
    double const without = round_off<Method, Plain>(steps);
    std::printf("    %-12s %6ld steps: %.3g epsilon, without %.3g\n", name, long(steps), with,
                without);
    EXPECT_LT(with, 16) << name << ' ' << steps;
    if (steps > 1000) {
      EXPECT_GT(without, 80) << name;
    }
  }
}

TEST(CompensatedFloat, CoupledSpinsKeepTheirDigits) {
  expect_round_off_of_increments<OnGroup>("rkmk4");
  expect_round_off_of_increments<OnChart>("in the chart");
}

TYPED_TEST(Compensation, BatchesAndStepsHaveTheSameBits) {
  using Field = typename TestFixture::Field;
  auto const start = random_spins<Field>(rounded_slab.lattice, 5);
  auto const one_by_one = run<Compensated<Rkmk4<Field>>>(rounded_slab.natural(), start, 0.01, 50);
  Field together = copy_of(start);
  Compensated<Rkmk4<Field>> stepper(together);
  ASSERT_TRUE(!detail::is_host_execution<Space> ||
              stepper.takes_batches(Space(), rounded_slab.natural(), together));
  integrate(Space(), stepper, rounded_slab.natural(), together, Times{0, 0.01, 50});
  EXPECT_EQ(copy_to_host(together), copy_to_host(one_by_one));
  EXPECT_NE(copy_to_host(together),
            copy_to_host(run<Rkmk4<Field>>(rounded_slab.natural(), start, 0.01, 50)));
}

}  // namespace
