// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Thermal noise: diffusion on the sphere, Langevin's function, Boltzmann's law of single spins, and
// results that do not depend, bit by bit, on the host space or on interruptions. Seeds are fixed;
// statistical limits are five standard errors.
#include "../support/backends.hpp"
#include "../support/larger.hpp"
#include "kept_of_direction.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/crystal.hpp>
#include <cayspin/observer/thermal_noise.hpp>

#include <array>
#include <cmath>

namespace cayspin::test {
namespace {

template <class Backend>
class Thermal : public ::testing::Test {
 protected:
  using Spins = typename Backend::Spins;
  using Noise = ThermalNoise<Spins>;
  using Half = typename Noise::Half;
  typename Backend::Exec exec;

  /// Returns uncoupled spins in thermal equilibrium in a field, after `steps` steps from +z.
  template <class Field>
  Spins at_rest(Field const& field, double temperature, double dt, int steps) {
    Spins spins("spins", Lattice::square(256, 64));
    double const damping = 1;
    LandauLifshitz const generator(field, damping);
    Noise const noise(spins, damping, {.temperature = temperature, .seed = 11});
    LieHeun<Spins> stepper(spins);
    Times const times{0, dt, steps};
    integrate(exec, stepper, generator, spins, times, noise.after_steps(times),
              noise.before_steps());
    return spins;
  }
};
TYPED_TEST_SUITE(Thermal, Backends, BackendName);

TYPED_TEST(Thermal, DirectionsAreForgottenAtTheRateOfDiffusion) {
  using Spins = typename TypeParam::Spins;
  using Half = typename TestFixture::Half;
  auto const lattice = Lattice::cubic(61, 61, 61);
  auto const start = random_directions(lattice.sites(), 3);
  auto const spins = spins_of<Spins>(lattice, start);
  ThermalNoise<Spins> const noise(spins, 0.5, {.temperature = 0.4, .seed = 5});
  double const dt = 4, u = 0.5 * 0.4 * dt;  // large enough for u^2/12 to show
  for (auto const half : {Half::before, Half::after}) noise.turn(this->exec, 1, half, dt, spins);
  this->exec.fence();
  auto const now = numbers_of(spins);
  auto const sites = static_cast<double>(lattice.sites());
  std::array<double, 3> mean{};  // of 3 * m_c * m_0c for each component c
  double largest_defect = 0;
  for (std::size_t i = 0; i < now.size(); i += 3) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      mean[c] += 3 * now[i + c] * start[i + c] / sites;
      square += now[i + c] * now[i + c];
    }
    largest_defect = larger(largest_defect, std::abs(square - 1));
  }
  // <3 * m_c * m_0c> is equal for all components c. The variance of 3 * m_c * m_0c is at most
  // 9 * <(m_c * m_0c)^2> <= 9/5.
  double const kept = std::pow(kept_of_direction(u), 2);
  for (double const of_component : mean)
    EXPECT_NEAR(of_component, kept, 5 * std::sqrt(1.8 / sites));
  EXPECT_LT(largest_defect, 8 * epsilon<typename TypeParam::Real>);
}

// With x = field / temperature, <m_z> = coth(x) - 1 / x and <m_z^2> = 1 - 2 * <m_z> / x.
TYPED_TEST(Thermal, SpinsInAFieldFollowLangevin) {
  double const temperature = 0.5, field = 1, x = field / temperature;
  double const langevin = 1 / std::tanh(x) - 1 / x, square = 1 - 2 * langevin / x;
  auto const spins = this->at_rest(EffectiveField(Zeeman{{0, 0, field}}), temperature, 0.05, 300);
  auto const m = magnetization(this->exec, spins);
  double const error =
      std::sqrt((square - langevin * langevin) / static_cast<double>(spins.sites()));
  EXPECT_NEAR(m.z, langevin, 5 * error + 5e-4);  // includes the bias of dt = 0.05
  EXPECT_NEAR(m.x, 0, 5 * std::sqrt((1 - square) / 2 / static_cast<double>(spins.sites())));
}

// E is linear in m_z^2. Simpson's rule with Boltzmann's weights gives the expected <m_z^2>.
TYPED_TEST(Thermal, AUniaxialSpinFollowsBoltzmann) {
  using Spins = typename TypeParam::Spins;
  double const temperature = 0.4, constant = 1;
  UniaxialAnisotropy const term(constant, {0, 0, 1});
  auto const energy_of = [&](double z) {
    auto const one = spins_of<Spins>(Lattice::chain(1), {std::sqrt(1 - z * z), 0, z});
    return energy(this->exec, EffectiveField(term), one).value;
  };
  double const slope = (energy_of(1) - energy_of(0)) / temperature;  // with respect to z^2
  double weights = 0, squares = 0, fourths = 0;
  constexpr int intervals = 200;
  for (int i = 0; i <= intervals; ++i) {
    double const z = static_cast<double>(i) / intervals;
    double const simpson = i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2;
    double const weight = simpson * std::exp(-slope * z * z);
    weights += weight;
    squares += weight * z * z;
    fourths += weight * z * z * z * z;
  }
  double const expected = squares / weights;
  auto const spins = this->at_rest(EffectiveField(term), temperature, 0.05, 300);
  double found = 0;
  auto const numbers = numbers_of(spins);
  for (std::size_t i = 2; i < numbers.size(); i += 3) found += numbers[i] * numbers[i];
  auto const sites = static_cast<double>(spins.sites());
  double const error = std::sqrt((fourths / weights - expected * expected) / sites);
  EXPECT_NEAR(found / sites, expected, 5 * error + 5e-4);
}

// E = -(m_x^2 + 2 * m_z^2) / 2 has a hard, a medium and an easy axis. The midpoint rule over the
// sphere gives the expected <m_x^2> and <m_z^2>.
TYPED_TEST(Thermal, ABiaxialSpinFollowsBoltzmann) {
  double const temperature = 0.4;
  EffectiveField const field(UniaxialAnisotropy(1, {1, 0, 0}), UniaxialAnisotropy(2, {0, 0, 1}));
  std::array<double, 2> expected{}, fourths{};
  double weights = 0;
  constexpr int cells = 400;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      double const z = (i + 0.5) / cells, angle = std::acos(-1) / 2 * (j + 0.5) / cells;
      double const x = std::sqrt(1 - z * z) * std::cos(angle);
      double const weight = std::exp((x * x / 2 + z * z) / temperature);
      weights += weight;
      for (auto const& [axis, value] : {std::pair{0U, x}, std::pair{1U, z}}) {
        expected[axis] += weight * value * value;
        fourths[axis] += weight * std::pow(value, 4);
      }
    }
  auto const numbers = numbers_of(this->at_rest(field, temperature, 0.05, 300));
  auto const sites = static_cast<double>(numbers.size() / 3);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double found = 0;
    for (std::size_t i = 2 * axis; i < numbers.size(); i += 3)
      found += numbers[i] * numbers[i] / sites;
    double const mean = expected[axis] / weights;
    EXPECT_NEAR(found, mean, 5 * std::sqrt((fourths[axis] / weights - mean * mean) / sites) + 1e-3)
        << axis;
  }
}

// The round-off of a turn repeats in each step. Without a correction, lengths would change by 400
// epsilon in 1e5 turns.
TYPED_TEST(Thermal, LengthsDoNotDrift) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::chain(40);
  auto spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 3));
  LandauLifshitz const generator(EffectiveField(Exchange(lattice, 1)), 0.5);
  ThermalNoise<Spins> const noise(spins, 0.5, {.temperature = 0.5, .seed = 2});
  LieEuler<Spins> stepper(spins);
  Times const times{0, 0.02, 100000};
  integrate(this->exec, stepper, generator, spins, times, noise.between_steps(times));
  EXPECT_LT(norm_defect(this->exec, spins), 8 * epsilon<typename TypeParam::Real>);
}

// Noise depends on the number of the step and not on earlier steps, so a run in pieces is bitwise
// identical to an uncut run.
TYPED_TEST(Thermal, BitsDoNotDependOnWhereARunIsCut) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::cubic(21, 6, 5);
  auto const start = random_directions(lattice.sites(), 3);
  auto const run = [&](std::initializer_list<std::array<int, 2>> const& pieces, std::uint64_t seed,
                       bool at_once = false) {
    auto spins = spins_of<Spins>(lattice, start);
    LandauLifshitz const generator(EffectiveField(Exchange(lattice, 1)), 0.3);
    ThermalNoise<Spins> const noise(spins, 0.3, {.temperature = 0.2, .seed = seed});
    Rkmk4<Spins> stepper(spins);
    for (auto const& [first, last] : pieces) {
      Times const times{0, 0.05, last, first};
      if (at_once)
        integrate(this->exec, stepper, generator, spins, times, noise.between_steps(times));
      else
        integrate(this->exec, stepper, generator, spins, times, noise.after_steps(times),
                  noise.before_steps());
    }
    return numbers_of(spins);
  };
  auto const whole = run({{0, 12}}, 9);
  EXPECT_EQ(run({{0, 5}, {5, 12}}, 9), whole);
  EXPECT_EQ(run({{0, 12}}, 9, true), whole);
  EXPECT_EQ(run({{0, 5}, {5, 5}, {5, 12}}, 9, true), whole);
  EXPECT_NE(run({{0, 12}}, 10), whole);
  EXPECT_NE(run({{0, 12}}, 9 + (1ULL << 40U)), whole);
}

#if defined(KOKKOS_ENABLE_SERIAL)
TEST(ThermalBits, AreThoseOfEveryHostSpace) {
  auto const run = [](auto const& exec) {
    using Spins = SpinField<double, Kokkos::HostSpace>;
    auto const lattice = Lattice::square(131, 77);
    auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 3));
    ThermalNoise<Spins> const noise(spins, 1, {.temperature = 0.2, .seed = 1});
    noise.turn(exec, 7, ThermalNoise<Spins>::Half::after, 0.1, spins);
    exec.fence();
    return numbers_of(spins);
  };
  EXPECT_EQ(run(Kokkos::Serial()), run(Kokkos::DefaultHostExecutionSpace()));
}
#endif

// A run that an observer stops, and that is continued, equals one that is not interrupted.
TYPED_TEST(Thermal, BitsDoNotDependOnWhereARunIsStopped) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::square(21, 6);
  auto const run = [&](std::int64_t stop, bool at_once) {
    auto spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 3));
    LandauLifshitz const generator(EffectiveField(Exchange(lattice, 1)), 0.3);
    ThermalNoise<Spins> const noise(spins, 0.3, {.temperature = 0.2, .seed = 9});
    Rkmk4<Spins> stepper(spins);
    auto const stop_at = [&](auto const&, Step const& step, auto const&) {
      return step.number == stop ? Next::stop : Next::proceed;
    };
    for (std::int64_t const first : {std::int64_t{0}, stop}) {
      Times const times{0, 0.05, 12, first};
      auto const watch = [&, first](auto const& exec, Step const& step, auto const& seen) {
        return step.number > first || first == 0 ? stop_at(exec, step, seen) : Next::proceed;
      };
      if (at_once)
        integrate(this->exec, stepper, generator, spins, times, watch, noise.between_steps(times));
      else
        integrate(this->exec, stepper, generator, spins, times, noise.after_steps(times), watch,
                  noise.before_steps());
    }
    return numbers_of(spins);
  };
  auto const whole = run(12, false);
  for (std::int64_t const stop : {1, 5, 11})
    for (bool const at_once : {false, true}) EXPECT_EQ(run(stop, at_once), whole) << stop;
}

// A copy keeps its own turns, which depend on the step length. It may take steps of another length.
TYPED_TEST(Thermal, CopiesTakeStepsOfOtherLengths) {
  using Spins = typename TypeParam::Spins;
  using Noise = typename TestFixture::Noise;
  auto const lattice = Crystal::bcc().lattice({5, 3, 2});
  Spins const like("like", lattice);
  Noise const noise(like, 0.5, {.temperature = 0.4, .seed = 3, .cell_sites = {1, 0.5}});
  Noise const copy = noise;
  auto const turned = [&](Noise const& by, double dt) {
    auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 3));
    by.turn(this->exec, 1, TestFixture::Half::after, dt, spins);
    this->exec.fence();
    return numbers_of(spins);
  };
  auto const expected = turned(noise, 0.1);
  EXPECT_NE(turned(copy, 0.2), expected);
  EXPECT_EQ(turned(noise, 0.1), expected);
  EXPECT_EQ(turned(copy, 0.1), expected);
  // Copies of noise with a field of mobile sites also keep their own turns, and so does noise that
  // was assigned to.
  ScalarField<typename TypeParam::Real, typename TypeParam::MemorySpace> const moves("moves",
                                                                                     lattice, 1);
  Noise const moving(like, 0.5, {.temperature = 0.4, .seed = 3}, moves);
  auto assigned = moving;
  auto const of_all = turned(moving, 0.1);
  EXPECT_NE(turned(assigned, 0.2), of_all);
  EXPECT_EQ(turned(moving, 0.1), of_all);
  assigned = noise;
  EXPECT_EQ(turned(assigned, 0.1), expected);
}

// A site without a spin does not turn, and does not count in the bound on dt.
TYPED_TEST(Thermal, ASiteWithoutASpinHasNoNoise) {
  using Spins = typename TypeParam::Spins;
  using Noise = typename TestFixture::Noise;
  using Half = typename TestFixture::Half;
  auto const lattice = Crystal::bcc().lattice({5, 3, 2});
  auto start = random_directions(lattice.sites(), 3);
  for (std::size_t i = 0; i < start.size(); ++i)
    if (i / 45 % 2 == 1) start[i] = 0;
  auto const spins = spins_of<Spins>(lattice, start), others = spins_of<Spins>(lattice, start);
  Noise const noise(spins, 0.5, {.temperature = 8, .seed = 3, .cell_sites = {0.2, 0}});
  Noise const as_others(spins, 0.5, {.temperature = 8, .seed = 3, .cell_sites = {0.2, 0.2}});
  for (auto const half : {Half::after, Half::before}) {
    noise.turn(this->exec, 1, half, 1.2, spins);
    as_others.turn(this->exec, 1, half, 1.2, others);
  }
  this->exec.fence();
  auto const turned = numbers_of(spins);
  EXPECT_EQ(turned, numbers_of(others));
  for (std::size_t i = 0; i < start.size(); ++i) EXPECT_EQ(turned[i] == 0, i / 45 % 2 == 1) << i;
  EXPECT_THROW(noise.turn(this->exec, 2, Half::before, 1.3, spins), std::invalid_argument);
}

TEST(ThermalNoiseUses, AreRefusedInOneSentence) {
  using Spins = SpinField<double, Kokkos::HostSpace>;
  Spins const spins("spins", Lattice::chain(4)), others("others", Lattice::chain(5));
  for (double const wrong : {-1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(ThermalNoise<Spins>(spins, wrong, {}), std::invalid_argument);
    EXPECT_THROW(ThermalNoise<Spins>(spins, 1, {.temperature = wrong}), std::invalid_argument);
    EXPECT_THROW(ThermalNoise<Spins>(spins, 1, {.cell_sites = {wrong}}), std::invalid_argument);
  }
  Kokkos::DefaultHostExecutionSpace const exec;
  using Half = ThermalNoise<Spins>::Half;
  ThermalNoise<Spins> const noise(spins, 0.5, {.temperature = 2});
  EXPECT_THROW(noise.turn(exec, 1, Half::before, 1.1, spins), std::invalid_argument);
  EXPECT_THROW(noise.turn(exec, 1, Half::before, std::nan(""), spins), std::invalid_argument);
  EXPECT_THROW(noise.turn(exec, 1, Half::before, 0.1, others), std::invalid_argument);
  // The bound on dt is set by the site of the cell whose spin turns most.
  ThermalNoise<Spins> const slow(spins, 0.5, {.temperature = 2, .cell_sites = {0.5}});
  EXPECT_THROW(slow.turn(exec, 1, Half::before, 2.1, spins), std::invalid_argument);
  EXPECT_NO_THROW(slow.turn(exec, 1, Half::before, 1.9, spins));
  auto const before = numbers_of(spins);
  ThermalNoise<Spins>(spins, 0.5, {}).turn(exec, 1, Half::before, 0.1, spins);
  EXPECT_EQ(numbers_of(spins), before) << "at temperature 0";
}

}  // namespace
}  // namespace cayspin::test
