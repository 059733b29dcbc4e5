// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Chains and films side by side along x, too far apart for exchange: each column is bitwise
// identical to a separate run, also with noise.
#include "../support/backends.hpp"
#include "../support/coefficients.hpp"

#include <cayspin/cayspin.hpp>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace cayspin::test {
namespace {

using enum Boundary;
constexpr std::size_t columns = 19;  // not a whole number of registers

std::vector<Lattice> lattices_of_columns() {
  return {Lattice::chain(1),       Lattice::chain(13),    Lattice::chain(64, 1, periodic),
          Lattice::chain(70, 0.5), Lattice::square(9, 6), Lattice::square(5, 7, 0.5, periodic)};
}

Lattice side_by_side(Lattice const& one) {
  return {{static_cast<std::int64_t>(columns), one.shape[0], one.shape[1]},
          {1e200, one.spacing[0], one.spacing[1]},
          {open, one.boundary[0], one.boundary[1]}};
}

std::vector<double> column_of(std::vector<double> const& all, std::size_t column) {
  std::vector<double> numbers;
  for (std::size_t site = 0; site < all.size() / 3 / columns; ++site)
    for (std::size_t c = 0; c < 3; ++c) numbers.push_back(all[3 * (site * columns + column) + c]);
  return numbers;
}

std::vector<double> factors_of_columns() {
  std::vector<double> factors(columns);
  for (std::size_t column = 0; column < columns; ++column)
    factors[column] = 0.3 * static_cast<double>(column % 5);  // 0: no noise
  return factors;
}

template <class Backend>
class Columns : public OnBackend<Backend> {
 protected:
  using Spins = typename Backend::Spins;
  static constexpr bool on_host = detail::is_host_execution<typename Backend::Exec>;

  std::vector<double> run(Lattice const& lattice, std::vector<double> const& start,
                          ThermalNoiseOptions const& options, bool sweeps) {
    auto spins = spins_of<Spins>(lattice, start);
    ThermalNoise<Spins> const noise(spins, 0.5, options);
    Rkmk4<Spins> stepper(spins);
    if (sweeps) stepper.use(Path::sweep);
    LandauLifshitz const generator(
        EffectiveField(Exchange(lattice, 0.8), UniaxialAnisotropy(0.4, {0, 0.6, 0.8}),
                       TimeDependentZeeman([](double t) {
                         return Vec3<double>{0.1, std::sin(3 * t), 0};
                       })),
        0.2);
    Times const times{0, 0.0625, 4};
    integrate(this->exec, stepper, generator, spins, times, noise.between_steps(times));
    return numbers_of(spins);
  }

  void expect_bits_of_own_runs(double temperature, std::vector<double> const& factors,
                               bool sweeps = false) {
    for (Lattice const& one : lattices_of_columns()) {
      auto const lattice = side_by_side(one);
      auto const start = random_directions(lattice.sites(), 5);
      bool const wraps = lattice.boundary[2] == periodic && lattice.shape[2] > 1;
      auto const together = run(lattice, start,
                                {.temperature = temperature,
                                 .seed = 11,
                                 .replicas = factors,
                                 .columns_are_replicas = true},
                                sweeps && on_host && !wraps);
      EXPECT_NE(together, start);
      for (std::size_t column = 0; column < columns; ++column) {
        double const factor = factors.empty() ? 1 : factors[column];
        EXPECT_EQ(column_of(together, column),
                  run(one, column_of(start, column),
                      {.temperature = factor * temperature, .seed = 11 + column}, false))
            << one.shape[0] << " x " << one.shape[1] << ", column " << column;
      }
    }
  }
};
TYPED_TEST_SUITE(Columns, Backends, BackendName);

TYPED_TEST(Columns, MoveAsLatticesOfTheirOwn) {
  this->expect_bits_of_own_runs(0, {});
  this->expect_bits_of_own_runs(0, {}, true);
}

TYPED_TEST(Columns, HaveNoiseOfTheirOwn) {
  this->expect_bits_of_own_runs(0.7, {});
  this->expect_bits_of_own_runs(0.7, factors_of_columns());
}

TYPED_TEST(Columns, HaveNumbersForAllOfThem) {
  using Spins = typename TypeParam::Spins;
  Spins const spins("spins", Lattice::square(7, 3));
  Spins const replicas("replicas", Lattice::chain(7).with_replicas(2));
  auto const make = [](Spins const& like, std::vector<double> const& factors,
                       std::vector<double> const& cell_sites = {}) {
    ThermalNoise<Spins>(like, 0.5,
                        {.temperature = 1,
                         .cell_sites = cell_sites,
                         .replicas = factors,
                         .columns_are_replicas = true});
  };
  EXPECT_NO_THROW(make(spins, std::vector<double>(7, 1.0)));
  EXPECT_THROW(make(spins, std::vector<double>(3, 1.0)), std::invalid_argument);
  EXPECT_THROW(make(spins, std::vector<double>(7, -1.0)), std::invalid_argument);
  EXPECT_THROW(make(spins, {}, {1.0}), std::invalid_argument);
  EXPECT_THROW(make(replicas, {}), std::invalid_argument);
  ScalarField<typename TypeParam::Real, typename Spins::memory_space> const factors(
      "factors", spins.lattice());
  EXPECT_THROW(
      ThermalNoise<Spins>(spins, 0.5, {.temperature = 1, .columns_are_replicas = true}, factors),
      std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
