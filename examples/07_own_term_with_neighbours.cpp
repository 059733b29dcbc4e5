// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Your own field term that reads neighbours. The second argument of `next<Axis>` and
// `previous<Axis>` replaces a missing neighbour: here it is zero, so that an open end has no bond.
#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

/// The interfacial Dzyaloshinskii-Moriya interaction of a film with normal z and spacing 1:
/// H = -2 * D * (z div m - grad m_z), E = -m.H / 2 per site.
struct InterfacialDmi {
  static constexpr int degree = 2;  // H is linear in the spins
  double constant;

  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const none = cayspin::zero<Value>();
    auto const x = cayspin::next<0>(stencil, none) - cayspin::previous<0>(stencil, none);
    auto const y = cayspin::next<1>(stencil, none) - cayspin::previous<1>(stencil, none);
    return constant * cayspin::Vec3<Value>{x.z, y.z, -x.x - y.y};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(-0.5) * dot(stencil.center(), field(stencil));
  }
};

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Kokkos::DefaultExecutionSpace exec;
  auto const lattice = cayspin::Lattice::chain(24);
  cayspin::SpinField<double> spins("spins", lattice);
  std::vector<double> start;
  for (int site = 0; site < 24; ++site) {
    double const angle = -0.2 * site;
    start.insert(start.end(), {std::sin(angle), 0.0, std::cos(angle)});
  }
  cayspin::copy_from_host(start, spins);

  cayspin::EffectiveField const field(cayspin::Exchange(lattice, 1.0), InterfacialDmi{0.3});
  cayspin::Rkmk4 stepper(spins);
  cayspin::integrate(exec, stepper, cayspin::LandauLifshitz(field, 1.0), spins, {0, 0.1, 10000});

  // The interaction works against the exchange, and turns the spins by equal angles from site to
  // site.
  auto const m = cayspin::copy_to_host(spins);
  auto const angle = [&](std::size_t site) { return std::atan2(m[3 * site], m[3 * site + 2]); };
  double const turn = std::remainder(angle(12) - angle(11), 2 * std::acos(-1.0));
  auto const [exchange, dmi] = cayspin::term_energies(exec, field, spins);
  std::printf("turn per site %.6f, predicted %.6f; E of exchange %.4f, of the interaction %.4f\n",
              turn, -std::atan(0.3), exchange.value, dmi.value);
  return std::abs(turn + std::atan(0.3)) < 1e-6 ? 0 : 1;
}
