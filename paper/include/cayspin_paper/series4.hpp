// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/isotropy/energy.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <cayspin_paper/series_source.hpp>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace cayspin::inline v0_2 {

namespace detail {

struct Series4Correction {
  static constexpr int power = 4;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value sigma(SymmetricMatrix<Value> const& matrix,
                                                 Vec3<Value> const& m, bool orthogonal) {
    BodyInvariants<Value> const body(matrix, m);
    if (orthogonal) return Value(-1. / 24) * body.mixed * (body.trace_c - body.cubic_c);
    Value const form = body.det + Value(3) * body.trace * body.b * body.b -
                       Value(2) * body.second * body.b - Value(3) * body.b * body.b2;
    return guarded_quotient(Value(Value(1. / 24) * body.mixed * form), body.v2);
  }
};

struct Series4PaperCorrection {
  static constexpr int power = 4;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value sigma(SymmetricMatrix<Value> const& matrix,
                                                 Vec3<Value> const& m, bool) {
    BodyInvariants<Value> const body(matrix, m);
    return Value(-0.125) * body.mixed * (body.trace_c - body.cubic_c);
  }
};

/// The truncated series of F, the coordinates of a step's rotation, from a_k = d^k A / dt^k on the
/// exact flow. It holds for any part of A along m. Lewis and Nigam 2002, Sec. 5.3.
struct DirectSeries {
  using Correction = Series4Correction;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> coordinates(Vec3<Value> const* a,
                                                             Vec3<Value> const&, Value const& dt) {
    Value const square = dot(a[0], a[0]);
    Vec3<Value> const third = Value(2) * a[2] + square * a[0] + cross(a[1], a[0]);
    Vec3<Value> const fourth =
        a[3] + square * a[1] + cross(a[2], a[0]) + Value(Value(2) * dot(a[1], a[0])) * a[0];
    return sum(a, Value(1. / 12) * third, Value(1. / 24) * fourth, dt);
  }

 protected:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> sum(Vec3<Value> const* a, Vec3<Value> const& third,
                                                     Vec3<Value> const& fourth, Value const& dt) {
    Vec3<Value> f = multiply_add(dt, fourth, third);
    f = multiply_add(dt, f, Vec3<Value>(Value(0.5) * a[1]));
    f = multiply_add(dt, f, a[0]);
    return dt * f;
  }
};

/// The orthogonal series as printed in the paper, from the derivatives of A_o. Its order is that of
/// the direct series of A_o; for rigid bodies its energy error is three times as large.
struct PaperSeries : DirectSeries {
  using Correction = Series4PaperCorrection;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> coordinates(Vec3<Value> const* a,
                                                             Vec3<Value> const& m,
                                                             Value const& dt) {
    Vec3<Value> const third =
        Value(1. / 6) * a[2] + Value(1. / 12) * (dot(a[0], a[0]) * a[0] + dot(a[2], m) * m);
    Vec3<Value> const fourth = Value(1. / 24) * a[3] + Value(Value(0.125) * dot(a[1], a[0])) * a[0];
    return sum(a, third, fourth, dt);
  }
};

/// Returns derivative K + 1 of m, d^K/dt^K (A x m).
template <int K, class Generator, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> next_derivative(Generator const& generator,
                                                        Vec3<Value> const* m,
                                                        Vec3<Value> const* source) {
  Vec3<Value> a[std::size_t{K + 1}];
  unrolled<K + 1>([&](auto order) { a[order] = series_derivative<order()>(generator, m, source); });
  Vec3<Value> sum{Value(0), Value(0), Value(0)};
  leibniz<K>([&](auto weight, auto j, auto rest) {
    sum = multiply_add(Value(static_cast<scalar_t<Value>>(weight())), cross(a[j], m[rest]), sum);
  });
  return sum;
}

/// Computes the end of the step from derivatives 0 .. 3 of m and of the series' source.
template <class Series, class Isotropy, class Generator, class Site, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> end_of_series(Generator const& generator, Site const& site,
                                                      Vec3<Value> const* m,
                                                      Vec3<Value> const* source, Value const& dt) {
  Vec3<Value> a[4];
  unrolled<4>([&](auto order) {
    if constexpr (std::is_same_v<Series, PaperSeries>)
      a[order] = orthogonal_derivative<order()>(generator, m, source);
    else
      a[order] = series_derivative<order()>(generator, m, source);
  });
  Vec3<Value> f = Series::coordinates(a, m[0], dt);
  if constexpr (std::is_same_v<Isotropy, isotropy::Energy>)
    f = corrected<typename Series::Correction>(generator, site, f, m[0], dt);
  return Cayley::rotate(f, m[0]);
}

/// Functor that takes a whole step, if A at a site is linear in the site's spin and depends on no
/// other spin.
template <class Series, class Isotropy, class Generator, class Real>
struct LocalSeriesStage {
  Generator generator;
  SiteArray<Real, 3> start;
  OutputArray<Real, 3> next;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> m[4], source[4];
    m[0] = site.load(start);
    unrolled<4>([&](auto k) {
      source[k] = SeriesOf<Generator>::source(generator, SpinAlone<Site>(site, m[k]));
      if constexpr (k < 3) m[k + 1] = next_derivative<k()>(generator, m, source);
    });
    site.store(end_of_series<Series, Isotropy>(generator, site, m, source, Value(dt)), next);
  }
};

/// Kernel number K of the four that a step of coupled spins takes. It computes the K-th derivative
/// of the source, and from it the next derivative of the spins; the last kernel computes the end of
/// the step.
template <class Series, int K, class Generator, class Real>
struct SeriesStage {
  Generator generator;
  SiteArray<Real, 3> spins[std::size_t{K + 1}];  // derivatives 0 .. K
  OutputArray<Real, 3> sources[std::size_t{K == 3 ? 3 : K + 1}];
  OutputArray<Real, 3> next;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, spins[K]);
    Vec3<Value> m[std::size_t{K + 1}], source[std::size_t{K + 1}];
    unrolled<K>([&](auto k) {
      m[k] = site.load(spins[k]);
      source[k] = site.load(sources[k]);
    });
    m[K] = stencil.center();
    using Of = SeriesOf<Generator>;
    source[K] = K == 0 ? Of::source(generator, stencil) : Of::linear_source(generator, stencil);
    if constexpr (K < 3) {
      site.store(source[K], sources[K]);
      site.store(next_derivative<K>(generator, m, source), next);
    } else {
      site.store(end_of_series<Series, isotropy::Zero>(generator, site, m, source, Value(dt)),
                 next);
    }
  }
};

}  // namespace detail

/// The symbolic series of order 4 in Cayley coordinates:
/// F = dt * a + dt^2 * a_1 / 2 + dt^3 * (2 * a_2 + |a|^2 * a + a_1 x a) / 12
///   + dt^4 * (a_3 + |a|^2 * a_1 + a_2 x a + 2 * <a_1, a> * a) / 24,
/// where a = A, and a_k = d^k A / dt^k on the exact flow follow by recurrence. Rigid bodies take
/// one kernel. Landau-Lifshitz takes four, with a field that is affine in the spins and does not
/// depend on t. isotropy::Energy is for rigid bodies only. Lewis and Nigam 2002, Sec. 4.4 and 5.3.
template <class Spins, class Isotropy = isotropy::Zero, class Series = detail::DirectSeries>
class Series4 : public detail::StepperBase<Spins> {
  static_assert(std::is_same_v<Isotropy, isotropy::Zero> ||
                    std::is_same_v<Isotropy, isotropy::Energy>,
                "Series4 takes isotropy::Zero, or Energy for rigid bodies.");

 public:
  using typename detail::StepperBase<Spins>::Real;
  static constexpr int order = 4;
  static constexpr int evaluations = 4;
  static constexpr int ghosts = 4;
  static constexpr int work_fields =
      7;  // rigid bodies need 1; the other 6 are allocated when first needed

  explicit Series4(Spins const& like, Isotropy = {})
      : Series4::StepperBase("Series4", like.lattice(), ghosts),
        next_("Series4::next", like.lattice()) {}

  std::size_t work_bytes() const {
    return next_.bytes() * (derivatives_[0].sites() == 0 ? 1 : work_fields);
  }

  /// Advances `spins` from t to t + dt under `generator`. A step swaps the memory of `spins` with
  /// that of the stepper, so take arrays of `spins` again after it. Throws std::invalid_argument
  /// when `spins` is not on the lattice given at construction, and for a field that is not affine
  /// in the spins.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    static_assert(!detail::depends_on_time<Generator>, "Series4 refuses fields that depend on t.");
    auto const region = this->begin_step(exec, spins);
    this->require_other_memory(spins, next_);
    using Prepared = decltype(detail::prepare_term(generator, exec, spins, t));
    if constexpr (detail::SeriesOf<Prepared>::is_local) {
      auto const prepared = detail::prepare_term(generator, exec, spins, t);
      using Kernel = detail::LocalSeriesStage<Series, Isotropy, Prepared, Real>;
      detail::for_each_site<Real>(
          exec, step_label_, spins.layout(),
          Kernel{prepared, spins.array(), next_.output(false), static_cast<Real>(dt)});
    } else {
      static_assert(std::is_same_v<Isotropy, isotropy::Zero>,
                    "isotropy::Energy is for rigid bodies only; for other generators there is "
                    "EnergyControl.");
      if (!detail::has_affine_field(generator, exec, spins))
        throw std::invalid_argument(this->label(
            "::step: the field is not affine in the spins, as with biquadratic couplings"));
      allocate(spins.lattice());
      stage<0>(exec, generator, spins, t, dt);
    }
    swap(spins, next_);
    detail::update_ghosts(exec, this->lattice_, spins);
  }

  /// Visits the field whose memory a step may swap with that of the spins, for cayspin::integrate.
  template <class Visit>
  void visit_exchanged(Visit const& visit) {
    visit(next_);
  }

 private:
  void allocate(Lattice const& lattice) {
    if (derivatives_[0].sites() != 0) return;
    for (std::size_t k = 0; k < derivatives_.size(); ++k) {
      derivatives_[k] = Spins("Series4::spins_" + std::to_string(k + 1), lattice);
      sources_[k] = Spins("Series4::source_" + std::to_string(k), lattice);
    }
  }

  template <int K>
  Spins const& derivative(Spins const& spins) const {
    if constexpr (K == 0)
      return spins;
    else
      return derivatives_[K - 1];
  }

  template <int K, class Exec, class Generator>
  void stage(Exec const& exec, Generator const& generator, Spins const& spins, double t,
             double dt) {
    auto prepared = detail::prepare_term(generator, exec, derivative<K>(spins), t);
    detail::SeriesStage<Series, K, decltype(prepared), Real> kernel{
        std::move(prepared), {}, {}, next_.output(false), static_cast<Real>(dt)};
    detail::unrolled<K + 1>([&](auto k) {
      kernel.spins[k()] = derivative<k()>(spins).array();
      if constexpr (k() < 3) kernel.sources[k()] = sources_[k()].output(false);
    });
    if constexpr (K < 3) kernel.next = derivatives_[K].output(false);
    detail::for_each_site<Real>(exec, labels_[K], spins.layout(), kernel,
                                spins.layout().own_and(3 - K));
    if constexpr (K < 3) stage<K + 1>(exec, generator, spins, t, dt);
  }

  std::string step_label_ = this->label("::step");
  std::array<std::string, 4> labels_{this->label("::derivative_1"), this->label("::derivative_2"),
                                     this->label("::derivative_3"), this->label("::rotate")};
  Spins next_;
  std::array<Spins, 3> derivatives_, sources_;
};

/// The orthogonal series as printed in the paper, from the derivatives of A_o. It drops the part of
/// the generator along m. It is also of order 4, but has a larger energy error than Series4.
template <class Spins, class Isotropy = isotropy::Zero>
class Series4Paper : public Series4<Spins, Isotropy, detail::PaperSeries> {
 public:
  explicit Series4Paper(Spins const& like, Isotropy isotropy = {})
      : Series4Paper::Series4(like, isotropy) {}
};

}  // namespace cayspin::inline v0_2
