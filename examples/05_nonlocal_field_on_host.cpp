// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A non-local field computed by host code, which gets the spins in host memory (a copy, if they are
// on a device). Use this for an FFT demagnetising field or any solver that is not a kernel. Here
// the field is that of the dipoles of a periodic chain, summed directly.
#include <cayspin/cayspin.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

/// H_i = g * sum_j (3 * (m_j.x) * x - m_j) / r_ij^3 along a periodic chain in direction x; r_ij is
/// the distance the shorter way around, and g is the strength.
struct DipolesOfChain {
  static constexpr int degree = 2;  // H is linear in m: E = -m.H/2
  double strength;

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    using Real = typename HostSpins::value_type;
    auto const n = spins.sites();
    for (std::int64_t i = 0; i < n; ++i) {
      cayspin::Vec3<Real> h{0, 0, 0};
      for (std::int64_t j = 0; j < n; ++j) {
        if (i == j) continue;
        auto const apart = std::abs(i - j);
        auto const r = static_cast<double>(std::min(apart, n - apart));
        auto const g = static_cast<Real>(strength / (r * r * r));
        auto const m = spins.get(j);
        h = h + cayspin::Vec3<Real>{2 * g * m.x, -g * m.y, -g * m.z};
      }
      field.set(i, h);
    }
  }
};

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::DefaultExecutionSpace exec;
  auto const ring = cayspin::Lattice::chain(64, 1.0, cayspin::Boundary::periodic);
  cayspin::SpinField<double> spins("spins", ring);

  cayspin::EffectiveField const field(cayspin::Exchange(ring, 0.5), cayspin::Zeeman{{0.05, 0, 0}},
                                      cayspin::HostField(spins, DipolesOfChain{0.2}));
  cayspin::LandauLifshitz const generator(field, 0.5);
  cayspin::LieEuler stepper(spins);
  double const before = cayspin::energy(exec, field, spins).value;
  cayspin::integrate(exec, stepper, generator, spins, {.begin = 0, .dt = 0.05, .steps = 2000});
  auto const m = cayspin::magnetization(exec, spins);
  std::printf("E %.4f -> %.4f, the dipoles pull the spins along the chain: m_x = %.6f\n", before,
              cayspin::energy(exec, field, spins).value, m.x);
  return m.x > 0.999 ? 0 : 1;
}
