// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Your own generator: any A(m, t), for the motion m' = A x m. This one adds Slonczewski's torque of
// a spin-polarised current to any Landau-Lifshitz generator. The program finds the currents that
// switch a magnetic layer and compares them with Slonczewski's formula.
#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

struct Current {
  double strength, degree, asymmetry;
  cayspin::Vec3<double> polarisation;  // p, a unit vector
};

/// Gilbert's equation with the torque -a * m x (m x p), which turns spins towards the polarisation
/// p, or away from it if a < 0. Here a = strength * P * L^2 / ((L^2 + 1) + (L^2 - 1) * m.p), with
/// the degree of polarisation P and the asymmetry L. Gilbert's damping of this torque adds
/// -damping * a * p to A. Forwarding prepares the inner generator before each stage, so that the
/// field of the inner generator may depend on time or be computed on the host.
template <class Inner>
class SpinTorque : public cayspin::Forwarding<SpinTorque<Inner>, Inner> {
 public:
  SpinTorque(Inner inner, double damping, Current const& current)
      : inner_(std::move(inner)), damping_(damping), current_(current) {}

  template <class Stencil>
  KOKKOS_FUNCTION auto operator()(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const m = stencil.center(), p = cayspin::as_value<Value>(current_.polarisation);
    double const square = current_.asymmetry * current_.asymmetry;
    Value const a =
        cayspin::as_value<Value>(current_.strength * current_.degree * square) /
        (cayspin::as_value<Value>(square + 1) + cayspin::as_value<Value>(square - 1) * dot(m, p));
    return inner_(stencil) + a * (cross(m, p) - damping_ * p);
  }

  template <class Make>
  auto with_parts(Make const& make) const {
    auto prepared = make(inner_);
    return SpinTorque<decltype(prepared)>(std::move(prepared), damping_, current_);
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(inner_);
  }

 private:
  Inner inner_;
  double damping_;
  Current current_;
};

// A free layer with a perpendicular easy axis, in SI; p is +z.
constexpr double mu0 = 4e-7 * std::numbers::pi, electron = 1.602176634e-19, hbar = 1.054571817e-34;
constexpr double saturation = 1e6, anisotropy = 8e5, thickness = 1.2e-9;  // A/m, J/m^3, m
constexpr double damping = 0.01, degree = 0.6, asymmetry = 1.5;
// The anisotropy minus the demagnetising field, in reduced units.
constexpr double constant = 2 * anisotropy / (mu0 * saturation * saturation) - 1;
/// Strength, in units of Ms, of a current of 1 A/m^2.
constexpr double strength_of_unit = hbar / (mu0 * electron * saturation * saturation * thickness);

/// Returns true if the current drives a spin that is close to z (or to -z, if `down`) away from it.
bool leaves(bool down, double current) {
  Kokkos::DefaultExecutionSpace const exec;
  auto const one = cayspin::Lattice::chain(1);
  cayspin::SpinField<double> spins("spins", one);
  double const tilt = 1e-3;
  cayspin::copy_from_host<double>({std::sin(tilt), 0, (down ? -1 : 1) * std::cos(tilt)}, spins);
  cayspin::LandauLifshitz const inner(
      cayspin::EffectiveField(cayspin::UniaxialAnisotropy(constant, {0, 0, 1})), damping);
  SpinTorque const generator(inner, damping,
                             Current{current * strength_of_unit, degree, asymmetry, {0, 0, 1}});
  cayspin::Rkmk4 stepper(spins);
  cayspin::integrate(exec, stepper, generator, spins, {0, 0.1, 2000});
  auto const m = cayspin::copy_to_host(spins);
  return std::atan2(std::hypot(m[0], m[1]), down ? -m[2] : m[2]) > tilt;
}

/// Returns the critical current in A/m^2, by bisection.
double critical_current(bool down) {
  double stays = 0, goes = down ? 1e12 : -1e12;
  for (int halving = 0; halving < 40; ++halving) {
    double const middle = 0.5 * (stays + goes);
    (leaves(down, middle) ? goes : stays) = middle;
  }
  return 0.5 * (stays + goes);
}

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  // The layer switches at a = -damping * H_k if m.p = 1, and at a = damping * H_k if m.p = -1.
  double const predicted_up = -2 * damping * constant / (strength_of_unit * degree);
  double const predicted_down = -predicted_up / (asymmetry * asymmetry);
  double const up = critical_current(false), down = critical_current(true);
  std::printf("from parallel      %.6e A/m^2, predicted %.6e\n", up, predicted_up);
  std::printf("from antiparallel  %.6e A/m^2, predicted %.6e\n", down, predicted_down);
  return std::abs(up / predicted_up - 1) < 1e-5 && std::abs(down / predicted_down - 1) < 1e-5 ? 0
                                                                                              : 1;
}
