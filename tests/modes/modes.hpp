// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"
#include "small_matrices.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/modes.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace cayspin::test {

template <class Backend>
class ModesTest : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();
  /// Bound on errors, 1e-10 in double.
  static constexpr double accurate = 5e5 * epsilon;

  Spins uniform(Lattice const& lattice, Vec3<double> const& m) const {
    std::vector<double> numbers;
    for (std::int64_t i = 0; i < lattice.sites(); ++i)
      for (double const c : {m.x, m.y, m.z}) numbers.push_back(c);
    return spins_of<Spins>(lattice, numbers);
  }

  /// Expects as many modes as normal_modes finds by default, whose frequencies are the least of
  /// `all`. Each decay must be `damping` times the frequency.
  template <class Modes>
  void expect_frequencies(Modes const& modes, std::vector<double> all, double damping) const {
    std::ranges::sort(all);
    ASSERT_EQ(modes.end, ModesEnd::converged);
    ASSERT_EQ(modes.modes.size(), std::min(ModesOptions{}.count, all.size()));
    for (std::size_t i = 0; i < modes.modes.size(); ++i) {
      EXPECT_NEAR(modes.modes[i].frequency, all[i], accurate * all[i]) << i;
      EXPECT_NEAR(modes.modes[i].decay, damping * all[i], accurate * all[i]) << i;
    }
  }

  typename Backend::Exec exec;
};

}  // namespace cayspin::test
