// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <array>
#include <utility>
#include <vector>

namespace cayspin::test {

inline Slab coupled_chain(double damping) {
  return {.lattice = Lattice::chain(8),
          .exchange = 1,
          .anisotropy = 0.8,
          .axis = {1, 2, 3},
          .demag = 0.7,
          .applied = {0.5, -0.7, 0.9},
          .damping = damping};
}

template <class Field = Spins>
Field chain_start() {
  return random_spins<Field>(Lattice::chain(8), 3);
}

/// Orders on a coupled chain whose rotations do not commute; the parameter is the damping.
class ChainOrder : public ::testing::TestWithParam<double> {
 protected:
  Slab const slab = coupled_chain(GetParam());
  // Strongly damped motions end sooner.
  double const end_time = std::min(1.0, 1 / GetParam());
  Spins const reference = run<Rkmk4<Spins>>(slab.natural(), chain_start(), end_time / 4000, 4000);

  /// Numbers of steps for which round-off does not show in the errors.
  std::array<int, 4> ladder = {40, 80, 160, 320};
  double order_tolerance = 0.15;

  template <class Stepper, class Generator, class... Options>
  void expect(char const* what, int order, Generator const& generator,
              Options const&... options) const {
    expect_convergence(what, end_time, ladder, order, order_tolerance, [&](int steps, double dt) {
      return largest_distance(run<Stepper>(generator, chain_start(), dt, steps, options...),
                              reference);
    });
    EXPECT_EQ(Stepper::order, order);
  }

  template <class Tableau, class Generator>
  void expect_on_group_chart_and_sphere(Generator const& generator) const {
    SCOPED_TRACE(Tableau::stages);
    expect<Rkmk<Spins, Tableau>>("group", Tableau::order, generator);
    expect<StereographicRungeKutta<Spins, Tableau>>("chart", Tableau::order, generator);
    expect<ProjectedRungeKutta<Spins, Tableau>>("projected", Tableau::order, generator);
  }
};

/// Expects the largest stable dt of a mode of rate 1 at each damping in `limits`, which has pairs
/// {damping, dt / number of stages}.
template <class Stepper>
void expect_stable_per_stage(std::vector<std::pair<double, double>> const& limits,
                             double tolerance) {
  for (auto const& [damping, limit] : limits)
    EXPECT_NEAR(largest_stable_step<Stepper>(1, damping) / Stepper::tableau_type::stages, limit,
                tolerance)
        << "damping " << damping;
}

inline auto const chain_dampings = ::testing::Values(0.05, 1.0, 10.0);

}  // namespace cayspin::test
