// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/site.hpp>
#include <cayspin/stage/arrays.hpp>
#include <cayspin/stage/kernel.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>

// Kernels that an adaptive Runge-Kutta step runs in addition to RungeKuttaStage. `Tableau` is a
// FirstSameAsLast throughout.
namespace cayspin::inline v0_2::detail {

/// Functor that computes the generator A at the start of a run, and |A x m|^2, the squared rate of
/// the spin.
template <class Isotropy, class Generator, class Real>
struct FirstGeneratorStage {
  Generator generator;
  Isotropy isotropy;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> first;
  OutputArray<Real, 1> square;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    Stencil<Site, Real> const stencil(site, spins);
    auto const xi = isotropy(stencil.center(), evaluate(generator, stencil));
    auto const rate = cross(xi, stencil.center());
    site.store(xi, first);
    site.store(dot(rate, rate), square);
  }
};

/// Generator of the first stage. Its values were computed at the end of the previous step, or at
/// the start of the run.
template <class Real>
struct KnownGenerator {
  SiteArray<Real, 3> generators;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    return stencil.site().load(generators);
  }
};

template <class Tableau>
struct ErrorWeights {
  KOKKOS_FUNCTION static constexpr double at(int j) { return Tableau::error[j]; }
};

/// The stored increments of a completed step: all except the last.
template <class Tableau, class Real>
struct StepIncrements {
  static constexpr int stages = Tableau::stages;
  SiteArray<Real, 3> array[std::size_t{stages - 1}];

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void load(Site const& site, Vec3<Value>* f) const {
    unrolled<stages - 1>([&](auto j) {
      if constexpr (Tableau::a[stages - 1][j()] != 0 || Tableau::error[j()] != 0)
        f[j()] = site.load(array[j()]);
    });
  }
};

/// Arrays that the last stage writes. With Path::sweep these include the spins and, for dense
/// output within the step, the increments. With Path::pass, earlier stages have stored both.
template <class Tableau, class Real>
struct EndOutputs {
  OutputArray<Real, 3> last;
  OutputArray<Real, 1> square;
  bool stores_spins = false, stores_increments = false;
  OutputArray<Real, 3> increments[std::size_t{Tableau::stages - 1}] = {};
};

/// Functor of the last stage: computes the generator at the end of the step, and the squared
/// distance between the spin there and the embedded solution.
template <class Tableau, class Update, class Isotropy, class Generator, class Real>
struct EndStage {
  using Flow = StageDataFlow<Tableau, Update, Tableau::stages - 1>;
  using value_type = Real;
  using RowArrays = StageArrays<Rows<Real>, Tableau::stages>;
  static constexpr int stages = Tableau::stages, stages_after = 0;
  static constexpr bool turning_alone = false;

  Generator generator;
  Isotropy isotropy;
  EndOutputs<Tableau, Real> to;
  Real dt;

  /// `rows`: StageArrays or DeviceArrays.
  template <class Site, class Arrays>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Arrays const& rows) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real, decltype(rows.level)> const stencil(site, rows.level);
    Vec3<Value> const& m = stencil.center();
    Vec3<Value> const m0 = site.load(rows.start);
    Vec3<Value> const xi = isotropy(m, evaluate(generator, stencil));
    Vec3<Value> f[std::size_t{stages}];
    unrolled<stages - 1>([&](auto j) {
      if constexpr (Flow::reads_increment(j())) f[j()] = site.load(rows.increments[j]);
    });
    Vec3<Value> const total = weighted_sum<StageWeights<Tableau, stages - 1>, stages - 1>(f);
    f[stages - 1] = Update::increment(total, Vec3<Value>(Value(dt) * xi), m, m0);
    Vec3<Value> const error = weighted_sum<ErrorWeights<Tableau>, stages>(f);
    Vec3<Value> const difference = m - Update::finish(Vec3<Value>(total - error), m0);
    // Large coordinates may differ much although the spins to which they lead hardly differ. If
    // |total| > 2, the larger of two errors therefore counts: that of the spin and that of the
    // coordinates.
    Vec3<Value> const unbounded = cross(error, m0);
    Value const apart = dot(difference, difference), of_error = dot(unbounded, unbounded);
    site.store(xi, to.last);
    site.store(select<Value>(Value(4) < dot(total, total), maximum(apart, of_error), apart),
               to.square);
    if (to.stores_spins) site.store(m, rows.next);
    if (to.stores_increments)
      unrolled<stages - 1>([&](auto j) {
        if constexpr (Flow::reads_increment(j())) site.store(f[j()], to.increments[j()]);
      });
  }
};

/// Functor that computes the spins at a time within a completed step.
template <class Tableau, class Update, class Real>
struct DenseOutput {
  static constexpr int stages = Tableau::stages;
  SiteArray<Real, 3> start, end, last;
  StepIncrements<Tableau, Real> increments;
  OutputArray<Real, 3> spins;
  Real dt;
  Real weights[std::size_t{stages}] = {};

  /// Sets the time of the output: s is 0 at the start of the step and 1 at its end.
  void set_fraction(double s) {
    for (int j = 0; j < stages; ++j) {
      double weight = 0;
      for (int power = 5; power > 0; --power) weight = s * (weight + Tableau::dense[j][power - 1]);
      weights[j] = static_cast<Real>(weight);
    }
  }

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const m0 = site.load(start);
    Vec3<Value> f[std::size_t{stages}];
    increments.load(site, f);
    f[stages - 1] =
        Update::increment(weighted_sum<StageWeights<Tableau, stages - 1>, stages - 1>(f),
                          Vec3<Value>(Value(dt) * site.load(last)), site.load(end), m0);
    Vec3<Value> on{Value(0), Value(0), Value(0)};
    unrolled<stages>([&](auto j) {
      if constexpr (Tableau::dense[j()][1] != 0) on = multiply_add(Value(weights[j()]), f[j()], on);
    });
    site.store(Update::finish(on, m0), spins);
  }
};

}  // namespace cayspin::inline v0_2::detail
