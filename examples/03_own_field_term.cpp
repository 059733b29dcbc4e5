// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Your own field term is a plain struct. It is fused with the other terms into one kernel, on every
// backend and in both precisions; you need not register or instantiate it anywhere.
#include <cayspin/cayspin.hpp>

#include <cstdio>

/// Cubic anisotropy with axes x, y, z: E = K/2 * (mx^2 * my^2 + my^2 * mz^2 + mz^2 * mx^2) per
/// site.
struct CubicAnisotropy {
  double constant;

  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const m = stencil.center();
    Value const k(-constant), xx = m.x * m.x, yy = m.y * m.y, zz = m.z * m.z;
    return cayspin::Vec3<Value>{k * m.x * (yy + zz), k * m.y * (zz + xx), k * m.z * (xx + yy)};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const m = stencil.center();
    Value const xx = m.x * m.x, yy = m.y * m.y, zz = m.z * m.z;
    return Value(0.5 * constant) * (xx * yy + yy * zz + zz * xx);
  }
};

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::DefaultExecutionSpace exec;
  auto const lattice = cayspin::Lattice::square(20, 20);
  cayspin::SpinField<double> spins("spins", lattice);

  // A field along (2, 1, 1) tips the spins from the easy axis z; after it is switched off, they
  // settle along the easy axis x.
  cayspin::EffectiveField const tipping(cayspin::Exchange(lattice, 2.0), CubicAnisotropy{1.0},
                                        cayspin::Zeeman{{2, 1, 1}});
  cayspin::EffectiveField const resting(cayspin::Exchange(lattice, 2.0), CubicAnisotropy{1.0});
  cayspin::Rkmk4 stepper(spins);
  cayspin::integrate(exec, stepper, cayspin::LandauLifshitz(tipping, 0.5), spins, {0, 0.02, 500});
  cayspin::integrate(exec, stepper, cayspin::LandauLifshitz(resting, 0.5), spins, {10, 0.02, 2500});

  auto const m = cayspin::magnetization(exec, spins);
  std::printf("rests at (%.6f, %.6f, %.6f), E = %.3e\n", m.x, m.y, m.z,
              cayspin::energy(exec, resting, spins).value);
  return m.x > 0.999 ? 0 : 1;
}
