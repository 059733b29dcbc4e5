// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/demagnetizing_field.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace cayspin::test {

struct Film {
  std::array<std::int64_t, 3> shape;
  std::array<int, 3> images;
  std::array<double, 3> spacing;

  Lattice lattice() const { return {.shape = shape, .spacing = spacing}; }
};

inline std::vector<Film> const films = {
    {{7, 5, 3}, {}, {1, 1.3, 0.4}},
    {{6, 4, 4}, {}, {1, 1, 1}},
    {{9, 17, 1}, {}, {2, 1.5, 0.02}},
    {{11, 1, 1}, {}, {1, 2, 3}},
    {{1, 9, 1}, {}, {3, 1, 2}},
    {{1, 1, 8}, {}, {2, 3, 1}},
    {{1, 1, 1}, {}, {1, 1, 2}},
    {{1, 12, 5}, {}, {1, 1, 1}},
    {{6, 5, 4}, {2, 0, 0}, {1, 1.3, 0.4}},
    {{5, 6, 2}, {0, 1, 3}, {1, 1, 1}},
    {{4, 5, 1}, {3, 2, 0}, {1, 1, 0.1}},
    {{2, 3, 1}, {1, 1, 1}, {1, 2, 1}},
};

/// Returns the field of spins along `directions`, on the host. It is evaluated twice: the second
/// time with work memory left by the first.
template <class Real>
SpinField<Real, Kokkos::HostSpace> field_on_host(Lattice const& lattice,
                                                 std::vector<double> const& directions,
                                                 DemagnetizationOptions const& options = {}) {
  using Spins = SpinField<Real, Kokkos::HostSpace>;
  auto const spins = spins_of<Spins>(lattice, directions);
  Spins field("field", lattice);
  DemagnetizingField<Real> const demag(lattice, options);
  for (int again = 0; again < 2; ++again) demag(spins, field, 0);
  return field;
}

}  // namespace cayspin::test
