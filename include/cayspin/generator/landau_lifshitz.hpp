// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/field/coefficient.hpp>
#include <cayspin/field/forwarding.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stencil.hpp>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

/// The Landau-Lifshitz equation m' = -m x H - damping * m x (m x H), written as m' = A x m with
/// A = H + damping * m x H. Without precession (overdamped), A = damping * m x H. In reduced units.
/// Damping is double, or a ScalarField with a number for each site. In Gilbert's form of the
/// equation, A is divided by 1 + damping^2. Rescaling time converts one form into the other if the
/// damping is uniform, but not if it differs between sites.
template <class Field, class Damping = double>
class LandauLifshitz : public Forwarding<LandauLifshitz<Field, Damping>, Field>,
                       public detail::ForwardingEnergy<LandauLifshitz<Field, Damping>, Field> {
 public:
  /// Throws std::invalid_argument when the damping, or that of any site, is negative or not finite.
  LandauLifshitz(Field field, std::type_identity_t<Damping> damping, bool precession = true)
      : field_(std::move(field)), damping_(std::move(damping)), precession_(precession) {
    check(damping_);
  }
  /// Deleted, so that a call with a number in place of the bool `precession` does not compile.
  LandauLifshitz(Field, std::type_identity_t<Damping>, double) = delete;

  KOKKOS_FORCEINLINE_FUNCTION Field const& field() const { return field_; }
  KOKKOS_FORCEINLINE_FUNCTION bool has_precession() const { return precession_; }
  /// Returns false only if the damping is one number for all sites, and 0. If it is a field,
  /// returns true whatever its values are.
  KOKKOS_FORCEINLINE_FUNCTION bool is_damped() const {
    if constexpr (uniform)
      return damping_ != 0;
    else
      return true;
  }
  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION Value damping(Site const& site) const {
    return detail::coefficient<Value>(damping_, site);
  }

  template <class Spins>
  void check_spins(Spins const& spins) const {
    detail::require_lattice_of(spins, damping_, "cayspin::LandauLifshitz");
  }
  // Members that Forwarding calls.
  template <class Make>
  auto with_parts(Make const& make) const {
    auto prepared = make(field_);
    auto damping = detail::array_of(damping_);
    return LandauLifshitz<decltype(prepared), decltype(damping)>(std::move(prepared), damping,
                                                                 precession_);
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(field_);
  }
  KOKKOS_FORCEINLINE_FUNCTION Field const& part() const { return field_; }

  // Members for host loops over rows (detail/row_fields.hpp).
  static constexpr int row_fields = detail::row_fields<Field>;
  template <class Real>
  void begin_row(detail::RowOfSpins<Real> const& row, std::int32_t begin, std::int32_t end,
                 detail::RowFields<Real> const& fields) {
    if constexpr (row_fields > 0) field_.begin_row(row, begin, end, fields);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    return generator(stencil.site(), stencil.center(), field_.field(stencil));
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> turning_part(
      Stencil const& stencil) const {
    return generator(stencil.site(), stencil.center(), detail::turning_field(field_, stencil));
  }

  /// Returns A for a known field H.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> in_field(
      Stencil const& stencil, Vec3<typename Stencil::value_type> const& h) const {
    return generator(stencil.site(), stencil.center(), h);
  }

  /// Returns true if the motion conserves the energy: A = -dE/dm up to a multiple of m. Returns
  /// false for a damping field, even if it is zero on all sites.
  bool conserves_energy() const {
    if constexpr (uniform && detail::is_conservative<Field>)
      return damping_ == 0 && precession_;
    else
      return false;
  }

 private:
  static constexpr bool uniform = std::is_same_v<Damping, double>;

  static void check(double damping) {
    if (!(damping >= 0) || !std::isfinite(damping))
      throw std::invalid_argument("cayspin::LandauLifshitz: damping must be >= 0 and finite");
  }
  template <class Real, class MemorySpace>
  static void check(SiteField<Real, 1, MemorySpace> const& damping) {
    if (detail::signs_of(damping, "cayspin::LandauLifshitz: the damping").negative)
      throw std::invalid_argument("cayspin::LandauLifshitz: damping must be >= 0 on every site");
  }
  template <class Real>
  static void check(SiteArray<Real, 1> const&) {}  // was checked as a SiteField

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> generator(Site const& site, Vec3<Value> const& m,
                                                    Vec3<Value> const& h) const {
    Value const damping = detail::coefficient<Value>(damping_, site);
    if (precession_) [[likely]]
      return multiply_add(damping, cross(m, h), h);
    return damping * cross(m, h);
  }

  Field field_;
  Damping damping_;
  bool precession_;
};

namespace detail {
template <class Generator>
inline constexpr bool is_landau_lifshitz = false;
template <class Field, class Damping>
inline constexpr bool is_landau_lifshitz<LandauLifshitz<Field, Damping>> = true;
}  // namespace detail

template <class Field, class Real, class MemorySpace>
LandauLifshitz(Field, SiteField<Real, 1, MemorySpace>, bool = true)
    -> LandauLifshitz<Field, SiteField<Real, 1, MemorySpace>>;

}  // namespace cayspin::inline v0_2
