// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

namespace cayspin::inline v0_2::detail {

/// A term that depends on the component of the spin along one axis:
/// H = c * (m.e) * e, E = -c * (m.e)^2 / 2. In packs of sites on the host, an axis along x, y or z
/// costs one product instead of seven.
class AlongAxis {
 public:
  static constexpr int degree = 2;  // H is linear in the spins
  static constexpr bool is_local = true;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return add_field(stencil, zero<ValueOf<Stencil>>());
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add_field(Stencil const& stencil,
                                                          VectorOf<Stencil> const& h) const {
    using Value = typename Stencil::value_type;
    Vec3<Value> const& m = stencil.center();
    auto const c = as_value<Value>(constant_);
    if constexpr (one_at_a_time<Value>) {
      auto const e = as_value<Value>(axis_);
      return multiply_add(Value(c * dot(m, e)), e, h);
    }
    if (coordinate_ == Coordinate::z) [[likely]]
      return {h.x, h.y, detail::multiply_add(c, m.z, h.z)};
    if (coordinate_ == Coordinate::x) return {detail::multiply_add(c, m.x, h.x), h.y, h.z};
    if (coordinate_ == Coordinate::y) return {h.x, detail::multiply_add(c, m.y, h.y), h.z};
    auto const e = as_value<Value>(axis_);
    return multiply_add(Value(c * dot(m, e)), e, h);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const along = dot(stencil.center(), as_value<Value>(axis_));
    return as_value<Value>(-0.5 * constant_) * along * along;
  }

 protected:
  AlongAxis(double constant, Vec3<double> const& axis, char const* what)
      : constant_(constant), axis_(normalized(axis, what)) {
    if (axis_.x == 0 && axis_.y == 0) coordinate_ = Coordinate::z;
    if (axis_.x == 0 && axis_.z == 0) coordinate_ = Coordinate::y;
    if (axis_.y == 0 && axis_.z == 0) coordinate_ = Coordinate::x;
  }

 private:
  enum class Coordinate { x, y, z, none };

  double constant_;
  Vec3<double> axis_;
  Coordinate coordinate_ = Coordinate::none;
};

}  // namespace cayspin::inline v0_2::detail
