// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Uses spins in your own View: copies them in, integrates on the device, copies them out and reads
// them in your own kernel. All of this runs on one instance of an execution space, so that your
// code needs no fence in between. Energy, norm and magnetization are sampled during the run.
#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::DefaultExecutionSpace exec;
  auto const lattice = cayspin::Lattice::cubic(32, 16, 8, 1.0, cayspin::Boundary::periodic);

  Kokkos::View<float* [3]> mine("mine", lattice.sites());  // (site, component), x fastest
  auto const on_host = Kokkos::create_mirror_view(mine);
  for (int site = 0; site < static_cast<int>(lattice.sites()); ++site) {
    on_host(site, 0) = site % 2 ? 0.6f : -0.6f;
    on_host(site, 1) = 0.0f;
    on_host(site, 2) = 0.8f;
  }
  Kokkos::deep_copy(mine, on_host);

  cayspin::SpinField<float> spins("spins", lattice);
  cayspin::copy(exec, mine, spins);
  cayspin::require_unit_spins(exec, spins);  // steppers preserve the lengths that they are given

  cayspin::LandauLifshitz const generator(
      cayspin::EffectiveField(cayspin::Exchange(lattice, 1.0), cayspin::Zeeman{{0, 0, 0.5}}), 0.2);
  cayspin::LieEuler stepper(spins);
  double const dt = 0.5 * cayspin::largest_stable_step<decltype(stepper)>(
                              cayspin::exchange_bound(lattice, 1.0) + 0.5, 0.2);
  std::vector<cayspin::Sample> samples;
  cayspin::integrate(exec, stepper, generator, spins, {.begin = 0, .dt = dt, .steps = 2000},
                     cayspin::Every(500, cayspin::Record(generator, samples)));
  cayspin::copy(exec, spins, mine);

  for (auto const& s : samples)
    std::printf("t = %7.3f  E = %12.4f  m_z = %.5f  | |m| - 1 | <= %.1e\n", s.time, s.energy.value,
                s.magnetization.z, s.norm_defect);

  double sum = 0;
  Kokkos::parallel_reduce(
      "sum of m_z", Kokkos::RangePolicy(exec, 0, mine.extent_int(0)),
      KOKKOS_LAMBDA(int site, double& part) { part += static_cast<double>(mine(site, 2)); }, sum);
  double const mean = sum / static_cast<double>(lattice.sites());
  std::printf("m_z of the View = %.5f\n", mean);
  return std::abs(mean - samples.back().magnetization.z) < 1e-6 && mean > 0.999 ? 0 : 1;
}
