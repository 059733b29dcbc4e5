// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/spin_field.hpp>

#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

// A coefficient of a term: one number for all sites, or a field of numbers.
namespace cayspin::inline v0_2::detail {

/// Returns a coefficient in the form that kernels use.
inline double array_of(double number) { return number; }
inline Vec3<double> array_of(Vec3<double> const& vector) { return vector; }
template <class Real, int Components, class MemorySpace>
SiteArray<Real, Components> array_of(SiteField<Real, Components, MemorySpace> const& field) {
  return field.array();
}

/// Returns a coefficient at a site, as a kernel's value type.
template <class Value, class Site>
KOKKOS_FORCEINLINE_FUNCTION Value coefficient(double number, Site const&) {
  return as_value<Value>(number);
}
template <class Value, class Site>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> coefficient(Vec3<double> const& vector, Site const&) {
  return as_value<Value>(vector);
}
template <class Value, class Site, class Real>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> coefficient(SiteArray<Real, 3> const& vectors,
                                                    Site const& site) {
  return site.load(vectors);
}
template <class Value, class Site, class Real>
KOKKOS_FORCEINLINE_FUNCTION Value coefficient(SiteArray<Real, 1> const& numbers, Site const& site) {
  return site.load(numbers);
}

/// Kernels address a coefficient like the spins, by rows whose pitch depends on the type of the
/// numbers. So the coefficients and the spins must have the same type.
template <class Spins, class Real, int Components, class MemorySpace>
constexpr void require_type_of(SiteField<Real, Components, MemorySpace> const&) {
  static_assert(std::is_same_v<typename Spins::value_type, Real> &&
                    std::is_same_v<typename Spins::memory_space, MemorySpace>,
                "A field of coefficients has the precision and the memory space of the spins.");
}

template <class Spins, class Number>
void require_lattice_of(Spins const&, Number const&, char const*) {}
/// Throws std::invalid_argument when a coefficient belongs to another lattice.
template <class Spins, class Real, int Components, class MemorySpace>
void require_lattice_of(Spins const& spins, SiteField<Real, Components, MemorySpace> const& field,
                        char const* who) {
  require_type_of<Spins>(field);
  require_lattice(who, field.lattice(), spins.lattice());
}

/// Functor that counts four kinds of sites, in this order: those whose number is infinite or NaN,
/// those with a negative number, those with a positive one, and those whose number is 1.
template <class Real>
struct SignsOfSites {
  SiteArray<Real, 1> numbers;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* counts) const {
    Value const number = site.load(numbers), zero(0.0), one(1.0);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    counts[0] = select<Value>(Kokkos::abs(number) < Value(infinity), zero, one);
    counts[1] = select<Value>(number < zero, one, zero);
    counts[2] = select<Value>(zero < number, one, zero);
    counts[3] = select<Value>(number == one, one, zero);
  }
};

struct Signs {
  bool negative, positive;
  bool zero_or_one;  // every number is 0 or 1
};

/// Returns which signs the numbers have, after waiting for the kernel. Throws std::invalid_argument
/// when the field has no sites or a number is not finite.
template <class Real, class MemorySpace>
Signs signs_of(ScalarField<Real, MemorySpace> const& numbers, char const* what) {
  require_sites(what, numbers.sites());
  using Exec = typename MemorySpace::execution_space;
  fence_all_instances<Exec>("cayspin::signs_of");
  Exec const exec;
  auto const count = reduce_sites<Sum, 4>(exec, "cayspin::signs_of", numbers.layout(),
                                          SignsOfSites<Real>{numbers.array()});
  if (count[0] != 0)
    throw std::invalid_argument(std::string(what) + " must be finite on every site");
  return {count[1] != 0, count[2] != 0, count[1] == 0 && count[2] == count[3]};
}

/// Functor that counts the numbers of a site that are infinite or NaN.
template <class Real, int Components>
struct NotFiniteOfSites {
  SiteArray<Real, Components> numbers;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* count) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    count[0] = Value(0.0);
    for (int component = 0; component < Components; ++component) {
      Value const number = site.load(numbers, component);
      count[0] =
          count[0] + select<Value>(Kokkos::abs(number) < Value(infinity), Value(0.0), Value(1.0));
    }
  }
};

/// Throws std::invalid_argument when the field has no sites or a number is not finite, after
/// waiting for the kernel.
template <class Real, int Components, class MemorySpace>
void require_finite(SiteField<Real, Components, MemorySpace> const& field, char const* what) {
  require_sites(what, field.sites());
  using Exec = typename MemorySpace::execution_space;
  fence_all_instances<Exec>("cayspin::require_finite");
  Exec const exec;
  auto const count = reduce_sites<Sum, 1>(exec, "cayspin::require_finite", field.layout(),
                                          NotFiniteOfSites<Real, Components>{field.array()});
  if (count[0] != 0)
    throw std::invalid_argument(std::string(what) + " must be finite on every site");
}

}  // namespace cayspin::inline v0_2::detail
