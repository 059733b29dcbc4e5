// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

namespace cayspin::inline v0_2 {

/// The torque of a current polarised along the unit vector p, t = a * m x (p x m) - b * m x p. It
/// is written as a field in which precession gives t: H = a * m x p + b * p, which equals m x t up
/// to a multiple of m. With damping, LandauLifshitz turns H into the torque t + damping * m x t.
/// The strengths a (damping-like, turns m towards p) and b (field-like) are fields in reduced
/// units. There is no energy: energy_density is 0, and code that needs an energy refuses the term.
/// Slonczewski 1996.
class Slonczewski {
 public:
  static constexpr bool is_local = true;
  static constexpr bool is_conservative = false;  // H is the derivative of no energy

  struct Torque {
    double damping_like = 0, field_like = 0;  ///< a and b
    Vec3<double> polarization;                ///< p, normalised by the constructor
  };

  ///   Slonczewski({.damping_like = 0.1, .polarization = {0, 0, 1}})
  /// Throws std::invalid_argument when the polarization is zero or a number is not finite.
  explicit Slonczewski(Torque const& torque)
      : damping_like_(
            detail::finite(torque.damping_like, "cayspin::Slonczewski: the damping-like torque") *
            normalized(torque.polarization, "cayspin::Slonczewski: the polarization")),
        field_like_(
            detail::finite(torque.field_like, "cayspin::Slonczewski: the field-like torque") *
            normalized(torque.polarization, "cayspin::Slonczewski: the polarization")) {}

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return damping_like_field(stencil) + as_value<ValueOf<Stencil>>(field_like_);
  }
  /// Returns the part of H that is linear in m: a * m x p.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> damping_like_field(Stencil const& stencil) const {
    return cross(stencil.center(), as_value<ValueOf<Stencil>>(damping_like_));
  }
  bool is_affine() const { return true; }

  /// Returns 0: the term has no energy.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const&) const {
    return ValueOf<Stencil>(0);
  }

 private:
  Vec3<double> damping_like_, field_like_;  // a * p and b * p
};

}  // namespace cayspin::inline v0_2
