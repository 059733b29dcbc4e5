// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// On a device, PairedStages takes two stages in one pass. The results have the bits of the passes.
#include "../support/backends.hpp"
#include "../support/coefficients.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/stepper/paired_stages.hpp>

#include <cmath>
#include <cstdint>
#include <random>

namespace cayspin::test {
namespace {

Vec3<double> turning_field(double t) { return {0.7 * std::cos(9 * t), 0.7 * std::sin(9 * t), 0.9}; }

Lattice lattice_of(std::array<std::int64_t, 3> shape, std::array<Boundary, 3> ends) {
  return {shape, {1, 1, 1}, ends};
}

template <class Backend>
class Pairs : public ::testing::Test {
 protected:
  using Exec = typename Backend::Exec;
  using Field = typename Backend::Spins;
  Exec exec;

  Field after_steps(auto& stepper, auto const& generator, Lattice const& on, int steps) const {
    auto spins = spins_of<Field>(on, random_directions(on.sites(), 7));
    for (int step = 0; step < steps; ++step)
      stepper.step(exec, generator, spins, 0.25 + 0.05 * step, 0.05);
    exec.fence();
    return spins;
  }

  template <class Stepper>
  void expect_same(Lattice const& on, auto const& generator, bool in_pairs) const {
    Field const like("like", on);
    PairedStages<Stepper> stepper(like);
    Stepper plain(like);
    constexpr int steps = 2;
    auto const expected = numbers_of(after_steps(plain, generator, on, steps));
    EXPECT_EQ(numbers_of(after_steps(stepper, generator, on, steps)), expected);

    // Passes move spins in place, pairs do not.
    auto spins = spins_of<Field>(on, random_directions(on.sites(), 7));
    auto const* const before = spins.array().data;
    stepper.step(exec, generator, spins, 0.25, 0.05);
    if (!detail::is_host_execution<Exec>) {
      EXPECT_EQ(spins.array().data != before, in_pairs);
    }
  }

  void expect_same_of_each(Lattice const& on, auto const& generator, bool in_pairs) const {
    SCOPED_TRACE(::testing::PrintToString(on.shape));
    expect_same<LieHeun<Field>>(on, generator, in_pairs);
    expect_same<Rkmk4<Field>>(on, generator, in_pairs);
    expect_same<Compensated<Rkmk4<Field>>>(on, generator, in_pairs);
    expect_same<ProjectedRk4<Field>>(on, generator, in_pairs);
    expect_same<StereographicRungeKutta<Field, tableau::Heun>>(on, generator, in_pairs);
    expect_same<StereographicRungeKutta<Field, tableau::Classical4>>(on, generator, in_pairs);
  }

  static auto stationary_generator_on(Lattice const& on) {
    return LandauLifshitz(
        EffectiveField(Exchange(on, 0.8), BulkDmi(on, 0.4), ZhangLi(on, {0.5, -0.3, 0.2}, 0.3),
                       UniaxialAnisotropy(0.7, {1, 2, -2})),
        0.1);
  }
  static auto generator_on(Lattice const& on) {
    return LandauLifshitz(
        EffectiveField(Exchange(on, 0.8), BulkDmi(on, 0.4), ZhangLi(on, {0.5, -0.3, 0.2}, 0.3),
                       UniaxialAnisotropy(0.7, {1, 2, -2}), TimeDependentZeeman(turning_field)),
        0.1);
  }
};
TYPED_TEST_SUITE(Pairs, Backends, BackendName);

constexpr auto open = Boundary::open, periodic = Boundary::periodic;

TYPED_TEST(Pairs, HaveTheBitsOfPasses) {
  for (auto const& on : {lattice_of({30, 10, 1}, {open, open, open}),
                         lattice_of({30, 10, 2}, {periodic, periodic, periodic}),
                         lattice_of({61, 11, 9}, {periodic, open, periodic}),
                         lattice_of({33, 21, 35}, {open, periodic, open}),
                         lattice_of({31, 12, 3}, {periodic, periodic, periodic}).with_replicas(4),
                         lattice_of({40, 13, 1}, {open, periodic, periodic}).with_replicas(3)})
    this->expect_same_of_each(on, this->generator_on(on), true);
}

// Films of up to two planes, and chains, take all stages of a step in one launch.
TYPED_TEST(Pairs, OfSmallFilmsAndChainsHaveTheBitsOfPasses) {
  for (auto const& on :
       {lattice_of({64, 64, 1}, {periodic, periodic, open}),
        lattice_of({29, 9, 1}, {open, open, open}), lattice_of({21, 10, 2}, {open, periodic, open}),
        lattice_of({3, 2, 1}, {periodic, periodic, periodic}),
        lattice_of({1, 23, 2}, {periodic, open, periodic}),
        lattice_of({131, 1, 1}, {open, open, open}),
        lattice_of({59, 1, 8}, {periodic, open, periodic}),
        lattice_of({2, 1, 1}, {periodic, periodic, periodic}).with_replicas(5),
        lattice_of({15, 17, 2}, {periodic, open, periodic}).with_replicas(3)})
    this->expect_same_of_each(on, this->stationary_generator_on(on), true);
}

TYPED_TEST(Pairs, OfAnySmallFilmHaveTheBitsOfPasses) {
  std::mt19937 random(3);
  auto const up_to = [&](std::int64_t most) {
    return 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most));
  };
  auto const end = [&] { return up_to(2) == 1 ? open : periodic; };
  for (int film = 0; film < 12; ++film) {
    std::array const shape{up_to(80), up_to(40), up_to(2)};
    auto const on = lattice_of(shape, {end(), end(), end()}).with_replicas(up_to(3));
    this->expect_same_of_each(on, this->stationary_generator_on(on), true);
  }
}

// With one stage, pairs are steps, in batches.
TYPED_TEST(Pairs, OfStepsHaveTheBitsOfSteps) {
  using Spins = typename TypeParam::Spins;
  constexpr bool on_device = !detail::is_host_execution<typename TypeParam::Exec>;
  for (auto const& on : {lattice_of({61, 11, 9}, {periodic, open, periodic}),
                         lattice_of({33, 21, 17}, {open, periodic, open}),
                         lattice_of({31, 12, 12}, {periodic, periodic, periodic}).with_replicas(4)})
    for (int const steps : {4, 5}) {
      SCOPED_TRACE(::testing::PrintToString(on.shape) + ' ' + std::to_string(steps));
      LandauLifshitz const generator(
          EffectiveField(Exchange(on, 0.8), BulkDmi(on, 0.4), UniaxialAnisotropy(0.7, {1, 2, -2})),
          0.1);
      Spins const like("like", on);
      auto spins = spins_of<Spins>(on, random_directions(on.sites(), 7));
      LieEuler<Spins> plain(like);
      auto const expected = numbers_of(this->after_steps(plain, generator, on, steps));
      PairedStages<LieEuler<Spins>> stepper(like);
      if (on_device) {
        EXPECT_TRUE(stepper.takes_batches(this->exec, generator, spins));
        EXPECT_FALSE(plain.takes_batches(this->exec, generator, spins));
      }
      auto const* const before = spins.array().data;
      integrate(this->exec, stepper, generator, spins, {.begin = 0.25, .dt = 0.05, .steps = steps});
      EXPECT_EQ(numbers_of(spins), expected);
      EXPECT_EQ(spins.array().data, before);
    }
}

TYPED_TEST(Pairs, AreNotTakenOnNarrowLattices) {
  for (auto const& on : {lattice_of({29, 10, 3}, {open, open, open}),
                         lattice_of({30, 9, 3}, {periodic, periodic, periodic})})
    this->expect_same_of_each(on, this->generator_on(on), false);
}

TYPED_TEST(Pairs, HaveTheBitsOfPassesBesideVacancies) {
  using Spins = typename TypeParam::Spins;
  auto const on = lattice_of({37, 14, 11}, {open, periodic, open});
  auto const constants = numbers_on<Spins>(on, [](std::int64_t site) { return 0.1 * (site % 7); });
  auto const occupied =
      numbers_on<Spins>(on, [](std::int64_t site) { return site % 5 == 0 ? 0 : 1; });
  LandauLifshitz const generator(
      FieldWithVacancies(
          EffectiveField(Exchange(on, 0.8), InterfacialDmi(on, 0.3, {0, 0, 1}),
                         SiteDependentUniaxialAnisotropy(constants, Vec3<double>{0, 0.6, 0.8})),
          occupied),
      0.1);
  this->expect_same_of_each(on, generator, true);
}

}  // namespace
}  // namespace cayspin::test
