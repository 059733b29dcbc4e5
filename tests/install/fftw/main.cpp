// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/demagnetizing_field.hpp>

#include <cmath>

// A cube magnetised along z has H = -m/3.
int main() {
  using Spins = cayspin::SpinField<double, Kokkos::HostSpace>;
  Kokkos::ScopeGuard const kokkos;
  auto const cube = cayspin::Lattice::cubic(1, 1, 1);
  Spins const spins("spins", cube), field("field", cube);  // spins start along +z
  cayspin::DemagnetizingField<double> const demag(cube);
  demag(spins, field, 0);
  return std::abs(field.get(0).z + 1. / 3) < 1e-14 ? 0 : 1;
}
