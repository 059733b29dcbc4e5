// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

// Terms of random compositions that the library does not have.
namespace cayspin::simulation::test {

using Space = Kokkos::DefaultHostExecutionSpace;
using Memory = Space::memory_space;

template <class Term>
using Prepared = decltype(cayspin::detail::prepare_term(
    std::declval<Term const&>(), Space(), std::declval<SpinField<double, Memory> const&>(), 0.0));

/// Returns a field with the values `numbers`, or with `otherwise` at every site if `numbers` is
/// empty.
inline ScalarField<double, Memory> field_of_sites(Lattice const& lattice,
                                                  std::vector<double> numbers, double otherwise) {
  if (numbers.empty()) numbers.assign(static_cast<std::size_t>(lattice.sites()), otherwise);
  ScalarField<double, Memory> field("numbers", lattice);
  copy_from_host(numbers, field);
  return field;
}

/// H = moment * (applied + source * cos(3 * t)), E = -m.H. Moments, and sources along x, depend on
/// the site; the source along y is uniform.
struct SiteDependentApplied {
  ScalarField<double, Memory> moments, along_x;
  Vec3<double> applied;
  double along_y;

  struct Now {
    static constexpr int degree = 1;
    SiteArray<double, 1> moments, along_x;
    Vec3<double> applied;
    double along_y, factor;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      Value const x = Value(applied.x) + Value(factor) * stencil.site().load(along_x);
      return stencil.site().load(moments) *
             Vec3<Value>{x, Value(applied.y + factor * along_y), Value(applied.z)};
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
        Stencil const& stencil) const {
      return typename Stencil::value_type(-1.0) * dot(stencil.center(), field(stencil));
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const&, Spins const&, double t) const {
    return {moments.array(), along_x.array(), applied, along_y, std::cos(3 * t)};
  }
};

/// A slab's demagnetising field, H = -strength * (m.n) * n, E = strength * (m.n)^2 / 2, both
/// multiplied by a number of the site. The normal n is a unit vector.
struct SlabOfSites {
  ScalarField<double, Memory> numbers;
  Vec3<double> normal;
  double strength;

  struct Now {
    SiteArray<double, 1> numbers;
    Vec3<double> normal;
    double strength;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type along(Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      auto const& m = stencil.center();
      return Value(normal.x) * m.x + Value(normal.y) * m.y + Value(normal.z) * m.z;
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      Value const part = Value(-strength) * stencil.site().load(numbers) * along(stencil);
      return {part * Value(normal.x), part * Value(normal.y), part * Value(normal.z)};
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
        Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      Value const part = along(stencil);
      return Value(0.5 * strength) * stencil.site().load(numbers) * part * part;
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const&, Spins const&, double) const {
    return {numbers.array(), normal, strength};
  }
};

/// Slonczewski's field with a damping-like strength that is a site-dependent number * cos(2 * t),
/// a constant field-like strength, and p along (along_x, 0.6, 0.8).
struct SiteDependentSlonczewski {
  ScalarField<double, Memory> damping_like, along_x;
  double field_like, lambda;

  struct Now {
    static constexpr bool is_conservative = false;
    SiteArray<double, 1> damping_like, along_x;
    double field_like, lambda, factor;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      auto const& m = stencil.center();
      Vec3<Value> p{stencil.site().load(along_x), Value(0.6), Value(0.8)};
      p = Value(Value(1.0) / Kokkos::sqrt(dot(p, p))) * p;
      Value const cosine = dot(m, p), square(lambda * lambda), one(1.0);
      Value const efficiency = Value(2.0) * square / ((one + cosine) * square + (one - cosine));
      Value const a = Value(factor) * stencil.site().load(damping_like) * efficiency;
      return a * cross(m, p) + Value(field_like) * p;
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(Stencil const&) const {
      return typename Stencil::value_type(0.0);
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const&, Spins const&, double t) const {
    return {damping_like.array(), along_x.array(), field_like, lambda, std::cos(2 * t)};
  }
};

/// Multiplies H of a field by site-dependent numbers; E is the field's own.
template <class Field>
struct ScaledBySite {
  Field inner;
  ScalarField<double, Memory> numbers;

  struct Now {
    Prepared<Field> inner;
    SiteArray<double, 1> numbers;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      return stencil.site().load(numbers) * inner.field(stencil);
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
        Stencil const& stencil) const {
      return inner.energy_density(stencil);
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const& exec, Spins const& spins, double t) const {
    return {cayspin::detail::prepare_term(inner, exec, spins, t), numbers.array()};
  }
};

/// The term of the cubic anisotropy with constant2, and the hexagonal anisotropy, as polynomials.
/// The crystal axes are along x, y and z.
struct CrystalByPolynomials {
  double cubic2, hexagonal;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& [x, y, z] = stencil.center();
    Value const a = x * x, b = y * y, c = z * z, two(-2 * cubic2), six(-6 * hexagonal);
    // The derivatives of Re((y - i * x)^6) along x and y, divided by 6.
    Value const along_x = x * (Value(10.0) * a * b - Value(5.0) * b * b - a * a),
                along_y = y * (b * b - Value(10.0) * a * b + Value(5.0) * a * a);
    return {two * x * b * c + six * along_x, two * y * c * a + six * along_y, two * z * a * b};
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& [x, y, z] = stencil.center();
    Value const a = x * x, b = y * y, c = z * z;
    return Value(cubic2) * a * b * c + Value(hexagonal) * (b * b * b - Value(15.0) * b * b * a +
                                                           Value(15.0) * b * a * a - a * a * a);
  }
};

/// Multiplies H and E of a field by 1 + part * sin(5 * t).
template <class Field>
struct ChangesInTime {
  Field inner;
  double part;

  struct Now {
    Prepared<Field> inner;
    double factor;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      return as_value<typename Stencil::value_type>(factor) * inner.field(stencil);
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
        Stencil const& stencil) const {
      return as_value<typename Stencil::value_type>(factor) * inner.energy_density(stencil);
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const& exec, Spins const& spins, double t) const {
    return {cayspin::detail::prepare_term(inner, exec, spins, t), 1 + part * std::sin(5 * t)};
  }
};

}  // namespace cayspin::simulation::test
