// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/minimize.hpp>

#include <cmath>
#include <type_traits>
#include <vector>

namespace cayspin::test {

template <class Backend>
class MinimizerTest : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  static constexpr bool is_double = std::is_same_v<Real, double>;

  static Spins random_spins(Lattice const& lattice, unsigned seed) {
    return spins_of<Spins>(lattice, random_directions(lattice.sites(), seed));
  }
  typename Backend::Exec exec;
};

/// Returns the field of a film with an easy axis in its plane and a local demagnetising field.
inline auto film(Lattice const& lattice, double exchange) {
  return EffectiveField(Exchange(lattice, exchange), UniaxialAnisotropy(0.1, {1, 0, 0}),
                        SlabDemag({0, 0, 1}, 1.0));
}

inline std::vector<double> vortex(std::int64_t n) {
  std::vector<double> numbers;
  for (std::int64_t j = 0; j < n; ++j)
    for (std::int64_t i = 0; i < n; ++i) {
      double const x = (i + 0.5) / n - 0.5, y = (j + 0.5) / n - 0.5;
      double const length = std::sqrt(x * x + y * y + 0.01);
      for (double const c : {-y, x, 0.1}) numbers.push_back(c / length);
    }
  return numbers;
}

}  // namespace cayspin::test
