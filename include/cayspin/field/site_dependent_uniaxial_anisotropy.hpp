// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/field/coefficient.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stencil.hpp>

#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

/// Functor that counts sites whose vector has a length that differs from 1 by more than rounding.
template <class Real>
struct NotUnitOfSites {
  SiteArray<Real, 3> vectors;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* count) const {
    auto const e = site.load(vectors);
    constexpr double tolerance = 8.0 * std::numeric_limits<Real>::epsilon();
    count[0] = select<Value>(Kokkos::abs(Value(dot(e, e) - Value(1.0))) < Value(tolerance),
                             Value(0.0), Value(1.0));
  }
};

/// H = K * (m.e) * e. K and e may each be one value for all sites, or an array.
template <class Constant, class Axis>
struct UniaxialAnisotropyOfSites {
  static constexpr int degree = 2;  // H is linear in the spins
  static constexpr bool is_local = true;
  Constant constant;
  Axis axis;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const e = coefficient<Value>(axis, stencil.site());
    return Value(coefficient<Value>(constant, stencil.site()) * dot(stencil.center(), e)) * e;
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const along = dot(stencil.center(), coefficient<Value>(axis, stencil.site()));
    return Value(-0.5) * coefficient<Value>(constant, stencil.site()) * along * along;
  }
};

}  // namespace detail

/// Uniaxial anisotropy whose constant, axis, or both differ from site to site:
/// H = K_n * (m.e_n) * e_n, E = -K_n * (m.e_n)^2 / 2.
/// Constant is double or a ScalarField, Axis a Vec3<double> or a SiteField of three components;
/// only a field takes memory.
template <class Constant, class Axis>
class SiteDependentUniaxialAnisotropy : public detail::PreparedOnce {
  static constexpr char const* name = "cayspin::SiteDependentUniaxialAnisotropy";

 public:
  static constexpr bool is_local = true;

  /// A single axis is normalised; a field of axes is used as it is. Throws std::invalid_argument
  /// when a constant is not finite, a single axis is zero or not finite, or a field has an axis
  /// whose length is not 1.
  SiteDependentUniaxialAnisotropy(std::type_identity_t<Constant> constant,
                                  std::type_identity_t<Axis> axis)
      : constant_(std::move(constant)), axis_(std::move(axis)) {
    if constexpr (std::is_same_v<Constant, double>) {
      detail::finite(constant_, "cayspin::SiteDependentUniaxialAnisotropy: the constant");
    } else {
      detail::signs_of(constant_, "cayspin::SiteDependentUniaxialAnisotropy: the constant");
    }
    if constexpr (std::is_same_v<Axis, Vec3<double>>) {
      axis_ = normalized(axis_, "cayspin::SiteDependentUniaxialAnisotropy: the axis");
    } else {
      require_unit(axis_);
    }
  }

  template <class Spins>
  void check_spins(Spins const& spins) const {
    detail::require_lattice_of(spins, constant_, name);
    detail::require_lattice_of(spins, axis_, name);
  }

  template <class Exec, class Spins>
  auto prepare(Exec const&, Spins const&, double) const {
    auto const constant = detail::array_of(constant_);
    auto const axis = detail::array_of(axis_);
    return detail::UniaxialAnisotropyOfSites<std::remove_const_t<decltype(constant)>,
                                             std::remove_const_t<decltype(axis)>>{constant, axis};
  }

 private:
  template <class Real, class MemorySpace>
  static void require_unit(SiteField<Real, 3, MemorySpace> const& axes) {
    detail::require_sites("cayspin::SiteDependentUniaxialAnisotropy: the axis", axes.sites());
    using Exec = typename MemorySpace::execution_space;
    detail::fence_all_instances<Exec>("cayspin::SiteDependentUniaxialAnisotropy");
    Exec const exec;
    auto const count = detail::reduce_sites<detail::Sum, 1>(
        exec, "cayspin::SiteDependentUniaxialAnisotropy::axes", axes.layout(),
        detail::NotUnitOfSites<Real>{axes.array()});
    if (count[0] != 0)
      throw std::invalid_argument(std::string(name) +
                                  ": the axis must be of length 1 on every site, and is not on " +
                                  std::to_string(static_cast<std::int64_t>(count[0])));
  }

  Constant constant_;
  Axis axis_;
};

template <class Real, class MemorySpace>
SiteDependentUniaxialAnisotropy(SiteField<Real, 1, MemorySpace>, Vec3<double>)
    -> SiteDependentUniaxialAnisotropy<SiteField<Real, 1, MemorySpace>, Vec3<double>>;
template <class Real, class MemorySpace>
SiteDependentUniaxialAnisotropy(double, SiteField<Real, 3, MemorySpace>)
    -> SiteDependentUniaxialAnisotropy<double, SiteField<Real, 3, MemorySpace>>;
template <class Real, class MemorySpace>
SiteDependentUniaxialAnisotropy(SiteField<Real, 1, MemorySpace>, SiteField<Real, 3, MemorySpace>)
    -> SiteDependentUniaxialAnisotropy<SiteField<Real, 1, MemorySpace>,
                                       SiteField<Real, 3, MemorySpace>>;

}  // namespace cayspin::inline v0_2
