// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Standing spin waves about a uniform state, whose frequencies on the lattice are known exactly.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <numbers>

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double pi = std::numbers::pi, amplitude = 1e-4;

struct Wave {
  char const* name;
  Lattice lattice;
  std::array<int, 3> mode;
  double demag, frequency;
  std::array<char const*, 3> errors;  // at 50, 100 and 200 steps per period
};

Lattice const chain = Lattice::chain(16, 0.5);
Lattice const block{{6, 5, 4}, {0.5, 0.7, 1}, {Boundary::open, Boundary::open, Boundary::open}};
Wave const waves[] = {
    {"chain", chain, {3, 0, 0}, 0, 2.443770171106, {"3.4e-7", "2.2e-8", "1.9e-9"}},
    {"chain with demag", chain, {3, 0, 0}, 1, 2.900996866646, {"4.6e-7", "3.0e-8", "3.0e-9"}},
    {"block", block, {2, 1, 3}, 0, 7.235615224018, {"1.2e-6", "7.6e-8", "5.4e-9"}},
    {"block with demag", block, {2, 1, 3}, 1, 7.719439286248, {"1.2e-6", "7.9e-8", "5.7e-9"}},
};

Slab slab_of(Wave const& wave) {
  return {.lattice = wave.lattice,
          .exchange = 0.7,
          .anisotropy = 0.6,
          .demag = wave.demag,
          .applied = {0, 0, 0.9}};
}

double stiffness(Wave const& wave) {
  double s = 0.9 + 0.6;
  for (int a = 0; a < 3; ++a)
    s += 4 * 0.7 / std::pow(wave.lattice.spacing[a], 2) *
         std::pow(std::sin(pi * wave.mode[a] / (2.0 * wave.lattice.shape[a])), 2);
  return s;
}

double shape(Wave const& wave, std::array<std::int64_t, 3> const& site) {
  double v = 1;
  for (int a = 0; a < 3; ++a)
    v *= std::cos(pi * wave.mode[a] * (site[a] + 0.5) / wave.lattice.shape[a]);
  return v;
}

/// Returns the relative error of the frequency, found from the phase after about 10.25 periods.
double frequency_error(Wave const& wave, int steps_per_period) {
  double const s = stiffness(wave), omega = std::sqrt(s * (s + wave.demag));
  double const dt = 2 * pi / omega / steps_per_period;
  auto const steps = static_cast<std::int64_t>(10.25 * steps_per_period);
  auto const start = make_spins(wave.lattice, [&](auto i, auto j, auto k) {
    return Vector{amplitude * shape(wave, {i, j, k}), 0, 1};
  });
  auto const numbers = copy_to_host(run<Rkmk4<Spins>>(slab_of(wave).natural(), start, dt, steps));

  double cosine = 0, sine = 0;
  auto const& n = wave.lattice.shape;
  for (std::int64_t site = 0; site < start.sites(); ++site) {
    double const v = shape(wave, {site % n[0], site / n[0] % n[1], site / (n[0] * n[1])});
    cosine += v * numbers[3 * site];
    sine += v * numbers[3 * site + 1] / std::sqrt((s + wave.demag) / s);
  }
  double const expected = omega * dt * static_cast<double>(steps);
  return std::remainder(std::atan2(sine, cosine) - expected, 2 * pi) / expected;
}

class SpinWave : public ::testing::TestWithParam<Wave> {};

TEST_P(SpinWave, Frequency) {
  Wave const& wave = GetParam();
  double const s = stiffness(wave);
  EXPECT_NEAR(std::sqrt(s * (s + wave.demag)), wave.frequency, 1e-12);

  std::array<int, 3> const steps{50, 100, 200};
  std::array<double, 3> errors;
  for (int i = 0; i < 3; ++i) {
    errors[i] = std::abs(frequency_error(wave, steps[i]));
    expect_figure(std::string(wave.name) + ", " + std::to_string(steps[i]) + " steps per period",
                  errors[i], wave.errors[i]);
  }
  expect_order("order from 50 to 100", std::log2(errors[0] / errors[1]), 4, 0.1);
  EXPECT_LT(errors[2], 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Lattices, SpinWave, ::testing::ValuesIn(waves), [](auto const& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

}  // namespace
