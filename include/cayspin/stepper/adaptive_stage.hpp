// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/site.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stage/kernel.hpp>

// What an adaptive Runge-Kutta step does besides its stages. Tableau is a FirstSameAsLast.
namespace cayspin::detail {

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> no_coordinates() {
  return {Value(0), Value(0), Value(0)};
}

/// The generator at the begin of a run, and the square of the spin's rate |A x m|.
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

/// The first increment, from a generator that is known, and the second stage's spins.
template <class Tableau, class Update, class Real>
struct KnownFirstStage {
  SiteArray<Real, 3> start, first;
  OutputArray<Real, 3> increment, next;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const m0 = site.load(start);
    Vec3<Value> const f = Update::increment(no_coordinates<Value>(),
                                            Vec3<Value>(Value(dt) * site.load(first)), m0, m0);
    site.store(f, increment);
    site.store(Update::move(Value(static_cast<Real>(Tableau::a[1][0])) * f, m0), next);
  }
};

template <class Tableau>
struct ErrorWeights {
  KOKKOS_FUNCTION static constexpr double of(int j) { return Tableau::error[j]; }
};

/// All increments of a step that has been taken.
template <class Tableau, class Real>
struct StepIncrements {
  static constexpr int stages = Tableau::stages;
  SiteArray<Real, 3> of[stages - 1];

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void load(Site const& site, Vec3<Value>* f) const {
    unrolled<stages - 1>([&](auto j) {
      if constexpr (Tableau::a[stages - 1][j()] != 0 || Tableau::error[j()] != 0)
        f[j()] = site.load(of[j()]);
    });
  }
};

/// The generator at the end of a step, and the squared distance of that end from the embedded
/// solution's.
template <class Tableau, class Update, class Isotropy, class Generator, class Real>
struct EndStage {
  static constexpr int stages = Tableau::stages;
  Generator generator;
  Isotropy isotropy;
  SiteArray<Real, 3> start, end;
  StepIncrements<Tableau, Real> increments;
  OutputArray<Real, 3> last;
  OutputArray<Real, 1> square;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, end);
    Vec3<Value> const& m = stencil.center();
    Vec3<Value> const m0 = site.load(start);
    Vec3<Value> const xi = isotropy(m, evaluate(generator, stencil));
    Vec3<Value> f[stages];
    increments.load(site, f);
    Vec3<Value> const total = weighted_sum<StageWeights<Tableau, stages - 1>, stages - 1>(f);
    f[stages - 1] = Update::increment(total, Vec3<Value>(Value(dt) * xi), m, m0);
    Vec3<Value> const error = weighted_sum<ErrorWeights<Tableau>, stages>(f);
    Vec3<Value> const difference = m - Update::finish(Vec3<Value>(total - error), m0);
    // Rotations of large coordinates hardly differ where these do.
    Vec3<Value> const unbounded = cross(error, m0);
    Value const apart = dot(difference, difference), of_error = dot(unbounded, unbounded);
    site.store(xi, last);
    site.store(select<Value>(Value(4) < dot(total, total), maximum(apart, of_error), apart),
               square);
  }
};

/// The spins within a step that has been taken.
template <class Tableau, class Update, class Real>
struct DenseOutput {
  static constexpr int stages = Tableau::stages;
  SiteArray<Real, 3> start, end, last;
  StepIncrements<Tableau, Real> increments;
  OutputArray<Real, 3> spins;
  Real dt;
  Real weights[stages];

  /// At fraction s of a step of dt.
  DenseOutput(SiteArray<Real, 3> start_of, SiteArray<Real, 3> end_of, SiteArray<Real, 3> last_of,
              StepIncrements<Tableau, Real> all, OutputArray<Real, 3> to, double step, double s)
      : start(start_of),
        end(end_of),
        last(last_of),
        increments(all),
        spins(to),
        dt(static_cast<Real>(step)) {
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
    Vec3<Value> f[stages];
    increments.load(site, f);
    f[stages - 1] =
        Update::increment(weighted_sum<StageWeights<Tableau, stages - 1>, stages - 1>(f),
                          Vec3<Value>(Value(dt) * site.load(last)), site.load(end), m0);
    Vec3<Value> on = no_coordinates<Value>();
    unrolled<stages>([&](auto j) {
      if constexpr (Tableau::dense[j()][1] != 0) on = multiply_add(Value(weights[j()]), f[j()], on);
    });
    site.store(Update::finish(on, m0), spins);
  }
};

template <class Real>
struct LargestNumber {
  SiteArray<Real, 1> of;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    values[0] = site.load(of);
  }
};

}  // namespace cayspin::detail
