// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/unrolled.hpp>
#include <cayspin/minimizer/trial.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

// The latest steps s of all images of a path, and the changes y in their gradients, without the
// gradients' parts along the path. From these, L-BFGS computes the next steps of all images
// together. Before s and y are used, their parts along the current path and normal to the current
// tangent planes are removed. The passes over the sites compute inner products; the recursion needs
// nothing else.
namespace cayspin::inline v0_2::detail {

inline constexpr std::size_t path_pairs = 4;

template <class Real>
using ArraysOfPath = Kokkos::Array<SiteArray<Real, 3>, path_pairs>;

/// Functor that computes the gradient g without its part along the path, and its change since the
/// last step.
template <class Real>
struct GradientAcross {
  SiteArray<Real, 3> gradient, direction, across, step, change;
  double along;  // g.t / t.t

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> const t = site.load(direction);
    Vec3<Value> const g = multiply_add(Value(-along), t, Vec3<Value>(site.load(gradient)));
    Vec3<Value> const y = g - Vec3<Value>(site.load(across)), s = site.load(step);
    values[0] = dot(s, s);
    values[1] = dot(y, y);
    values[2] = dot(g, g);
    store_narrowed(g, site, across);
    store_narrowed(y, site, change);
  }
};

/// Functor that computes s_i.g, t.s_i, t.y_i and s_i.y_j for i <= j, of one image.
template <class Real>
struct ProductsOfPath {
  static constexpr int pairs = static_cast<int>(path_pairs);
  enum {
    with_gradient = 0,
    step_along = pairs,
    change_along = 2 * pairs,
    with_changes = 3 * pairs
  };
  static constexpr int values = with_changes + pairs * (pairs + 1) / 2;
  template <class Index>
  KOKKOS_FORCEINLINE_FUNCTION static constexpr Index of(Index i, Index j) {
    return static_cast<Index>(with_changes) + j * (j + 1) / 2 + i;
  }

  SiteArray<Real, 3> spins, across, direction;
  ArraysOfPath<Real> steps, changes;
  int count;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* sums) const {
    Vec3<Value> const m = site.load(spins), g = site.load(across), t = site.load(direction);
    for (int i = 0; i < values; ++i) sums[i] = Value(0.0);
    unrolled<pairs>([&](auto j) {
      if (j() >= count) return;
      Vec3<Value> const step = site.load(steps[j()]),
                        change = tangent(m, Vec3<Value>(site.load(changes[j()])));
      sums[with_gradient + j()] = dot(step, g);
      sums[step_along + j()] = dot(step, t);
      sums[change_along + j()] = dot(change, t);
      unrolled<j() + 1>(
          [&](auto i) { sums[of(i(), j())] = dot(Vec3<Value>(site.load(steps[i()])), change); });
    });
  }
};

/// Functor that computes the tangent part of factor * v + along * t + sum(weights_i * others_i).
template <class Real>
struct SumOfPath {
  SiteArray<Real, 3> spins, vectors, direction;
  ArraysOfPath<Real> others;
  Kokkos::Array<Real, path_pairs> weights;
  Real factor, along;
  int count;
  OutputArray<Real, 3> to;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> sum = Value(factor) * Vec3<Value>(site.load(vectors));
    for (int i = 0; i < count; ++i)
      sum = multiply_add(Value(weights[i]), Vec3<Value>(site.load(others[i])), sum);
    sum = multiply_add(Value(along), Vec3<Value>(site.load(direction)), sum);
    site.store(tangent(Vec3<Value>(site.load(spins)), sum), to);
  }
};

/// Functor that computes y_i.z, and then t.z, where z is the tangent part of `vectors`.
template <class Real>
struct ChangesAlong {
  static constexpr int pairs = static_cast<int>(path_pairs), values = pairs + 1;
  SiteArray<Real, 3> spins, vectors, direction;
  ArraysOfPath<Real> changes;
  int count;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* sums) const {
    Vec3<Value> const z = tangent(Vec3<Value>(site.load(spins)), Vec3<Value>(site.load(vectors)));
    for (int i = 0; i < pairs; ++i)
      sums[i] = i < count ? dot(Vec3<Value>(site.load(changes[i])), z) : Value(0.0);
    sums[pairs] = dot(z, Vec3<Value>(site.load(direction)));
  }
};

/// Coefficients of the L-BFGS recursion (Nocedal and Wright 2006, Alg. 7.4), for the pairs of all
/// images together.
class Recursion {
 public:
  static constexpr std::size_t pairs = path_pairs;
  using Numbers = std::array<double, pairs>;

  /// Computes alpha. `product(i, j)`: s_i.y_j for i <= j < count; `along[i]`: s_i.g. Pairs for
  /// which use[i] is false are left out.
  template <class Product>
  void begin(std::size_t count, std::array<bool, pairs> const& use, Numbers const& along,
             Product const& product) {
    alpha = {}, weights = {};
    for (std::size_t i = count; i-- > 0;) {
      if (!use[i]) continue;
      double sum = along[i];
      for (std::size_t j = i + 1; j < count; ++j) sum -= alpha[j] * product(i, j);
      alpha[i] = sum / product(i, i);
    }
  }
  /// Computes weights. `along[i]`: y_i.z, with z from the preconditioner.
  template <class Product>
  void end(std::size_t count, std::array<bool, pairs> const& use, Numbers const& along,
           Product const& product) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!use[i]) continue;
      double beta = along[i];
      for (std::size_t j = 0; j < i; ++j) beta += weights[j] * product(j, i);
      weights[i] = alpha[i] - beta / product(i, i);
    }
  }

  Numbers alpha{}, weights{};  // coefficients of the y, and of the s
};

}  // namespace cayspin::inline v0_2::detail
