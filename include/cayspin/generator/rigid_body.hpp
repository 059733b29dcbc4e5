// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/coefficient.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <array>
#include <cmath>
#include <stdexcept>
#include <type_traits>

namespace cayspin::inline v0_2 {

/// A symmetric 3 x 3 matrix. Order of the entries: xx, yy, zz, xy, xz, yz.
using SymmetricTensor = std::array<double, 6>;

namespace detail {

template <class Value>
struct SymmetricMatrix {
  Value xx, yy, zz, xy, xz, yz;
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator*(Vec3<Value> const& m) const {
    return {multiply_add(xx, m.x, multiply_add(xy, m.y, Value(xz * m.z))),
            multiply_add(xy, m.x, multiply_add(yy, m.y, Value(yz * m.z))),
            multiply_add(xz, m.x, multiply_add(yz, m.y, Value(zz * m.z)))};
  }
};

/// A = -B m and E = <m, B m> / 2 for rigid bodies; B = I^-1 is
/// Bodies::inverse_inertia<Value>(site).
template <class Bodies>
class BodyGenerator {
 public:
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(-1) * (inverse_inertia(stencil) * stencil.center());
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(0.5) * dot(stencil.center(), inverse_inertia(stencil) * stencil.center());
  }
  bool conserves_energy() const { return true; }

 private:
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto inverse_inertia(Stencil const& stencil) const {
    return static_cast<Bodies const*>(this)->template inverse_inertia<typename Stencil::value_type>(
        stencil.site());
  }
};

template <class Generator>
inline constexpr bool is_body = std::is_base_of_v<BodyGenerator<Generator>, Generator>;

}  // namespace detail

/// Free rigid bodies of equal inertia I. The spin m of a body is its angular momentum in the body
/// frame, of length 1: m' = m x I^-1 m, that is A = -I^-1 m (Lewis and Nigam 2002, Sec. 5, with the
/// sign corrected), and E = <m, I^-1 m> / 2 per body. Each site of a lattice is an independent
/// body; Lattice::chain(count) is enough for `count` bodies. Throws std::invalid_argument for an
/// inverse inertia that is not finite.
class RigidBody : public detail::BodyGenerator<RigidBody> {
 public:
  explicit RigidBody(SymmetricTensor const& inverse_inertia)
      : xx_(inverse_inertia[0]),
        yy_(inverse_inertia[1]),
        zz_(inverse_inertia[2]),
        xy_(inverse_inertia[3]),
        xz_(inverse_inertia[4]),
        yz_(inverse_inertia[5]) {
    for (double const entry : inverse_inertia)
      if (!std::isfinite(entry))
        throw std::invalid_argument("cayspin::RigidBody: the inverse inertia must be finite");
  }

  /// Makes bodies from principal moments of inertia; throws std::invalid_argument if one of them is
  /// zero.
  static RigidBody principal(double i1, double i2, double i3) {
    return RigidBody(SymmetricTensor{1 / i1, 1 / i2, 1 / i3, 0, 0, 0});
  }

  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION detail::SymmetricMatrix<Value> inverse_inertia(Site const&) const {
    return {as_value<Value>(xx_), as_value<Value>(yy_), as_value<Value>(zz_),
            as_value<Value>(xy_), as_value<Value>(xz_), as_value<Value>(yz_)};
  }

 private:
  double xx_, yy_, zz_, xy_, xz_, yz_;
};

namespace detail {

template <class Real, int Components>
struct BodiesOfSites : BodyGenerator<BodiesOfSites<Real, Components>> {
  SiteArray<Real, Components> tensors;

  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION SymmetricMatrix<Value> inverse_inertia(Site const& site) const {
    auto const entry = [&](int component) {
      return component < Components ? site.load(tensors, component) : Value(0);
    };
    return {entry(0), entry(1), entry(2), entry(3), entry(4), entry(5)};
  }
};

}  // namespace detail

/// Free rigid bodies with different inertias I. The field has six numbers per body, I^-1 in the
/// order of SymmetricTensor, or three: the diagonal of an I^-1 that is diagonal in the body frame.
template <class Real, class MemorySpace, int Components = 6>
class RigidBodyEnsemble {
  static_assert(
      Components == 6 || Components == 3,
      "An inverse inertia is a symmetric tensor of 6 components, or the 3 of a diagonal.");
  using Prepared = detail::BodiesOfSites<Real, Components>;

 public:
  using Tensors = SiteField<Real, Components, MemorySpace>;

  /// Throws std::invalid_argument when a number of a body is not finite.
  explicit RigidBodyEnsemble(Tensors inverse_inertia) : tensors_(std::move(inverse_inertia)) {
    detail::require_finite(tensors_, "cayspin::RigidBodyEnsemble: the inverse inertia");
  }

  template <class Spins>
  void check_spins(Spins const& spins) const {
    detail::require_lattice_of(spins, tensors_, "cayspin::RigidBodyEnsemble");
  }

  template <class Exec, class Spins>
  Prepared prepare(Exec const&, Spins const&, double) const {
    return Prepared{{}, tensors_.array()};
  }

  template <class Exec, class Spins>
  bool is_stationary(Exec const&, Spins const&) const {
    return true;
  }
  bool conserves_energy() const { return true; }

 private:
  Tensors tensors_;
};

}  // namespace cayspin::inline v0_2
