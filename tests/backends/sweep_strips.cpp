// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A sweep divided among many threads: little is computed twice, all threads have work, and a slow
// thread does not change the result.
#include "equal_bits.hpp"

#include <cayspin/detail/sweep_plan.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Real>
using SweepStrips = InHostMemory<Real>;
TYPED_TEST_SUITE(SweepStrips, Precisions, PrecisionName);

/// Base of the field terms below, whose fields and energies are zero.
struct NoField {
  static constexpr int degree = 1;

  template <class Stencil>
  KOKKOS_FUNCTION typename Stencil::value_type energy_density(Stencil const&) const {
    return typename Stencil::value_type(0);
  }
};

/// A term that counts its evaluations, one for each pack of a row.
struct CountedCalls : NoField {
  std::int64_t* calls;

  template <class Stencil>
  KOKKOS_FUNCTION Vec3<typename Stencil::value_type> field(Stencil const&) const {
    Kokkos::atomic_inc(calls);
    return zero<typename Stencil::value_type>();
  }
};

/// Returns the ratio of the evaluations in a swept step to those that the step needs.
template <class Stepper>
double repeated(Lattice const& lattice) {
  using Field = typename Stepper::spins_type;
  Field spins("spins", lattice);
  Kokkos::deep_copy(spins.allocation(), std::sqrt(typename Field::value_type(1) / 3));
  Stepper stepper(spins);
  stepper.use(Path::sweep);
  std::int64_t calls = 0;
  LandauLifshitz const generator(EffectiveField(Exchange(lattice, 1), CountedCalls{{}, &calls}),
                                 0.1);
  stepper.step(Threaded(), generator, spins, 0, 0.01);
  Threaded().fence();
  auto const layout = spins.layout();
  auto const packs = detail::pack_count<typename Field::value_type>(layout);
  return static_cast<double>(calls) /
         static_cast<double>(layout.rows() * packs * Stepper::evaluations);
}

template <class Stepper>
void expect_little_repeated() {
  for (auto const& [n, bound] : {std::pair(64, 1.1), std::pair(128, 1.05), std::pair(256, 1.05)}) {
    double const ratio = repeated<Stepper>(Lattice::cubic(n, n, n));
    EXPECT_GE(ratio, 1) << n;
    EXPECT_LE(ratio, bound) << n;
    std::printf("%d^3, %d stages, %d threads: %.3f of the evaluations needed\n", n,
                Stepper::evaluations, Threaded().concurrency(), ratio);
  }
}

TYPED_TEST(SweepStrips, RepeatLittleOfRkmk4) {
  expect_little_repeated<Rkmk4<typename TestFixture::Field>>();
}

TYPED_TEST(SweepStrips, RepeatLittleOfSevenStages) {
  expect_little_repeated<
      ProjectedRungeKutta<typename TestFixture::Field, tableau::Oscillatory74>>();
}

using Buffers4 = detail::StageBuffers<tableau::Classical4, update::Lie<Cayley>>;

template <class Real>
detail::SweepPlan plan_for(Lattice const& lattice, int threads) {
  return detail::SweepPlan::of<Real, Buffers4>(RowLayout::of<Real>(lattice), threads,
                                               std::size_t(1) << 19);
}

TYPED_TEST(SweepStrips, LeaveNoThreadWithoutARow) {
  for (int const n : {64, 128, 256})
    for (int const threads : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256}) {
      auto const plan = plan_for<TypeParam>(Lattice::cubic(n, n, n), threads);
      EXPECT_EQ(plan.tasks(), threads) << n;
    }
}

TYPED_TEST(SweepStrips, CutFewThreadsIntoPartsAlone) {
  EXPECT_EQ(plan_for<TypeParam>(Lattice::cubic(128, 128, 128), 2).strips, 1);
  EXPECT_EQ(plan_for<TypeParam>(Lattice::square(512, 512), 2).strips, 1);
  EXPECT_GT(plan_for<TypeParam>(Lattice::cubic(128, 128, 128), 64).strips, 1);
}

/// A term whose evaluation is slow at a few sites.
struct SlowRows : NoField {
  template <class Stencil>
  KOKKOS_FUNCTION Vec3<typename Stencil::value_type> field(Stencil const& stencil) const {
    auto const& site = stencil.site();
    if (site.x() == 0 && site.z() % 5 == 3 && site.y() % 11 == 7)
      std::this_thread::sleep_for(std::chrono::microseconds(100 * (1 + site.y() % 3)));
    return zero<typename Stencil::value_type>();
  }
};

TYPED_TEST(SweepStrips, WaitForLateNeighbours) {
  using Field = typename TestFixture::Field;
  for (auto const boundary : {Boundary::open, Boundary::periodic}) {
    Lattice const lattice{{130, 67, 23}, {1, 1, 1}, {boundary, boundary, boundary}};
    auto const start = random_spins<Field>(lattice, 5);
    auto const steps = [&](Path path, auto const& field) {
      auto spins = copy_of(start);
      Rkmk4<Field> stepper(spins);
      stepper.use(path);
      for (int n = 0; n < 2; ++n)
        stepper.step(Threaded(), LandauLifshitz(field, 0.1), spins, n * 0.1, 0.1);
      Threaded().fence();
      return copy_to_host(spins);
    };
    EffectiveField const field(Exchange(lattice, 1), Zeeman{{0.1, 0.2, 0.3}});
    auto const passed = steps(Path::pass, field);
    expect_equal_bits(passed,
                      steps(Path::sweep, EffectiveField(Exchange(lattice, 1),
                                                        Zeeman{{0.1, 0.2, 0.3}}, SlowRows{})),
                      name_of(lattice));
  }
}

}  // namespace
