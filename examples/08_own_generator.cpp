// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A generator of your own: any A(m, t) with m' = A x m. This one adds the torque of a
// spin-polarised current to a Landau-Lifshitz generator, whatever that is made of.
#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

/// m' = A x m + strength m x (m x p): spins turn away from the polarisation p.
/// Forwarding makes the inner generator ready before each stage, so that its field may depend on
/// time or come from the host.
template <class Inner>
class SpinTorque : public cayspin::Forwarding<SpinTorque<Inner>, Inner> {
 public:
  SpinTorque(Inner inner, double strength, cayspin::Vec3<double> const& polarisation)
      : inner_(std::move(inner)), strength_(strength), polarisation_(polarisation) {}

  template <class Stencil>
  KOKKOS_FUNCTION auto operator()(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const p = cayspin::as_value<Value>(polarisation_);
    return inner_(stencil) - strength_ * cross(stencil.center(), p);
  }

  template <class Make>
  auto with_parts(Make const& make) const {
    auto prepared = make(inner_);
    return SpinTorque<decltype(prepared)>(std::move(prepared), strength_, polarisation_);
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(inner_);
  }

 private:
  Inner inner_;
  double strength_;
  cayspin::Vec3<double> polarisation_;
};

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::DefaultExecutionSpace exec;
  auto const lattice = cayspin::Lattice::square(16, 16);
  double const damping = 0.1;
  cayspin::EffectiveField const field(cayspin::Exchange(lattice, 1.0),
                                      cayspin::UniaxialAnisotropy(1.0, {0, 0, 1}));
  cayspin::LandauLifshitz const without_current(field, damping);

  // Above strength = damping * constant the current beats the damping, and the spins switch.
  auto const m_z_after = [&](double strength) {
    cayspin::SpinField<double> spins("spins", lattice);
    std::vector<double> start;
    for (int site = 0; site < 256; ++site)
      start.insert(start.end(), {std::sin(0.1), 0.0, std::cos(0.1)});
    cayspin::copy_from_host(start, spins);
    SpinTorque const generator(without_current, strength, {0, 0, 1});
    cayspin::Rkmk4 stepper(spins);
    cayspin::integrate(exec, stepper, generator, spins, {0, 0.05, 4000});
    return cayspin::magnetization(exec, spins).z;
  };
  double const weak = m_z_after(0.05), strong = m_z_after(0.15);
  std::printf("m_z = %.6f at half the critical current, %.6f at 1.5 times it\n", weak, strong);
  return weak > 0.999 && strong < -0.999 ? 0 : 1;
}
