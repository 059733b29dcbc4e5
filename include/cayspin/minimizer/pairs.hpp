// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/unrolled.hpp>
#include <cayspin/minimizer/trial.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

// The last steps s and gradient changes y, from which L-BFGS approximates the inverse Hessian
// (Nocedal and Wright 2006, Sec. 7.2). Both are tangent where they were made, and are projected
// onto the current tangent planes where they are used. Three passes give all inner products that
// the recursion needs.
namespace cayspin::inline v0_2::detail {

inline constexpr std::size_t pairs_kept = 6;

template <class Number>
using OfPairs = Kokkos::Array<Number, pairs_kept>;
/// Arrays of the pairs, oldest first. Entries from `count` on are unused.
template <class Real>
using PairArrays = OfPairs<SiteArray<Real, 3>>;

/// Functor that computes s_i.g, and s_i.y_j for i < j; then s.K s for the last step s, with the
/// exchange K.
template <class Real>
struct ProductsOfPairs {
  static constexpr int pairs = static_cast<int>(pairs_kept);
  static constexpr int count_of_values = pairs + pairs * (pairs - 1) / 2 + 1;
  template <class Index>
  KOKKOS_FORCEINLINE_FUNCTION static constexpr Index of(Index i, Index j) {
    return static_cast<Index>(pairs) + j * (j - 1) / 2 + i;
  }

  SiteArray<Real, 3> spins, gradient;
  PairArrays<Real> steps, changes;
  int count;
  Kokkos::Array<double, 3> couplings;  // negative if neighbours prefer to be opposite

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> const m = site.load(spins), g = site.load(gradient);
    for (int i = 0; i < count_of_values; ++i) values[i] = Value(0.0);
    // Constant indices keep the values in registers on devices.
    unrolled<pairs>([&](auto j) {
      if (j() >= count) return;
      values[j()] = dot(Vec3<Value>(site.load(steps[j()])), g);
      Vec3<Value> const change = tangent(m, Vec3<Value>(site.load(changes[j()])));
      unrolled<j()>(
          [&](auto i) { values[of(i(), j())] = dot(Vec3<Value>(site.load(steps[i()])), change); });
    });
    if (count == 0) return;
    Stencil<Site, Real> const last(site, steps[count - 1]);
    values[count_of_values - 1] = bonds<0>(last) + bonds<1>(last) + bonds<2>(last);
  }

 private:
  template <int Axis, class AnyStencil>
  KOKKOS_FORCEINLINE_FUNCTION auto bonds(AnyStencil const& stencil) const {
    using Value = typename AnyStencil::value_type;
    double const coupling = couplings[Axis];
    Vec3<Value> const here = as_value<Value>(coupling < 0 ? -1.0 : 1.0) * stencil.center();
    auto const back = stencil.template previous<Axis>(here) - here;
    auto const on = stencil.template next<Axis>(here) - here;
    return as_value<Value>(0.5 * Kokkos::abs(coupling)) * Value(dot(back, back) + dot(on, on));
  }
};

/// Functor that writes the tangent part of g - sum(weights_i * y_i).
template <class Real>
struct WithoutChanges {
  SiteArray<Real, 3> spins, gradient;
  PairArrays<Real> changes;
  OfPairs<Real> weights;
  int count;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> q = site.load(gradient);
    for (int i = 0; i < count; ++i)
      q = multiply_add(Value(-weights[i]), Vec3<Value>(site.load(changes[i])), q);
    site.store(tangent(Vec3<Value>(site.load(spins)), q), output);
  }
};

/// Functor that computes y_i.z, where z is the tangent part of `vectors`.
template <class Real>
struct ProductsWithChanges {
  static constexpr int pairs = static_cast<int>(pairs_kept);
  SiteArray<Real, 3> spins, vectors;
  PairArrays<Real> changes;
  int count;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> const z = tangent(Vec3<Value>(site.load(spins)), Vec3<Value>(site.load(vectors)));
    for (int i = 0; i < pairs; ++i)
      values[i] = i < count ? dot(Vec3<Value>(site.load(changes[i])), z) : Value(0.0);
  }
};

/// Functor that computes d, the tangent part of -(scale * z + sum(weights_i * s_i)) with z =
/// `vectors`, or 0 where the spin is not mobile. Also computes g.d and max |d|^2.
template <class Real>
struct DirectionWithSteps {
  SiteArray<Real, 3> spins, gradient, vectors;
  SiteArray<Real, 1> is_mobile;
  PairArrays<Real> steps;
  OfPairs<double> weights;
  double scale;
  int count;
  SiteArray<Real, 3> direction;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> sum = Value(scale) * Vec3<Value>(site.load(vectors));
    for (int i = 0; i < count; ++i)
      sum = multiply_add(Value(weights[i]), Vec3<Value>(site.load(steps[i])), sum);
    Vec3<Value> const d =
        Value(-Value(site.load(is_mobile))) * tangent(Vec3<Value>(site.load(spins)), sum);
    values[0] = dot(Vec3<Value>(site.load(gradient)), d);
    values[1] = dot(d, d);
    store_narrowed(d, site, direction);
  }
};

/// The pairs, oldest first.
template <class Spins>
class Pairs {
  using Real = typename Spins::value_type;

 public:
  Pairs(std::string const& name, Lattice const& lattice)
      : steps_(numbered_fields<Spins, pairs_kept + 1>(name + "::step", lattice)),
        changes_(numbered_fields<Spins, pairs_kept + 1>(name + "::change", lattice)) {}

  /// Return the memory for the next pair, which may be kept or discarded.
  Spins const& next_step() const { return steps_[count_]; }
  Spins const& next_change() const { return changes_[count_]; }

  std::size_t count() const { return count_; }
  void forget() { count_ = 0; }
  /// Keeps next_step and next_change as a pair; `product` is their s.y.
  void keep(double product) {
    products_[count_] = product;
    if (count_ < pairs_kept) {
      ++count_;
      return;
    }
    std::rotate(steps_.begin(), steps_.begin() + 1, steps_.end());
    std::rotate(changes_.begin(), changes_.begin() + 1, changes_.end());
    std::rotate(products_.begin(), products_.begin() + 1, products_.end());
  }

  /// Return the product s.y, the step s and the change y of pair `i`.
  double product(std::size_t i) const { return products_[i]; }
  Spins const& step(std::size_t i) const { return steps_[i]; }
  Spins const& change(std::size_t i) const { return changes_[i]; }

  PairArrays<Real> steps() const { return arrays_of(steps_); }
  PairArrays<Real> changes() const { return arrays_of(changes_); }

 private:
  using Fields = std::array<Spins, pairs_kept + 1>;

  static PairArrays<Real> arrays_of(Fields const& fields) {
    PairArrays<Real> arrays;
    for (std::size_t i = 0; i < pairs_kept; ++i) arrays[i] = fields[i].array();
    return arrays;
  }

  Fields steps_, changes_;
  std::array<double, pairs_kept + 1> products_{};
  std::size_t count_ = 0;
};

}  // namespace cayspin::inline v0_2::detail
