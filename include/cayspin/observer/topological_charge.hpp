// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_2 {

namespace detail {

/// A spin and its length.
template <class Value>
struct SpinAndLength {
  Vec3<Value> m;
  Value length;

  KOKKOS_FORCEINLINE_FUNCTION explicit SpinAndLength(Vec3<Value> const& spin)
      : m(spin), length(square_root(dot(spin, spin))) {}
};

/// Returns half the solid angle that three spins enclose, within -pi .. pi (van Oosterom and
/// Strackee 1983): its tan is a.(b x c) / (1 + a.b + b.c + c.a) for unit vectors. Returns 0 for
/// spins that are coplanar to round-off: if two of them are antiparallel, numerator and denominator
/// would be rounding errors.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value half_solid_angle(SpinAndLength<Value> const& a,
                                                   SpinAndLength<Value> const& b,
                                                   SpinAndLength<Value> const& c) {
  Value const volume = dot(a.m, cross(b.m, c.m)), lengths = a.length * b.length * c.length;
  Value const rest = multiply_add(
      dot(a.m, b.m), c.length,
      multiply_add(dot(b.m, c.m), a.length, multiply_add(dot(c.m, a.m), b.length, lengths)));
  Value const nothing = multiply_add(Value(1e-15), lengths, Value(1e-300));
  return select<Value>(Kokkos::abs(volume) < nothing, Value(0.0),
                       Value(Kokkos::atan2(volume, rest)));
}

/// Functor that computes half the sum of the solid angles of two triangles at a site: one with the
/// next neighbours along x and y, and one with the previous neighbours. All sites together cover
/// each plaquette with one triangle of either kind.
template <class Real>
struct SolidAngleOfSites {
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, spins);
    auto const none = zero<Value>();  // a zero spin encloses no angle
    SpinAndLength<Value> const here(stencil.center());
    SpinAndLength<Value> const east(stencil.template next<0>(none));
    SpinAndLength<Value> const north(stencil.template next<1>(none));
    SpinAndLength<Value> const west(stencil.template previous<0>(none));
    SpinAndLength<Value> const south(stencil.template previous<1>(none));
    values[0] = half_solid_angle(here, east, north) + half_solid_angle(here, west, south);
  }
};

/// Returns the charge of the rows `layout.own`, summed over all parts of the lattice.
template <class Exec, class Real, class MemorySpace>
double charge_of(Exec const& exec, SpinField<Real, MemorySpace> const& spins,
                 RowLayout const& layout) {
  check_access<Exec, MemorySpace>();
  constexpr char const* label = "cayspin::topological_charge";
  require_sites(label, spins.sites());
  auto const& shape = whole(spins.lattice()).shape;
  if (shape[0] < 2 || shape[1] < 2) return 0;  // no plaquettes
  auto const angle =
      reduce_sites<Sum, 1>(exec, label, layout, SolidAngleOfSites<Real>{spins.array()});
  return angle[0] / (2 * std::numbers::pi);
}

}  // namespace detail

/// Returns the topological charge of the planes (x, y), Q = sum m.(d_x m x d_y m) / (4 * pi), where
/// the sum is over all sites of all planes. Q is computed as the sum of the solid angles of
/// triangles of neighbouring spins, two in each plaquette, divided by 4 * pi (Berg and Luescher
/// 1981). Axes and planes are those of the lattice, also for a crystal. Lengths of spins do not
/// matter; a spin of length 0 encloses no angle.
///
/// A skyrmion of Neel or Bloch type with its core down among spins up has Q = -1; an antiskyrmion
/// with that core has +1. The charge of a periodic plane is an integer, to round-off. There are no
/// plaquettes beyond open ends: a vortex in a film has about +-1/2. Three spins that lie in a plane
/// and point all around it enclose half the sphere, but the sign is undetermined; they count as 0.
///
/// Sums are in double. On host spaces their bits do not depend on the number of threads. Throws
/// std::invalid_argument for spins without sites.
template <class Exec, class Real, class MemorySpace>
double topological_charge(Exec const& exec, SpinField<Real, MemorySpace> const& spins) {
  return detail::charge_of(exec, spins, spins.layout());
}

/// Returns the charge of only plane z of the whole lattice. In a field of replicas, the planes of
/// the second replica are numbered after those of the first, and so on. Throws
/// std::invalid_argument when there is no such plane.
template <class Exec, class Real, class MemorySpace>
double topological_charge(Exec const& exec, SpinField<Real, MemorySpace> const& spins,
                          std::int64_t z) {
  detail::require_sites("cayspin::topological_charge", spins.sites());
  auto const& lattice = whole(spins.lattice());
  auto const planes = lattice.shape[2] * lattice.replicas;
  if (z < 0 || z >= planes)
    throw std::invalid_argument("cayspin::topological_charge: there is no plane " +
                                std::to_string(z) + "; accepted: 0 .. " +
                                std::to_string(planes - 1));
  auto layout = spins.layout();
  auto const first = layout.part == nullptr ? 0 : layout.part->begin()[2];
  auto& own = layout.own;  // empty if the plane belongs to another part
  auto const begin = std::clamp<std::int64_t>(z - first, own.z_begin, own.z_end);
  auto const end = std::clamp<std::int64_t>(z - first + 1, own.z_begin, own.z_end);
  own.z_begin = static_cast<std::int32_t>(begin);
  own.z_end = static_cast<std::int32_t>(end);
  return detail::charge_of(exec, spins, layout);
}

}  // namespace cayspin::inline v0_2
