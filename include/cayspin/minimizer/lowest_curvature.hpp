// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/probe.hpp>
#include <cayspin/stepper/field_algebra.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

// Lowest curvature of the energy at an equilibrium: the least eigenvalue of the Hessian, negative
// at a saddle. It is computed by the locally optimal preconditioned conjugate gradients of Knyazev
// (2001).
namespace cayspin::inline v0_2::detail {

/// Least eigenvalue of a symmetric matrix, and its eigenvector, by Jacobi rotations.
struct LowestOfThree {
  double value, vector[3];

  explicit LowestOfThree(double (&a)[3][3]) {
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 30; ++sweep)
      for (auto const& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
        if (a[p][q] == 0) continue;
        double const ratio = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
        double const t = std::copysign(1, ratio) / (std::abs(ratio) + std::hypot(1.0, ratio));
        double const c = 1 / std::hypot(1.0, t), s = c * t;
        auto const rotate = [&](double& x, double& y) {
          double const old = x;
          x = c * old - s * y;
          y = s * old + c * y;
        };
        for (int i = 0; i < 3; ++i) rotate(a[i][p], a[i][q]);
        for (int i = 0; i < 3; ++i) rotate(a[p][i], a[q][i]);
        for (int i = 0; i < 3; ++i) rotate(v[i][p], v[i][q]);
        a[p][q] = a[q][p] = 0;
      }
    int least = 0;
    for (int i = 1; i < 3; ++i)
      if (a[i][i] < a[least][least]) least = i;
    value = a[least][least];
    for (int i = 0; i < 3; ++i) vector[i] = v[i][least];
  }
};

/// Functor that finds max |factor * r|^2 / (|x|^2 / 4 + least) over the sites, for r = `residual`
/// and x = `vectors`.
template <class Real>
struct LargestRatio {
  SiteArray<Real, 3> residual, vectors;
  double factor, least;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> const r = Value(factor) * Vec3<Value>(site.load(residual)), x = site.load(vectors);
    values[0] = dot(r, r) / multiply_add(Value(0.25), dot(x, x), Value(least));
  }
};

/// Work memory for a search for the lowest curvature.
template <class Spins>
struct CurvatureArrays {
  Spins vector, product, residual, its_product, direction, direction_product;
};

struct LowestCurvature {
  double value = std::numeric_limits<double>::infinity();  // upper bound
  bool is_negative = false;                                // below -tolerance
  bool is_stopped = false;
};

struct CurvatureSearch {
  double scale;      // strength of fields other than exchange
  double tolerance;  // curvatures above -tolerance count as not negative
  /// Bound on the error of a curvature that is not below -tolerance. Infinity: only its sign is
  /// found.
  double error;
  std::int64_t stream;                  // of the random start vector
  bool has_start = false;               // arrays.vector holds the start
  int most_steps = 1000;                // if the error is not infinite
  std::function<bool()> proceeds = {};  // called after each step; returns false to stop
};

/// Returns the lowest curvature found. Stops once the Rayleigh quotient is below -tolerance.
/// Otherwise stops once its error is below search.error; if that is infinite, once the quotient is
/// unlikely to fall below zero. Takes at most search.most_steps steps, or 40 if search.error is
/// infinite. Each saddle needs a new random stream: a start that led out of one saddle can be
/// orthogonal to the descent from the next. Calls `precondition(from, to)`. Leaves the vector in
/// arrays.vector.
template <class AnyHessian, class Exec, class Spins, class Precondition>
LowestCurvature find_lowest_curvature(AnyHessian& hessian, Exec const& exec,
                                      CurvatureArrays<Spins> const& arrays,
                                      CurvatureSearch const& search,
                                      Precondition const& precondition) {
  using Real = typename Spins::value_type;
  bool const is_exact = std::isfinite(search.error);
  int const most_steps = is_exact ? search.most_steps : 40;
  auto const& [scale, tolerance, error, stream, has_start, most, proceeds] = search;
  LowestCurvature found;
  Spins const &x = arrays.vector, &hx = arrays.product, &w = arrays.residual,
              &hw = arrays.its_product, &p = arrays.direction, &hp = arrays.direction_product;
  auto const multiply = [&](double factor, Spins const& v) { combine(exec, factor, v, 0, v, v); };
  // Makes v of length 1 and normal to x and, if `to_p`, also to p. Returns false if little but
  // round-off is left.
  auto const make_normal = [&](Spins const& v, bool to_p) {
    for (int round = 0; round < 2; ++round) {
      double const before = length(exec, v);
      combine(exec, -inner_product(exec, v, x), x, 1, v, v);
      if (to_p) combine(exec, -inner_product(exec, v, p), p, 1, v, v);
      hessian.keep_tangent(v);
      double const after = length(exec, v);
      if (!(after > 1e3 * std::numeric_limits<Real>::epsilon() * before)) return false;
      multiply(1 / after, v);
    }
    return true;
  };

  if (!has_start) {
    auto const& shape = x.lattice().shape;
    for_each_site<Real>(exec, "cayspin::minimize::random_signs", x.layout(),
                        RandomSigns<Real>{shape[0], shape[1], stream, 1, w.output(false)});
    hessian.keep_tangent(w);
    precondition(w, x);
  }
  hessian.keep_tangent(x);
  double const size = length(exec, x);
  if (!(size > 0)) return found;
  multiply(1 / size, x);
  found.value = hessian.multiply(x, hx).along;
  for (int step = 0;; ++step) {
    if (found.value < -tolerance) {
      // Recomputes the quotient from the field, without the round-off of the steps before.
      auto const [along, square] = hessian.multiply(x, hx);
      found.value = along / square;
      found.is_negative = found.value < -tolerance;
      if (found.is_negative) break;
    }
    if (step == most_steps) break;
    if (step > 0 && proceeds && !proceeds()) {
      found.is_stopped = true;
      break;
    }
    // Computes w, the preconditioned residual, and an estimate of how much it will lower the
    // quotient.
    combine(exec, 1, hx, -found.value, x, hw);
    double const rest = length(exec, hw);
    precondition(hw, w);
    hessian.keep_tangent(w);
    combine(exec, -inner_product(exec, w, x), x, 1, w, w);
    double const decrease = inner_product(exec, hw, w);
    // An eigenvalue is within `rest` of the quotient, but it need not be the lowest one. Near an
    // instability a lower one may be negative, so a small quotient does not count as positive.
    bool const is_positive =
        found.value > 1e-2 * scale && rest < 0.3 * found.value && decrease < 0.01 * found.value;
    bool const is_exactly_positive = found.value > 10 * tolerance && rest < 1e-3 * found.value;
    // A descent on a few sites of many adds little to these sums. But there the residual is at
    // least the quotient times the vector, however small the curvature of the descent is. Sites
    // where the vector almost vanishes do not count: it may have nodes.
    auto const is_positive_everywhere = [&] {
      double const least = std::pow(1e-2 * largest_length(exec, x), 2);
      auto const ratio = reduce_sites<Maximum, 1>(
          exec, "cayspin::minimize::largest_ratio", x.layout(),
          LargestRatio<Real>{hw.array(), x.array(), 1 / found.value, least});
      return ratio[0] < 1;
    };
    bool const is_clear =
        is_exact ? rest < error
                 : rest < 0.1 * tolerance ||
                       ((is_positive || is_exactly_positive) && is_positive_everywhere());
    if (!(decrease > 0) || is_clear) break;
    bool const has_p = step > 0;
    if (!make_normal(w, has_p)) break;
    double of_pairs[3][3] = {{found.value}};  // u.Hv for u, v among x, w and the last step p
    auto const set = [&](int i, int j, double value) { of_pairs[i][j] = of_pairs[j][i] = value; };
    set(1, 1, hessian.multiply(w, hw).along);
    set(0, 1, inner_product(exec, x, hw));
    if (has_p) {
      set(0, 2, inner_product(exec, x, hp));
      set(1, 2, inner_product(exec, w, hp));
      set(2, 2, inner_product(exec, p, hp));
    } else {
      set(2, 2, std::numeric_limits<double>::infinity());
    }
    LowestOfThree const lowest(of_pairs);
    auto const [of_x, of_w, of_p] = lowest.vector;
    double const sideways = std::hypot(of_w, of_p);
    if (!std::isfinite(lowest.value) || !(sideways > 0)) break;
    // Sets x to of_x * x + of_w * w + of_p * p, and makes p normal to the new x.
    for (auto const& [x_or_hx, w_or_hw, p_or_hp] : {std::tie(x, w, p), std::tie(hx, hw, hp)}) {
      if (has_p)
        combine(exec, of_w, w_or_hw, of_p, p_or_hp, w_or_hw);
      else
        combine(exec, of_w, w_or_hw, 0, w_or_hw, w_or_hw);
      combine(exec, -sideways, x_or_hx, of_x / sideways, w_or_hw, p_or_hp);
      combine(exec, of_x, x_or_hx, 1, w_or_hw, x_or_hx);
    }
    found.value = lowest.value;
  }
  return found;
}

}  // namespace cayspin::inline v0_2::detail
