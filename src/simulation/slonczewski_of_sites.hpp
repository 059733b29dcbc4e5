// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/spin_field.hpp>
#include <cayspin/vec3.hpp>

#include <Kokkos_Core.hpp>

namespace cayspin::simulation {

/// The field of cayspin::Slonczewski, H = a * c * (m x p) + b * p, with the angular dependence
/// c = 2 * L^2 / ((L^2 + 1) + (L^2 - 1) * m.p), where L is the key lambda. If an array has data, it
/// multiplies a or b, or replaces p, at each site.
template <class Real>
struct SlonczewskiOfSites {
  // Factors of a and b.
  cayspin::SiteArray<Real, 1> damping_like_of_sites = {}, field_like_of_sites = {};
  cayspin::SiteArray<Real, 3> polarizations = {};
  double damping_like = 0, field_like = 0;  // a, b
  Vec3<double> polarization{0, 0, 1};       // p
  double square = 1;                        // L^2

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& m = stencil.center();
    auto const& site = stencil.site();
    auto const p =
        polarizations.data ? Vec3<Value>(site.load(polarizations)) : as_value<Value>(polarization);
    Value a = as_value<Value>(damping_like), b = as_value<Value>(field_like);
    if (damping_like_of_sites.data) a = a * site.load(damping_like_of_sites);
    if (field_like_of_sites.data) b = b * site.load(field_like_of_sites);
    if (square != 1)
      a = a * as_value<Value>(2 * square) /
          (as_value<Value>(square + 1) + as_value<Value>(square - 1) * dot(m, p));
    return multiply_add(b, p, Value(a) * cross(m, p));
  }
};

}  // namespace cayspin::simulation
