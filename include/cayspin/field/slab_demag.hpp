// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

namespace cayspin {

/// The demagnetising field of an infinite slab, spin by spin: H = -strength (m.n) n,
/// E = strength (m.n)^2 / 2 per site. The normal n is normalised.
class SlabDemag {
 public:
  static constexpr int degree = 2;  // H is linear in the spins
  static constexpr bool is_local = true;

  explicit SlabDemag(Vec3<double> const& normal, double strength = 1)
      : strength_(strength), normal_(normalized(normal, "cayspin::SlabDemag: the normal")) {}

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const n = as_value<Value>(normal_);
    return Value(as_value<Value>(-strength_) * dot(stencil.center(), n)) * n;
  }

  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const { return strength_ != 0; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const along = dot(stencil.center(), as_value<Value>(normal_));
    return as_value<Value>(0.5 * strength_) * along * along;
  }

 private:
  double strength_;
  Vec3<double> normal_;
};

}  // namespace cayspin
