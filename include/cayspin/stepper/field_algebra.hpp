// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/spin_field.hpp>

#include <cmath>
#include <string>

// Vector operations on whole fields of three components, for iterative solvers.
namespace cayspin::inline v0_2::detail {

template <class Real>
struct LinearCombination {
  Real a, b;
  SiteArray<Real, 3> x, y;
  OutputArray<Real, 3> to;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    site.store(multiply_add(Value(a), site.load(x), Vec3<Value>(Value(b) * site.load(y))), to);
  }
};

template <class Real>
struct DotOfSites {
  SiteArray<Real, 3> x, y;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    values[0] = dot(site.load(x), site.load(y));
  }
};

template <class Real>
struct LargestDifference {
  SiteArray<Real, 3> x, y;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    auto const d = site.load(x) - site.load(y);
    values[0] =
        Maximum::combine(Kokkos::abs(d.x), Maximum::combine(Kokkos::abs(d.y), Kokkos::abs(d.z)));
  }
};

/// Computes to = a * x + b * y; `to` may be x or y.
template <class Exec, class Spins>
void combine(Exec const& exec, double a, Spins const& x, double b, Spins const& y,
             Spins const& to) {
  using Real = typename Spins::value_type;
  static std::string const label = "cayspin::field_algebra::combine";
  for_each_site<Real>(exec, label, x.layout(),
                      LinearCombination<Real>{static_cast<Real>(a), static_cast<Real>(b), x.array(),
                                              y.array(), to.output(false)});
}

/// Returns the sum of <x, y> over the sites; waits.
template <class Exec, class Spins>
double inner_product(Exec const& exec, Spins const& x, Spins const& y) {
  static std::string const label = "cayspin::field_algebra::inner_product";
  return reduce_sites<Sum, 1>(exec, label, x.layout(),
                              DotOfSites<typename Spins::value_type>{x.array(), y.array()})[0];
}

template <class Exec, class Spins>
double length(Exec const& exec, Spins const& x) {
  return std::sqrt(inner_product(exec, x, x));
}

/// Returns the largest |x - y| of any component, NaN if any component is NaN; waits.
template <class Exec, class Spins>
double largest_difference(Exec const& exec, Spins const& x, Spins const& y) {
  static std::string const label = "cayspin::field_algebra::largest_difference";
  return reduce_sites<Maximum, 1>(
      exec, label, x.layout(),
      LargestDifference<typename Spins::value_type>{x.array(), y.array()})[0];
}

}  // namespace cayspin::inline v0_2::detail
