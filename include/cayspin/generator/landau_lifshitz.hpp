// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/stencil.hpp>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace cayspin {

/// m' = -m x H - damping m x (m x H), as A x m with A = H + damping m x H; overdamped, without
/// precession, A = damping m x H. Reduced units.
template <class Field>
class LandauLifshitz {
 public:
  /// Throws std::invalid_argument when damping is negative or not finite.
  LandauLifshitz(Field field, double damping, bool precession = true)
      : field_(std::move(field)), damping_(damping), precession_(precession ? 1.0 : 0.0) {
    if (!(damping >= 0) || !std::isfinite(damping))
      throw std::invalid_argument("cayspin::LandauLifshitz: damping must be >= 0 and finite");
  }

  Field const& field() const { return field_; }

  template <class Exec, class Spins>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    auto prepared = detail::prepare_term(field_, exec, spins, t);
    return LandauLifshitz<decltype(prepared)>(std::move(prepared), damping_, precession_ != 0);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    using Scalar = detail::scalar_t<Value>;
    Vec3<Value> const h = field_.field(stencil);
    return multiply_add(Value(static_cast<Scalar>(damping_)), cross(stencil.center(), h),
                        Value(static_cast<Scalar>(precession_)) * h);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    return field_.energy_density(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    return field_.energy_magnitude(stencil);
  }

 private:
  Field field_;
  double damping_, precession_;
};

}  // namespace cayspin
