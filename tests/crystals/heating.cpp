// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The Heisenberg model with J = 1 on a body-centred crystal: its energy at a high temperature, and
// its critical temperature, 1 / 0.486798 (K. Chen, A. Ferrenberg and D. Landau, Phys. Rev. B 48,
// 3249, 1993), where the Binder cumulants of two sizes cross. Seeds are fixed.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/crystal.hpp>
#include <cayspin/field/pair_couplings.hpp>
#include <cayspin/observer/thermal_noise.hpp>
#include <cayspin/shells.hpp>

#include <array>
#include <cmath>
#include <cstdio>

namespace cayspin::test {
namespace {

/// Uncoupled crystals of extent^3 cells on one lattice: sites 2 * c and 2 * c + 1 of a cell belong
/// to crystal c.
template <class Spins>
class Crystals {
 public:
  static constexpr std::size_t count = 32;

  explicit Crystals(std::int64_t extent) : lattice_(lattice(extent)), field_(field(lattice_)) {}

  double sites_of_each() const { return static_cast<double>(lattice_.sites()) / count; }

  struct Run {
    double temperature, dt;
    std::int64_t steps_per_look, settling, looks;
    std::uint64_t seed;
  };
  /// Calls look(crystal, energy, sum of spins) for each crystal, `looks` times with steps_per_look
  /// steps in between; before that, `settling` such intervals are for equilibration.
  template <class Exec, class Look>
  void heat(Exec const& exec, Run const& run, Look const& look) const {
    double const damping = 1;
    auto spins = spins_of<Spins>(lattice_, random_directions(lattice_.sites(), 5));
    Spins const field_at("field", lattice_);
    ThermalNoise<Spins> const noise(spins, damping,
                                    {.temperature = run.temperature, .seed = run.seed});
    LieHeun stepper(spins);
    LandauLifshitz const generator(field_, damping);
    auto const plane = static_cast<std::size_t>(lattice_.shape[0] * lattice_.shape[1]);
    for (std::int64_t n = 0; n < run.settling + run.looks; ++n) {
      std::int64_t const first = n * run.steps_per_look;
      Times const times{0, run.dt, first + run.steps_per_look, first};
      integrate(exec, stepper, generator, spins, times, noise.between_steps(times));
      if (n < run.settling) continue;
      evaluate_field(exec, field_, spins, 0, field_at);
      auto const m = copy_to_host(spins), h = copy_to_host(field_at);
      std::array<double, count> energies{};
      std::array<Vec3<double>, count> sums{};
      for (std::size_t site = 0; site < m.size() / 3; ++site) {
        std::size_t const crystal = site / plane / 2 % count;
        Vec3<double> const here{m[3 * site], m[3 * site + 1], m[3 * site + 2]};
        energies[crystal] -=
            0.5 * dot(here, Vec3<double>{h[3 * site], h[3 * site + 1], h[3 * site + 2]});
        sums[crystal] = sums[crystal] + here;
      }
      for (std::size_t crystal = 0; crystal < count; ++crystal)
        look(crystal, energies[crystal], sums[crystal]);
    }
  }

 private:
  using Couplings = PairCouplings<typename Spins::memory_space>;

  static Lattice lattice(std::int64_t extent) {
    Crystal all{Crystal::bcc().cell, {}};
    for (std::size_t crystal = 0; crystal < count; ++crystal)
      for (auto const& site : Crystal::bcc().basis) all.basis.push_back(site);
    return all.lattice({extent, extent, extent},
                       {Boundary::periodic, Boundary::periodic, Boundary::periodic});
  }
  static EffectiveField<Couplings> field(Lattice const& lattice) {
    std::vector<Coupling> all;
    for (int crystal = 0; crystal < static_cast<int>(count); ++crystal)
      for (auto coupling : couplings_of_shells(Crystal::bcc(), {1})) {
        for (int& site : coupling.between) site += 2 * crystal;
        all.push_back(coupling);
      }
    return EffectiveField<Couplings>(Couplings(lattice, all));
  }

  Lattice lattice_;
  EffectiveField<Couplings> field_;
};

template <class Backend>
class HeatedCrystal : public ::testing::Test {};
TYPED_TEST_SUITE(HeatedCrystal, Backends, BackendName);

// The high-temperature series in K = 1 / T: each path of n bonds between the two ends of a bond
// adds about (coth K - 1 / K)^n to the mean of m.m' on this bond, which is minus its energy. There
// is one path of one bond, the bond itself; there are 12 of 3 bonds, and 222 of 5. Corrections
// start at K^5 and are far below the statistical error.
TYPED_TEST(HeatedCrystal, HasTheEnergyOfTheHighTemperatureSeries) {
  Crystals<typename TypeParam::Spins> const crystals(16);
  double const temperature = 8, of_bond = 1 / std::tanh(1 / temperature) - temperature;
  double const expected = of_bond + 12 * std::pow(of_bond, 3) + 222 * std::pow(of_bond, 5);
  constexpr std::int64_t looks = 25;
  std::array<double, crystals.count> of_each{};
  crystals.heat(typename TypeParam::Exec(), {temperature, 0.005, 8, 6, looks, 11},
                [&](std::size_t crystal, double energy, Vec3<double> const&) {
                  of_each[crystal] -= energy / (4 * crystals.sites_of_each() * looks);
                });
  double mean = 0, variance = 0;
  for (double const one : of_each) mean += one / crystals.count;
  for (double const one : of_each)
    variance += std::pow(one - mean, 2) / (crystals.count * (crystals.count - 1));
  double const error = std::sqrt(variance);
  std::printf("    %.6f +- %.6f, series %.6f\n", mean, error, expected);
  EXPECT_LT(error, 0.005 * expected);
  EXPECT_NEAR(mean, expected, 4 * error);
}

/// Binder's cumulant at both ends of a temperature range, from sums for each crystal that are
/// reweighted from the temperature in the middle.
class Cumulants {
 public:
  static constexpr double width = 0.02;
  using Ends = std::array<double, 2>;

  template <class Real>
  static Cumulants found(std::int64_t extent, double temperature, double dt,
                         std::int64_t steps_per_look, std::int64_t looks, std::uint64_t seed) {
    using Spins = SpinField<Real, Kokkos::HostSpace>;
    Crystals<Spins> const crystals(extent);
    Cumulants made;
    made.sums_.resize(crystals.count);
    double const sites = crystals.sites_of_each();
    crystals.heat(Kokkos::DefaultHostExecutionSpace(),
                  {temperature, dt, steps_per_look, 120, looks, seed},
                  [&](std::size_t crystal, double energy, Vec3<double> const& sum) {
                    double const square = dot(sum, sum) / (sites * sites);
                    for (std::size_t end = 0; end < 2; ++end) {
                      double const there = temperature + (end == 0 ? -width : width) / 2;
                      double const weight = std::exp(energy / temperature - energy / there);
                      auto& sums = made.sums_[crystal][end];
                      sums[0] += weight;
                      sums[1] += weight * square;
                      sums[2] += weight * square * square;
                    }
                  });
    return made;
  }

  std::size_t crystals() const { return sums_.size(); }

  /// Returns the cumulants without the crystal number `left_out`; if there is no such crystal,
  /// those of all crystals.
  Ends without(std::size_t left_out) const {
    Ends ends{};
    for (std::size_t end = 0; end < 2; ++end) {
      double all[3] = {};
      for (std::size_t crystal = 0; crystal < sums_.size(); ++crystal)
        for (std::size_t i = 0; i < 3; ++i)
          if (crystal != left_out) all[i] += sums_[crystal][end][i];
      ends[end] = 1 - all[2] * all[0] / (3 * all[1] * all[1]);
    }
    return ends;
  }

 private:
  std::vector<std::array<std::array<double, 3>, 2>> sums_;
};

/// Returns the temperature at which the cumulants of 8^3 and 16^3 cells cross, and its standard
/// error.
std::pair<double, double> crossing(double temperature, double dt, std::int64_t steps_per_look,
                                   std::int64_t looks, std::uint64_t seed) {
  // Rows of 8 doubles and of 16 floats consist of whole packs, which is fastest.
  auto const small = Cumulants::found<double>(8, temperature, dt, steps_per_look, looks, seed);
  auto const large = Cumulants::found<float>(16, temperature, dt, steps_per_look, looks, seed + 1);
  auto const at = [&](std::size_t of_small, std::size_t of_large) {
    auto const a = small.without(of_small), b = large.without(of_large);
    double const low = b[0] - a[0], high = b[1] - a[1];
    return temperature + Cumulants::width * (low / (low - high) - 0.5);
  };
  std::size_t const none = small.crystals();
  double const all = at(none, none);
  double variance = 0;
  for (std::size_t crystal = 0; crystal < none; ++crystal)
    variance += (std::pow(at(crystal, none) - all, 2) + std::pow(at(none, crystal) - all, 2)) *
                static_cast<double>(none - 1) / static_cast<double>(none);
  for (std::size_t end = 0; end < 2; ++end)
    std::printf("    dt = %.2f, T = %.3f: U = %.4f and %.4f\n", dt,
                temperature + (end == 0 ? -0.5 : 0.5) * Cumulants::width, small.without(none)[end],
                large.without(none)[end]);
  std::printf("    crossing at T = %.4f +- %.4f\n", all, std::sqrt(variance));
  std::fflush(stdout);
  return {all, std::sqrt(variance)};
}

// Run by ctest -C long -L long. The error of the steps heats the crystal in proportion to dt^2,
// which lowers the crossing by about 22 * dt^2.
TEST(HeisenbergCrystal, DISABLED_BinderCumulantsCrossAtTheCriticalTemperature) {
  auto const [fine, its_error] = crossing(2.036, 0.03, 40, 2000, 100);
  auto const [coarse, error_of_coarse] = crossing(1.979, 0.06, 20, 600, 200);
  double const found = (4 * fine - coarse) / 3;
  double const error = std::hypot(4 * its_error, error_of_coarse) / 3;
  std::printf("    without steps at T = %.4f +- %.4f\n", found, error);
  EXPECT_LT(error, 0.0025);
  EXPECT_NEAR(found, 1 / 0.486798, 0.006);
}

}  // namespace
}  // namespace cayspin::test
