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
#include <utility>

// The lowest curvature of the energy at a state of rest: the least eigenvalue of the Hessian on the
// tangent planes, P (-dH/dm) P + (H.m). Negative at a saddle. Conjugate gradients on the Rayleigh
// quotient, preconditioned (Knyazev 2001, in two directions at a time).
namespace cayspin::detail {

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

/// Memory that a search for the lowest curvature works in.
template <class Spins>
struct CurvatureArrays {
  Spins vector, product, direction, its_product, rest, preconditioned, shifted, at_rest, before;
};

struct LowestCurvature {
  double value = std::numeric_limits<double>::infinity();  // at most this
  bool is_negative = false;                                // beyond round-off
  std::int64_t evaluations = 0;
};

/// Ends when the quotient is below -tolerance, or when it is not about to fall below zero.
/// `precondition(from, to)`. Leaves the vector in arrays.vector.
template <class Exec, class Field, class Spins, class Moves, class Precondition>
LowestCurvature find_lowest_curvature(Exec const& exec, Field const& field, double time,
                                      Spins const& spins, Moves const& moves, double tolerance,
                                      CurvatureArrays<Spins> const& arrays,
                                      Precondition const& precondition) {
  using Real = typename Spins::value_type;
  constexpr int most_steps = 40;
  LowestCurvature found;
  Spins const &x = arrays.vector, &hx = arrays.product, &d = arrays.direction,
              &hd = arrays.its_product, &r = arrays.rest, &w = arrays.preconditioned,
              &shifted = arrays.shifted, &at_rest = arrays.at_rest, &before = arrays.before;

  evaluate_field(exec, field, spins, time, at_rest);
  ++found.evaluations;
  // v.Hv and v.v
  auto const product = [&](Spins const& v, Spins const& hv) {
    using Prepared = decltype(prepare_term(field, exec, shifted, time));
    using AtSite = Stencil<Site<Pack<double>>, Real>;
    constexpr bool affine = is_affine<Prepared, AtSite>;
    combine(exec, 0, v, 0, v, shifted);
    double const shift = (affine ? 0.5 : 0.02) / largest_difference(exec, v, shifted);
    if constexpr (!affine) {
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
  auto const scale = [&](double factor, Spins const& v) { combine(exec, factor, v, 0, v, v); };

  auto const& shape = spins.lattice().shape;
  for_each_site<Real>(exec, "cayspin::minimize::random_signs", spins.layout(),
                      RandomSigns<Real>{shape[0], shape[1], r.output(false)});
  keep_tangent(r);
  precondition(r, x);
  keep_tangent(x);
  double const size = length(exec, x);
  if (!(size > 0)) return found;
  scale(1 / size, x);
  found.value = product(x, hx)[0];
  double old_decrease = 0;
  for (int step = 0; step < most_steps; ++step) {
    if (found.value < -tolerance) {
      // Once more from the field: round-off of the steps so far is left behind.
      auto const [along, square] = product(x, hx);
      found.value = along / square;
      found.is_negative = found.value < -tolerance;
      if (found.is_negative) break;
    }
    // w, preconditioned, of the residual r; and r.w, by which the quotient is about to fall.
    double const r_old_w = [&] {
      combine(exec, 1, hx, -found.value, x, shifted);
      precondition(shifted, w);
      keep_tangent(w);
      combine(exec, -inner_product(exec, w, x), x, 1, w, w);
      return step == 0 ? 0.0 : inner_product(exec, r, w);
    }();
    combine(exec, 1, shifted, 0, shifted, r);
    double const decrease = inner_product(exec, r, w);
    if (!(decrease > 0.01 * std::abs(found.value)) || decrease < tolerance) break;
    double const beta = step == 0 ? 0 : std::max(0.0, (decrease - r_old_w) / old_decrease);
    old_decrease = decrease;
    if (beta == 0)
      combine(exec, -1, w, 0, w, d);
    else
      combine(exec, -1, w, beta, d, d);
    combine(exec, -inner_product(exec, d, x), x, 1, d, d);
    double const d_size = length(exec, d);
    if (!(d_size > 0)) break;
    scale(1 / d_size, d);
    // The lower of the two quotients on the plane of x and d.
    double const d_value = product(d, hd)[0], mixed = inner_product(exec, x, hd);
    double const mean = 0.5 * (found.value + d_value), half = 0.5 * (found.value - d_value);
    double const lower = mean - std::hypot(half, mixed);
    if (mixed == 0 || !std::isfinite(lower)) break;
    double const ratio = (lower - found.value) / mixed, norm = std::hypot(1.0, ratio);
    combine(exec, 1 / norm, x, ratio / norm, d, x);
    combine(exec, 1 / norm, hx, ratio / norm, hd, hx);
    found.value = lower;
  }
  return found;
}

}  // namespace cayspin::detail
