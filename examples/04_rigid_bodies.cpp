// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A thousand free rigid bodies of equal inertia tumble: rotation about the middle axis is unstable.
// The length of the angular momentum is conserved to round-off, and the energy to the order of the
// method.
#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::DefaultExecutionSpace exec;
  auto const bodies = cayspin::Lattice::chain(1000);
  cayspin::SpinField<double> momenta("momenta", bodies);
  std::vector<double> start;
  for (int body = 0; body < 1000; ++body) {
    double const tilt = 1e-3 * (body + 1);  // off the middle axis
    start.insert(start.end(), {std::sin(tilt), std::cos(tilt), 0.0});
  }
  cayspin::copy_from_host(start, momenta);

  auto const generator = cayspin::RigidBody::principal(1.0, 2.0, 3.0);
  cayspin::Rkmk4 stepper(momenta);
  double const before = cayspin::energy(exec, generator, momenta).value;
  cayspin::integrate(exec, stepper, generator, momenta, {.begin = 0, .dt = 0.05, .steps = 4000});
  double const after = cayspin::energy(exec, generator, momenta).value;
  std::printf("relative energy error %.1e, largest | |m| - 1 | = %.1e\n",
              std::abs(after - before) / before, cayspin::norm_defect(exec, momenta));
}
