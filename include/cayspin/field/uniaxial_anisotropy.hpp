// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

#include <cmath>
#include <stdexcept>

namespace cayspin {

/// `axis` divided by its length; throws std::invalid_argument when it has none.
inline Vec3<double> normalized(Vec3<double> const& axis, char const* what) {
  double const length = std::hypot(axis.x, axis.y, axis.z);
  if (!(length > 0) || !std::isfinite(length))
    throw std::invalid_argument(std::string(what) + " must be finite and not zero");
  return {axis.x / length, axis.y / length, axis.z / length};
}

/// The components of v as values of a kernel.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> as_value(Vec3<double> const& v) {
  using Scalar = detail::scalar_t<Value>;
  return {Value(static_cast<Scalar>(v.x)), Value(static_cast<Scalar>(v.y)),
          Value(static_cast<Scalar>(v.z))};
}

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
    return Value(constant<Value>(1) * dot(stencil.center(), e)) * e;
  }

  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const { return constant_ != 0; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const along = dot(stencil.center(), as_value<Value>(axis_));
    return constant<Value>(-0.5) * along * along;
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value constant(double factor) const {
    return Value(static_cast<detail::scalar_t<Value>>(factor * constant_));
  }

  double constant_;
  Vec3<double> axis_;
};

}  // namespace cayspin
