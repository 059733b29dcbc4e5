// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

#include <cmath>
#include <stdexcept>

namespace cayspin::inline v0_2 {

/// Cubic anisotropy, with components a, b, c of m along the axes e1, e2 and e3 = e1 x e2:
/// E = Kc * (a^2 * b^2 + b^2 * c^2 + c^2 * a^2) per site,
/// H = -2 * Kc * [a * (b^2 + c^2) * e1 + b * (c^2 + a^2) * e2 + c * (a^2 + b^2) * e3].
/// In reduced units, Kc is an energy per site. Aharoni 2000, Sec. 5.1.2.
class CubicAnisotropy {
 public:
  static constexpr bool is_local = true;
  static constexpr double most_skew = 1e-4;

  /// Normalises the axes and makes the second orthogonal to the first. Throws std::invalid_argument
  /// when the constant is not finite, an axis is zero or not finite, or |e1.e2| > 1e-4. Unit axes
  /// that are rounded to five decimals stay below this bound.
  CubicAnisotropy(double constant, Vec3<double> const& axis1, Vec3<double> const& axis2)
      : constant_(detail::finite(constant, "cayspin::CubicAnisotropy: the constant")),
        axes_{normalized(axis1, "cayspin::CubicAnisotropy: the first axis"),
              normalized(axis2, "cayspin::CubicAnisotropy: the second axis"),
              {}} {
    double const along = dot(axes_[0], axes_[1]);
    if (!(std::abs(along) <= most_skew))
      throw std::invalid_argument(
          "cayspin::CubicAnisotropy: the axes are not at right angles: |e1.e2| is above 1e-4");
    axes_[1] = normalized(axes_[1] - along * axes_[0], "cayspin::CubicAnisotropy: the second axis");
    axes_[2] = cross(axes_[0], axes_[1]);
    along_coordinates_ = is_coordinate(axes_[0]) && is_coordinate(axes_[1]);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Vec3<Value> const m = parts(stencil.center());
    Value const a = m.x * m.x, b = m.y * m.y, c = m.z * m.z;
    return as_value<Value>(-2 * constant_) *
           sum<Value>({m.x * (b + c), m.y * (c + a), m.z * (a + b)});
  }
  /// Adds H up to a multiple of m: 2 * Kc * (a^3 * e1 + b^3 * e2 + c^3 * e3), which follows from
  /// b^2 + c^2 = |m|^2 - a^2 and so on.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add_turning_field(
      Stencil const& stencil, VectorOf<Stencil> const& h) const {
    using Value = typename Stencil::value_type;
    Vec3<Value> const m = parts(stencil.center());
    return multiply_add(as_value<Value>(2 * constant_),
                        sum<Value>({m.x * m.x * m.x, m.y * m.y * m.y, m.z * m.z * m.z}), h);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Vec3<Value> const m = parts(stencil.center());
    Value const a = m.x * m.x, b = m.y * m.y, c = m.z * m.z;
    return as_value<Value>(constant_) * detail::multiply_add(a, b, Value(c * (a + b)));
  }

  KOKKOS_FORCEINLINE_FUNCTION double constant() const { return constant_; }
  /// Returns the components a, b and c of `v`. If all axes are coordinate axes, returns x, y and z,
  /// since E does not depend on the order or the signs of the components.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> parts(Vec3<Value> const& v) const {
    if (along_coordinates_) [[likely]]
      return v;
    return {dot(v, as_value<Value>(axes_[0])), dot(v, as_value<Value>(axes_[1])),
            dot(v, as_value<Value>(axes_[2]))};
  }
  /// Returns the vector whose components a, b and c are those of `v`.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> sum(Vec3<Value> const& v) const {
    if (along_coordinates_) [[likely]]
      return v;
    return multiply_add(
        v.x, as_value<Value>(axes_[0]),
        multiply_add(v.y, as_value<Value>(axes_[1]), v.z * as_value<Value>(axes_[2])));
  }

 private:
  static bool is_coordinate(Vec3<double> const& axis) {
    return int{axis.x == 0} + int{axis.y == 0} + int{axis.z == 0} == 2;
  }

  double constant_;
  Vec3<double> axes_[3];
  bool along_coordinates_ = false;
};

}  // namespace cayspin::inline v0_2
