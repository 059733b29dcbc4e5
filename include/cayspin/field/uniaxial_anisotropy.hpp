// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

namespace cayspin {

/// Uniaxial anisotropy: H = K (m.e) e, E = -K (m.e)^2 / 2 per site. The axis e is normalised.
class UniaxialAnisotropy {
 public:
  static constexpr int degree = 2;  // H is linear in the spins
  static constexpr bool is_local = true;

  UniaxialAnisotropy(double constant, Vec3<double> const& axis)
      : constant_(constant), axis_(normalized(axis, "cayspin::UniaxialAnisotropy: the axis")) {}

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const e = as_value<Value>(axis_);
    return Value(as_value<Value>(constant_) * dot(stencil.center(), e)) * e;
  }

  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const { return constant_ != 0; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const along = dot(stencil.center(), as_value<Value>(axis_));
    return as_value<Value>(-0.5 * constant_) * along * along;
  }

 private:
  double constant_;
  Vec3<double> axis_;
};

}  // namespace cayspin
