// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Spins turn about a field. Compiled with the flags that cayspin.pc gives.
#include <cayspin/cayspin.hpp>
#include <cayspin/version.hpp>

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  auto const chain = cayspin::Lattice::chain(5);
  cayspin::SpinField<double> spins("spins", chain);
  cayspin::copy_from_host<double>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, spins);
  cayspin::EffectiveField const field(cayspin::Zeeman{{0, 0, 2}});
  cayspin::Rkmk4 stepper(spins);
  cayspin::integrate(Kokkos::DefaultExecutionSpace(), stepper, cayspin::LandauLifshitz(field, 0.0),
                     spins, {0, 0.01, 100});
  auto const m = cayspin::copy_to_host(spins);
  std::printf("%s %.8f %.8f\n", CAYSPIN_VERSION_STRING, m[12], m[13]);
  return std::hypot(m[12] - std::cos(2.0), m[13] - std::sin(2.0)) < 1e-9 ? 0 : 1;
}
