// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Site-dependent coefficients: two weakly coupled grains with different easy axes, a hole between
// them, and ends that absorb spin waves.
#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::DefaultExecutionSpace exec;
  auto const film = cayspin::Lattice::square(64, 24);
  std::vector<double> exchange, axes, damping, occupation;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 64; ++x) {
      bool const left = x < 32;
      exchange.push_back(x == 31 || x == 32 ? 0.1 : 1.0);  // a bond takes the harmonic mean
      axes.insert(axes.end(), {left ? 0.6 : -0.6, 0.0, 0.8});
      damping.push_back(x < 8 || x >= 56 ? 0.5 : 0.02);
      occupation.push_back(std::hypot(x - 31.5, y - 11.5) < 6 ? 0 : 1);
    }
  auto const on_film = [&](std::vector<double> const& numbers) {
    cayspin::ScalarField<double> const field("coefficient", film);
    cayspin::copy_from_host(numbers, field);
    return field;
  };
  cayspin::SpinField<double> const easy_axes("easy_axes", film);
  cayspin::copy_from_host(axes, easy_axes);

  auto const occupied = on_film(occupation);
  cayspin::EffectiveField const terms(cayspin::SiteDependentExchange(on_film(exchange)),
                                      cayspin::SiteDependentUniaxialAnisotropy(0.5, easy_axes),
                                      cayspin::Zeeman{{0, 0, 0.05}});
  cayspin::FieldWithVacancies const field(terms, occupied);
  cayspin::LandauLifshitz const generator(field, on_film(damping));

  cayspin::SpinField<double> spins("spins", film);  // starts along +z
  cayspin::Rkmk4 stepper(spins);
  double const before = cayspin::energy(exec, field, spins).value;
  cayspin::integrate(exec, stepper, generator, spins, {.begin = 0, .dt = 0.1, .steps = 1000});
  double const after = cayspin::energy(exec, field, spins).value;
  std::printf("E %.4f -> %.4f, mean m_z of the occupied sites = %.6f\n", before, after,
              cayspin::magnetization(exec, spins, occupied).z);
  return after < before ? 0 : 1;
}
