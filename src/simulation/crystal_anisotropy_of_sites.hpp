// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/spin_field.hpp>
#include <cayspin/vec3.hpp>

#include <Kokkos_Core.hpp>

namespace cayspin::simulation {

/// Anisotropy of a crystal with optionally site-dependent constants and axes. With components a, b,
/// c of m along the axes e1, e2 and e1 x e2, a cubic crystal has
///   E = constant * (a^2 * b^2 + b^2 * c^2 + c^2 * a^2) + second * a^2 * b^2 * c^2,
/// and a hexagonal one has E = constant * Re((b + i * c)^6).
template <class Real>
struct CrystalAnisotropyOfSites {
  bool hexagonal = false;
  cayspin::SiteArray<Real, 1> constants = {};
  cayspin::SiteArray<Real, 1> second = {};            // without data: 0
  Vec3<double> axes[2] = {};                          // e1 and e2, orthonormal
  cayspin::SiteArray<Real, 3> axes_of_sites[2] = {};  // replace `axes` if they have data

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Frame<Value> const frame = frame_at<Value>(stencil.site());
    Vec3<Value> const m = frame.parts(stencil.center());
    Value const constant = stencil.site().load(constants);
    if (hexagonal) {
      Complex<Value> const one{m.y, m.z}, two = product(one, one),
                                          five = product(product(two, two), one);
      Value const six = Value(6.0) * constant, none(0.0);
      return frame.sum(six * Vec3<Value>{none, none - five.x, five.y});
    }
    Value const a = m.x * m.x, b = m.y * m.y, c = m.z * m.z;
    Vec3<Value> strength = constant * Vec3<Value>{b + c, c + a, a + b};
    if (second.data)
      strength =
          multiply_add(stencil.site().load(second), Vec3<Value>{b * c, c * a, a * b}, strength);
    return Value(-2.0) *
           frame.sum(Vec3<Value>{strength.x * m.x, strength.y * m.y, strength.z * m.z});
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Vec3<Value> const m = frame_at<Value>(stencil.site()).parts(stencil.center());
    Value const constant = stencil.site().load(constants);
    if (hexagonal) {
      Complex<Value> const one{m.y, m.z}, two = product(one, one);
      return constant * product(product(two, two), two).x;
    }
    Value const a = m.x * m.x, b = m.y * m.y, c = m.z * m.z;
    Value const first = constant * (a * b + c * (a + b));
    return second.data ? Value(first + stencil.site().load(second) * a * b * c) : first;
  }

 private:
  template <class Value>
  struct Complex {
    Value x, y;
  };
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Complex<Value> product(Complex<Value> const& a,
                                                            Complex<Value> const& b) {
    return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
  }

  template <class Value>
  struct Frame {
    Vec3<Value> a, b, c;

    KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> parts(Vec3<Value> const& m) const {
      return {dot(m, a), dot(m, b), dot(m, c)};
    }
    KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> sum(Vec3<Value> const& v) const {
      return multiply_add(v.x, a, multiply_add(v.y, b, v.z * c));
    }
  };
  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION Frame<Value> frame_at(Site const& site) const {
    Vec3<Value> a = as_value<Value>(axes[0]), b = as_value<Value>(axes[1]);
    if (axes_of_sites[0].data) {
      a = site.load(axes_of_sites[0]);
      b = site.load(axes_of_sites[1]);
    }
    return {a, b, cross(a, b)};
  }
};

}  // namespace cayspin::simulation
