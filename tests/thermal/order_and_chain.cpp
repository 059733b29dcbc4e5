// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The Heisenberg chain in thermal equilibrium, compared with Fisher's solution (Am. J. Phys. 32,
// 343, 1964), and the error of its energy due to the step length, which is of second order. Seeds
// are fixed; statistical limits are five standard errors.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/observer/thermal_noise.hpp>

#include <cmath>

namespace cayspin::test {
namespace {

constexpr double temperature = 0.5, damping = 0.5;  // J = 1

/// Returns <m_i . m_(i+1)>.
double fisher() { return 1 / std::tanh(1 / temperature) - temperature; }

/// Runs a periodic chain from random spins, and calls look(energy per site, spins) every 1.6 from t
/// = 20 on.
template <class Spins, class Look>
void run_chain(std::int64_t sites, double dt, double end, Look const& look) {
  auto const lattice = Lattice::chain(sites, 1, Boundary::periodic);
  auto spins = spins_of<Spins>(lattice, random_directions(sites, 5));
  EffectiveField const field(Exchange(lattice, 1));
  ThermalNoise<Spins> const noise(spins, damping, {.temperature = temperature, .seed = 7});
  Rkmk4<Spins> stepper(spins);
  Times const times{0, dt, std::llround(end / dt)};
  auto const every = std::llround(1.6 / dt);
  auto const looking = [&](auto const& exec, Step const& step, Spins const& now) {
    if (step.time >= 20 && step.number % every == 0)
      look(energy(exec, field, now).value / static_cast<double>(sites), now);
  };
  typename Spins::memory_space::execution_space const exec;
  integrate(exec, stepper, LandauLifshitz(field, damping), spins, times, noise.after_steps(times),
            looking, noise.before_steps());
}

template <class Real>
class ThermalChain : public ::testing::Test {};
TYPED_TEST_SUITE(ThermalChain, Precisions, PrecisionName);

TYPED_TEST(ThermalChain, FollowsFisher) {
  using Spins = SpinField<TypeParam>;
  constexpr std::int64_t sites = 1 << 16;
  std::vector<double> m;
  double last_energy = 0;
  run_chain<Spins>(sites, 0.025, 40, [&](double energy_of_site, Spins const& spins) {
    last_energy = energy_of_site;
    m = numbers_of(spins);
  });
  double const neighbors = fisher(), square = 1 - 2 * neighbors * temperature;
  // Bonds are independent. The step length adds 1e-4 to the energy.
  double const error = std::sqrt((square - neighbors * neighbors) / sites);
  EXPECT_NEAR(last_energy, 1 - neighbors, 5 * error + 2e-4);
  for (int distance = 1; distance <= 4; ++distance) {
    double sum = 0;
    for (std::int64_t i = 0; i < sites; ++i)
      for (int c = 0; c < 3; ++c)
        sum += m[static_cast<std::size_t>(3 * i + c)] *
               m[static_cast<std::size_t>(3 * ((i + distance) % sites) + c)];
    // A pair is correlated with the 2 * distance - 1 pairs with which it shares bonds, itself
    // included.
    double const limit = 5 * std::sqrt((2 * distance - 1.0) / sites) / std::sqrt(3) + 5e-4;
    EXPECT_NEAR(sum / sites, std::pow(neighbors, distance), limit) << distance;
  }
}

TEST(ThermalOrder, StepsAddAnErrorOfSecondOrderToTheEnergy) {
  using Spins = SpinField<double>;
  std::vector<double> bias;
  for (double const dt : {0.4, 0.2, 0.1}) {
    double sum = 0;
    int looks = 0;
    run_chain<Spins>(1 << 16, dt, 180, [&](double energy_of_site, Spins const&) {
      sum += energy_of_site;
      ++looks;
    });
    bias.push_back(sum / looks - (1 - fisher()));
  }
  for (std::size_t i = 0; i + 1 < bias.size(); ++i) {
    double const order = std::log2(bias[i] / bias[i + 1]);
    EXPECT_GT(order, 1.7) << bias[i] << " and " << bias[i + 1];
    EXPECT_LT(order, 2.5) << bias[i] << " and " << bias[i + 1];
  }
}

}  // namespace
}  // namespace cayspin::test
