// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/evaluate.hpp>
#include <cayspin/field/effective_field.hpp>
#include <cayspin/field/field_with_vacancies.hpp>
#include <cayspin/minimizer/trial.hpp>
#include <cayspin/stepper/field_algebra.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

// Hessian of the energy on the tangent planes of mobile spins, P * (-dH/dm) * P + H.m, where P
// projects onto these planes. The product of the Hessian with a tangent vector comes from the field
// at shifted spins: the spins plus a multiple of the vector. Tangent vectors are 0 at immobile
// spins, which include the zero vectors of vacant sites. So immobile spins never change.
namespace cayspin::inline v0_2::detail {

/// Functor that writes the tangent part of `vectors` on mobile sites, and 0 on the others.
template <class Real>
struct KeepTangent {
  SiteArray<Real, 3> spins, vectors;
  SiteArray<Real, 1> is_mobile;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    site.store(Value(site.load(is_mobile)) *
                   tangent(Vec3<Value>(site.load(spins)), Vec3<Value>(site.load(vectors))),
               output);
  }
};

/// Functor that computes `product`, the Hessian times v = `vectors`. `at_rest`: the field at the
/// spins. `shifted`: the spins plus a multiple of v. `before`: the field at spins from which
/// `shifted` differs by v / inverse_shift. Sums v.product and v.v.
template <class Field, class Real>
struct HessianProduct {
  Field field;
  SiteArray<Real, 3> spins, vectors, shifted, before, at_rest;
  SiteArray<Real, 1> is_mobile;
  double inverse_shift;
  SiteArray<Real, 3> product;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, shifted);
    Vec3<Value> const m = site.load(spins), v = site.load(vectors);
    Vec3<Value> const change = field.field(stencil) - Vec3<Value>(site.load(before));
    Value const along = dot(m, Vec3<Value>(site.load(at_rest)));
    Vec3<Value> const p =
        Value(site.load(is_mobile)) *
        tangent(m, multiply_add(along, v, Vec3<Value>(Value(-inverse_shift) * change)));
    values[0] = dot(v, p);
    values[1] = dot(v, v);
    store_narrowed(p, site, product);
  }
};

/// Functor that finds max |v|^2 over the sites.
template <class Real>
struct LargestSquare {
  SiteArray<Real, 3> vectors;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> const v = site.load(vectors);
    values[0] = dot(v, v);
  }
};

/// Returns max |v| over the sites; waits.
template <class Exec, class Spins>
double largest_length(Exec const& exec, Spins const& vectors) {
  return std::sqrt(
      reduce_sites<Maximum, 1>(exec, "cayspin::minimize::largest_length", vectors.layout(),
                               LargestSquare<typename Spins::value_type>{vectors.array()})[0]);
}

/// How fields that are not affine in the spins are differentiated: for each product, by a
/// difference of two fields, with an error of the shift squared, or of four, with an error of its
/// fourth power.
enum class HessianDifferences { of_two, of_four };

/// Work memory for products with the Hessian.
template <class Spins>
struct HessianArrays {
  Spins shifted, at_rest, before;
};

template <class Exec, class Field, class Spins>
class Hessian {
  using Real = typename Spins::value_type;
  using Mobile = ScalarField<Real, typename Spins::memory_space>;

 public:
  struct Product {
    double along, square;  // v.hv and v.v
  };

  /// Linearises at `spins`, which must not change afterwards. A field that is not affine in the
  /// spins is differentiated by central differences. The constructor evaluates the field once.
  Hessian(Exec const& exec, Field const& field, double time, Spins const& spins,
          Mobile const& is_mobile, HessianArrays<Spins> const& arrays,
          HessianDifferences differences = HessianDifferences::of_two)
      : exec_(exec),
        field_(field),
        time_(time),
        spins_(spins),
        is_mobile_(is_mobile),
        arrays_(arrays),
        is_affine_(has_affine_field(field, exec, spins)),
        of_four_(differences == HessianDifferences::of_four) {
    evaluate_field(exec, field, spins, time, arrays.at_rest);
    ++evaluations_;
  }

  std::int64_t evaluations() const { return evaluations_; }

  /// Returns a bound on the round-off of v.hv / v.v, for fields up to `strongest`.
  double round_off(double strongest) const {
    constexpr double epsilon = std::numeric_limits<Real>::epsilon();
    double const of_differences = (of_four_ ? 6 : 2) / longest_shift();
    return (is_affine_ ? 64 : std::max(64.0, of_differences)) * epsilon * strongest;
  }

  /// Computes hv, the Hessian times a tangent v.
  Product multiply(Spins const& v, Spins const& hv) {
    auto const& [shifted, at_rest, before] = arrays_;
    combine(exec_, 0, v, 0, v, shifted);
    double const shift =
        (is_affine_ ? 0.5 : longest_shift()) / largest_difference(exec_, v, shifted);
    double inverse_shift = 1 / shift;
    if (!is_affine_) {
      inverse_shift = 1 / (2 * shift);
      evaluate_at(-shift, v, before);
    }
    if (!is_affine_ && of_four_) {
      // (8 H(h) - 8 H(-h) - H(2h) + H(-2h)) / 12h, of which the kernel adds the first term.
      inverse_shift = 1 / (1.5 * shift);
      for (double const side : {-0.125, 0.125}) {
        evaluate_at(16 * side * shift, v, hv);
        combine(exec_, side, hv, 1, before, before);
      }
    }
    combine(exec_, shift, v, 1, spins_, shifted);
    auto prepared = prepare_term(field_, exec_, shifted, time_);
    ++evaluations_;
    auto const& from = is_affine_ ? at_rest : before;
    auto const [along, square] = reduce_sites<Sum, 2>(
        exec_, "cayspin::minimize::hessian_product", spins_.layout(),
        HessianProduct<decltype(prepared), Real>{std::move(prepared), spins_.array(), v.array(),
                                                 shifted.array(), from.array(), at_rest.array(),
                                                 is_mobile_.array(), inverse_shift, hv.array()});
    return {along, square};
  }

  /// Replaces v by its tangent part on mobile sites, and by 0 on the others.
  void keep_tangent(Spins const& v) const {
    for_each_site<Real>(
        exec_, "cayspin::minimize::keep_tangent", spins_.layout(),
        KeepTangent<Real>{spins_.array(), v.array(), is_mobile_.array(), v.output(false)});
  }

 private:
  /// Computes the field at the spins plus a multiple of v.
  void evaluate_at(double multiple, Spins const& v, Spins const& to) {
    combine(exec_, multiple, v, 1, spins_, arrays_.shifted);
    evaluate_field(exec_, field_, arrays_.shifted, time_, to);
    ++evaluations_;
  }

  /// Returns the shift that balances the two errors of a difference: round-off divided by the
  /// shift, and the square of the shift or its fourth power.
  double longest_shift() const {
    constexpr double epsilon = std::numeric_limits<Real>::epsilon();
    return of_four_ ? std::pow(epsilon, 0.2) : 4 * std::cbrt(epsilon);
  }

  Exec const& exec_;
  Field const& field_;
  double time_;
  Spins const& spins_;
  Mobile const& is_mobile_;
  HessianArrays<Spins> arrays_;
  bool is_affine_, of_four_;
  std::int64_t evaluations_ = 0;
};

}  // namespace cayspin::inline v0_2::detail
