// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A stepper's memory of earlier steps survives switches between sweeps and passes, also when
// another stepper continues from its checkpoint: results are bitwise identical to those of
// uninterrupted passes.
#include "sweeping.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/serialize.hpp>

#include <algorithm>
#include <cstdlib>
#include <random>

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Real>
using SweepRestarts = InHostMemory<Real>;
TYPED_TEST_SUITE(SweepRestarts, Precisions, PrecisionName);

constexpr std::int64_t steps = 9;
constexpr double dt = 0.1;

template <class Stepper>
Stepper made_like(typename Stepper::spins_type const& spins) {
  if constexpr (AdaptiveStepper<Stepper>)
    return Stepper(spins, StepOptions{.tolerance = 1e-3, .end = steps * dt});
  else
    return Stepper(spins);
}

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : engine_(seed) {}
  std::int64_t below(std::int64_t end) {
    return static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(end));
  }
  Path path() { return below(2) == 0 ? Path::sweep : Path::pass; }
  Lattice lattice() {
    auto const boundary = [&] { return below(2) == 0 ? Boundary::open : Boundary::periodic; };
    std::array<std::int64_t, 3> const shapes[] = {
        {41, 17, 9}, {130, 23, 1}, {9, 15, 14}, {67, 13, 3}};
    return {shapes[below(4)], {1, 0.9, 1.1}, {boundary(), boundary(), boundary()}};
  }

 private:
  std::mt19937_64 engine_;
};

/// Takes `change` steps under the first generator and the rest under the second. `cut`: step at
/// which a second stepper continues; -1: never. `paths`: those of the first and the second stepper.
template <class Stepper, class First, class Second>
auto end_of(First const& first, Second const& second, typename Stepper::spins_type const& start,
            std::int64_t change, std::int64_t cut, std::array<Path, 2> const& paths) {
  Threaded const exec;
  auto spins = copy_of(start);
  std::vector<Stepper> steppers;
  for (Path const path : paths) {
    steppers.push_back(made_like<Stepper>(start));
    steppers.back().use(path);
  }
  Stepper* stepper = &steppers[0];
  for (std::int64_t n = 0; n < steps; ++n) {
    if (n == cut) {
      CheckpointInMemory checkpoint;
      serialize(*stepper, checkpoint);
      checkpoint.close();
      stepper = &steppers[1];
      serialize(*stepper, checkpoint);
    }
    double const t = static_cast<double>(n) * dt;
    if (n < change)
      stepper->step(exec, first, spins, t, dt);
    else
      stepper->step(exec, second, spins, t, dt);
  }
  exec.fence();
  return copy_to_host(spins);
}

template <class Stepper>
void expect_bits_without_a_break(char const* name, std::int64_t runs) {
  using Field = typename Stepper::spins_type;
  for (std::int64_t number = 0; number < runs; ++number) {
    Draws draws(static_cast<std::uint64_t>(1000 + number));
    auto const lattice = draws.lattice();
    auto const by_time = turning(every_term(lattice));
    LandauLifshitz const nonlocal(EffectiveField(Exchange(lattice, 0.7), MeanField(0.8)), 0.1);
    auto const start = random_spins<Field>(lattice, static_cast<unsigned>(number));
    auto const change = draws.below(steps + 1), cut = 1 + draws.below(steps - 1);
    std::array const paths{draws.path(), draws.path()};
    auto const swept = [](Path path) { return path == Path::sweep ? "swept" : "passed"; };
    auto const where = std::string(name) + " " + name_of(lattice) + swept(paths[0]) +
                       ", nonlocal after " + std::to_string(change) + " steps, cut after " +
                       std::to_string(cut) + ", then " + swept(paths[1]);
    auto const right =
        end_of<Stepper>(by_time, nonlocal, start, change, -1, {Path::pass, Path::pass});
    expect_equal_bits(right, end_of<Stepper>(by_time, nonlocal, start, change, -1, paths), where);
    expect_equal_bits(right, end_of<Stepper>(by_time, nonlocal, start, change, cut, paths), where);
    if (::testing::Test::HasFailure()) return;
  }
}

TYPED_TEST(SweepRestarts, GiveTheBitsOfPassesWithoutABreak) {
  using Field = typename TestFixture::Field;
  char const* const asked = std::getenv("CAYSPIN_RANDOM_RESTARTS");
  std::int64_t const runs = asked ? std::atoll(asked) : 8;
  expect_bits_without_a_break<Compensated<Rkmk4<Field>>>("rkmk4, compensated", runs);
  expect_bits_without_a_break<Compensated<ProjectedRk4<Field>>>("projected, compensated", runs);
  expect_bits_without_a_break<AdaptiveRkmk<Field, tableau::BogackiShampine3>>("bs3", runs);
}

TYPED_TEST(SweepRestarts, KeepTheResidualWhereThePathIsChosen) {
  using Field = typename TestFixture::Field;
  using Stepper = Compensated<Rkmk4<Field>>;
  auto const lattice = Lattice::cubic(41, 17, 9);
  auto const generator = turning(every_term(lattice));
  auto const start = random_spins<Field>(lattice, 6);
  auto spins = copy_of(start), other = copy_of(start);
  Stepper changing(start), passing(start);
  passing.use(Path::pass);
  Threaded const exec;
  for (std::int64_t n = 0; n < 6; ++n) {
    changing.use(n % 2 == 0 ? Path::sweep : Path::pass);
    changing.step(exec, generator, spins, static_cast<double>(n) * dt, dt);
    passing.step(exec, generator, other, static_cast<double>(n) * dt, dt);
  }
  expect_equal_bits(copy_to_host(other), copy_to_host(spins), "changing");
  changing.reset();
  changing.step(exec, generator, spins, 0.6, dt);
  passing.step(exec, generator, other, 0.6, dt);
  EXPECT_NE(copy_to_host(other), copy_to_host(spins)) << "no residual to keep";
}

}  // namespace
