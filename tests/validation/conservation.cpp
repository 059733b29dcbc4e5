// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Drift of the energy and of the magnetization along a symmetry axis in undamped runs, and lengths
// of spins after a million steps.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

#include <numbers>

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr int sites = 32;
constexpr double end_time = 20;
std::vector<double> const dts{0.1, 0.05, 0.025, 0.0125};

Slab const asymmetric{.lattice = Lattice::chain(sites),
                      .exchange = 0.7,
                      .anisotropy = 0.6,
                      .demag = 1,
                      .applied = {0.3, 0.1, 0.4}};
Slab const axial{
    .lattice = Lattice::chain(sites), .exchange = 0.7, .anisotropy = 0.6, .applied = {0, 0, 0.4}};

Spins start() {
  return make_spins(Lattice::chain(sites), [](auto i, auto, auto) {
    double const x = (i + 0.5) / sites;
    return Vector{0.8 * std::cos(2 * x), std::sin(3 * x),
                  0.4 + 0.5 * std::cos(std::numbers::pi * x)};
  });
}

template <class Stepper, class Choose>
void expect_drifts(std::string const& method, Choose const& choose,
                   std::vector<std::string> const& energies,
                   std::vector<std::string> const& magnetizations) {
  Spins const from = start();
  Space const exec;
  for (std::size_t i = 0; i < dts.size(); ++i) {
    auto const steps = std::llround(end_time / dts[i]);
    auto const drift = [&](Slab const& slab) {
      return run<Stepper>(choose(slab), from, dts[i], steps);
    };
    std::string const name = method + ", dt " + std::to_string(dts[i]).substr(0, 6);
    auto const moved = drift(asymmetric);
    double const de = energy(exec, asymmetric.field(), moved).value -
                      energy(exec, asymmetric.field(), from).value;
    expect_figure(name + ", energy", std::abs(de) / sites, energies[i], 0.05);
    double const dm = magnetization(exec, drift(axial)).z - magnetization(exec, from).z;
    if (magnetizations.empty())
      expect_below(name + ", magnetization", std::abs(dm), 2e-16);
    else
      expect_figure(name + ", magnetization", std::abs(dm), magnetizations[i], 0.05);
  }
}

constexpr auto natural = [](Slab const& slab) { return slab.natural(); };
constexpr auto orthogonal = [](Slab const& slab) { return slab.orthogonal(); };

TEST(Conservation, GeometricEuler) {
  expect_drifts<LieEuler<Spins>>("geometric Euler", natural, {"1.2", ".22", ".10", "5.0e-2"},
                                 {".17", "9.9e-3", "4.8e-3", "2.4e-3"});
}

TEST(Conservation, BackwardDifferenceSigma) {
  expect_drifts<LieEuler<Spins, isotropy::FiniteDifferenceBackward>>(
      "geometric Euler, backward difference", natural, {"8.23e-3", "9.76e-4", "2.63e-4", "5.27e-5"},
      {"1.072e-2", "2.53e-3", "1.147e-3", "5.54e-4"});
}

TEST(Conservation, GeometricHeun) {
  expect_drifts<LieHeun<Spins>>("geometric Heun", natural, {"2.7e-3", "3.2e-4", "3.4e-5", "4.0e-6"},
                                {"1.2e-4", "2.7e-5", "6.2e-6", "1.5e-6"});
}

TEST(Conservation, Rkmk4) {
  expect_drifts<Rkmk4<Spins>>("rkmk4, default", natural, {"8.3e-6", "2.2e-7", "3.9e-9", "5.9e-11"},
                              {"3.2e-8", "1.7e-9", "9.5e-11", "5.7e-12"});
  expect_drifts<Rkmk4<Spins>>("rkmk4, orthogonal", orthogonal,
                              {"8.0e-6", "2.2e-7", "5.0e-9", "3.4e-11"},
                              {"6.0e-9", "7.3e-10", "8.0e-11", "6.1e-12"});
}

TEST(Conservation, ClassicalRk4) {
  expect_drifts<ClassicalRk4<Spins>>("classical rk4", natural,
                                     {"9.8e-6", "2.9e-7", "7.9e-9", "1.7e-10"}, {});
}

template <class Stepper>
void expect_unit_length(std::string const& method, double damping) {
  Slab slab = asymmetric;
  slab.damping = damping;
  auto const spins = run<Stepper>(slab.natural(), start(), 0.02, 1000000);
  auto const numbers = copy_to_host(spins);
  long double bias = 0, largest = 0;
  for (int i = 0; i < sites; ++i) {
    long double const x = numbers[3 * i], y = numbers[3 * i + 1], z = numbers[3 * i + 2];
    long double const excess = std::sqrt(x * x + y * y + z * z) - 1;
    bias += excess / sites;
    largest = larger(largest, std::abs(excess));
  }
  std::string const name = method + ", damping " + std::to_string(damping).substr(0, 4);
  expect_below(name + ", max ||m| - 1|", static_cast<double>(largest), 1e-12);
  expect_below(name + ", |mean (|m| - 1)|", static_cast<double>(std::abs(bias)), 1e-13);
}

TEST(Conservation, LengthAfterAMillionSteps) {
  for (double const damping : {0.0, 0.05}) {
    expect_unit_length<LieEuler<Spins>>("geometric Euler", damping);
    expect_unit_length<LieHeun<Spins>>("geometric Heun", damping);
    expect_unit_length<Rkmk4<Spins>>("rkmk4", damping);
  }
}

}  // namespace
