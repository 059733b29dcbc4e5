// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A strong field switches a slab of a hundred spins. The README shows this program.
#include <cayspin/cayspin.hpp>

#include <cstdio>

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::DefaultExecutionSpace exec;
  auto lattice = cayspin::Lattice::chain(100);
  cayspin::SpinField<double> spins("spins", lattice);  // starts along +z

  cayspin::EffectiveField field(cayspin::Exchange(lattice, 1.0),
                                cayspin::UniaxialAnisotropy(1.0, {0, 0, 1}),
                                cayspin::SlabDemag({1, 0, 0}), cayspin::Zeeman{{5, 0, 0}});
  cayspin::LandauLifshitz generator(field, 0.05);
  cayspin::Rkmk4 stepper(spins);
  cayspin::integrate(exec, stepper, generator, spins, {.begin = 0, .dt = 0.01, .steps = 6000});

  auto m = cayspin::magnetization(exec, spins);
  std::printf("m = (%.4f, %.4f, %.4f)\n", m.x, m.y, m.z);  // m = (1.0000, 0.0000, 0.0000)
}
