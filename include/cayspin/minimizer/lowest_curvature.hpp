// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/evaluate.hpp>
#include <cayspin/field/effective_field.hpp>
#include <cayspin/field/field_with_vacancies.hpp>
#include <cayspin/minimizer/probe.hpp>
#include <cayspin/minimizer/trial.hpp>
#include <cayspin/stepper/field_algebra.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

// The lowest curvature of the energy at a state of rest: the least eigenvalue of the Hessian on the
// tangent planes, P (-dH/dm) P + (H.m). Negative at a saddle. The locally optimal preconditioned
// conjugate gradients of Knyazev (2001).
namespace cayspin::inline v0_1::detail {

/// Is H affine in the spins, of a prepared field?
template <class Field, class Stencil>
inline constexpr bool is_affine = [] {
  if constexpr (requires { Field::degree; })
    return Field::degree <= 2;
  else
    return has_linear_field<Field, Stencil>;
}();
template <class... Terms, class Stencil>
inline constexpr bool is_affine<EffectiveField<Terms...>, Stencil> =
    (is_affine<Terms, Stencil> && ...);
template <class Field, class Real, class Stencil>
inline constexpr bool is_affine<FieldAmongVacancies<Field, Real>, Stencil> =
    is_affine<Field, Stencil>;

/// v <- the part of it along which spins move
template <class Real>
struct KeepTangent {
  SiteArray<Real, 3> spins, vectors;
  SiteArray<Real, 1> moves;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    site.store(Value(site.load(moves)) *
                   tangent(Vec3<Value>(site.load(spins)), Vec3<Value>(site.load(vectors))),
               output);
  }
};

/// The Hessian times v from the change of the field between two sets of spins, m + shift v and
/// those that `before` is the field of. Sums v.product and v.v.
template <class Field, class Real>
struct HessianProduct {
  Field field;
  SiteArray<Real, 3> spins, vectors, shifted, before, at_rest;
  SiteArray<Real, 1> moves;
  double inverse_shift;
  SiteArray<Real, 3> product;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, shifted);
    Vec3<Value> const m = site.load(spins), v = site.load(vectors);
    Vec3<Value> const change = field.field(stencil) - Vec3<Value>(site.load(before));
    Value const along = dot(m, Vec3<Value>(site.load(at_rest)));
    Vec3<Value> const p =
        Value(site.load(moves)) *
        tangent(m, multiply_add(along, v, Vec3<Value>(Value(-inverse_shift) * change)));
    values[0] = dot(v, p);
    values[1] = dot(v, v);
    store_narrowed(p, site, product);
  }
};

/// The least eigenvalue of a symmetric matrix, and its eigenvector: by Jacobi's rotations.
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

/// Memory that a search for the lowest curvature works in.
template <class Spins>
struct CurvatureArrays {
  Spins vector, product, residual, its_product, direction, direction_product;
  Spins shifted, at_rest, before;
};

struct LowestCurvature {
  double value = std::numeric_limits<double>::infinity();  // at most this
  bool is_negative = false;                                // beyond round-off
  std::int64_t evaluations = 0;
};

/// Ends when the quotient is below -tolerance, or when it is not about to fall below zero. `scale`:
/// of fields other than exchange. `stream`: of the random vector it starts from; one that led out
/// of a saddle is blind to what lies across it.
/// `precondition(from, to)`. Leaves the vector in arrays.vector.
template <class Exec, class Field, class Spins, class Moves, class Precondition>
LowestCurvature find_lowest_curvature(Exec const& exec, Field const& field, double time,
                                      Spins const& spins, Moves const& moves, double scale,
                                      double tolerance, std::int64_t stream,
                                      CurvatureArrays<Spins> const& arrays,
                                      Precondition const& precondition) {
  using Real = typename Spins::value_type;
  constexpr int most_steps = 40;
  LowestCurvature found;
  Spins const &x = arrays.vector, &hx = arrays.product, &w = arrays.residual,
              &hw = arrays.its_product, &p = arrays.direction, &hp = arrays.direction_product,
              &shifted = arrays.shifted, &at_rest = arrays.at_rest, &before = arrays.before;

  evaluate_field(exec, field, spins, time, at_rest);
  ++found.evaluations;
  bool affine = is_affine<decltype(prepare_term(field, exec, spins, time)),
                          Stencil<Site<Pack<double>>, Real>>;
  affine = affine && has_affine_field(field);
  // v.Hv and v.v
  auto const product = [&](Spins const& v, Spins const& hv) {
    combine(exec, 0, v, 0, v, shifted);
    double const shift = (affine ? 0.5 : 0.02) / largest_difference(exec, v, shifted);
    if (!affine) {
      combine(exec, -shift, v, 1, spins, shifted);
      evaluate_field(exec, field, shifted, time, before);
      ++found.evaluations;
    }
    combine(exec, shift, v, 1, spins, shifted);
    auto prepared = prepare_term(field, exec, shifted, time);
    ++found.evaluations;
    auto const& from = affine ? at_rest : before;
    return reduce_sites<Sum, 2>(
        exec, "cayspin::minimize::hessian_product", spins.layout(),
        HessianProduct<decltype(prepared), Real>{
            std::move(prepared), spins.array(), v.array(), shifted.array(), from.array(),
            at_rest.array(), moves.array(), 1 / (affine ? shift : 2 * shift), hv.array()});
  };
  auto const keep_tangent = [&](Spins const& v) {
    for_each_site<Real>(
        exec, "cayspin::minimize::keep_tangent", spins.layout(),
        KeepTangent<Real>{spins.array(), v.array(), moves.array(), v.output(false)});
  };
  auto const multiply = [&](double factor, Spins const& v) { combine(exec, factor, v, 0, v, v); };

  auto const& shape = spins.lattice().shape;
  for_each_site<Real>(exec, "cayspin::minimize::random_signs", spins.layout(),
                      RandomSigns<Real>{shape[0], shape[1], stream, 1, w.output(false)});
  keep_tangent(w);
  precondition(w, x);
  keep_tangent(x);
  double const size = length(exec, x);
  if (!(size > 0)) return found;
  multiply(1 / size, x);
  found.value = product(x, hx)[0];
  for (int step = 0;; ++step) {
    if (found.value < -tolerance) {
      // Once more from the field: round-off of the steps so far is left behind.
      auto const [along, square] = product(x, hx);
      found.value = along / square;
      found.is_negative = found.value < -tolerance;
      if (found.is_negative) break;
    }
    if (step == most_steps) break;
    // w, the preconditioned residual; and by how much it is about to lower the quotient.
    combine(exec, 1, hx, -found.value, x, shifted);
    precondition(shifted, w);
    keep_tangent(w);
    combine(exec, -inner_product(exec, w, x), x, 1, w, w);
    double const decrease = inner_product(exec, shifted, w), rest = length(exec, shifted);
    // An eigenvalue is within `rest` of the quotient. Near an instability several may be close.
    bool const is_positive = found.value > 1e-2 * scale && rest < 0.3 * found.value;
    if (!(decrease > 0) || rest < 0.1 * tolerance || (is_positive && decrease < 0.01 * found.value))
      break;
    if (step > 0) combine(exec, -inner_product(exec, w, p), p, 1, w, w);
    double const w_size = length(exec, w);
    if (!(w_size > 0)) break;
    multiply(1 / w_size, w);
    double of_pairs[3][3] = {{found.value}};  // v.Hv of x, w and p, the step before
    auto const set = [&](int i, int j, double value) { of_pairs[i][j] = of_pairs[j][i] = value; };
    set(1, 1, product(w, hw)[0]);
    set(0, 1, inner_product(exec, x, hw));
    if (step > 0) {
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
    // x <- of_x x + (of_w w + of_p p), and p normal to that.
    for (auto const& [x_or_hx, w_or_hw, p_or_hp] : {std::tie(x, w, p), std::tie(hx, hw, hp)}) {
      if (step > 0)
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

}  // namespace cayspin::inline v0_1::detail
