// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/stencil.hpp>

#include <type_traits>
#include <utility>

namespace cayspin::detail {

/// Does stage `stage` (or the end of the step behind the last one) read the increment of `source`?
template <class Tableau, class Update>
constexpr bool reads_increment(int stage, int source) {
  if (source >= stage) return false;
  bool const last = stage == Tableau::stages - 1;
  if (last && (Tableau::b[source] != 0 || Update::keeps_generators)) return true;
  if (!last && Tableau::a[stage + 1][source] != 0) return true;
  return Update::increment_needs_argument && Tableau::a[stage][source] != 0;
}

template <class Tableau, class Update>
constexpr bool stores_increment(int source) {
  for (int stage = source + 1; stage < Tableau::stages; ++stage)
    if (reads_increment<Tableau, Update>(stage, source)) return true;
  return false;
}

template <int... I, class Body>
KOKKOS_FORCEINLINE_FUNCTION void unrolled(std::integer_sequence<int, I...>, Body const& body) {
  (body(std::integral_constant<int, I>{}), ...);
}

/// sum of Weights<j> * v[j] over those j < Count with a weight.
template <class Weights, int Count, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> weighted_sum(Vec3<Value> const* v) {
  Vec3<Value> sum{Value(0), Value(0), Value(0)};
  unrolled(std::make_integer_sequence<int, Count>{}, [&](auto j) {
    constexpr double weight = Weights::of(j());
    constexpr bool first = Weights::first(j());
    using Scalar = scalar_t<Value>;
    if constexpr (weight != 0 && first) {
      sum = weight == 1 ? v[j()] : Value(static_cast<Scalar>(weight)) * v[j()];
    } else if constexpr (weight != 0) {
      sum = multiply_add(Value(static_cast<Scalar>(weight)), v[j()], sum);
    }
  });
  return sum;
}

template <class Tableau, int Row>
struct StageWeights {
  static constexpr double of(int j) { return Tableau::a[Row][j]; }
  static constexpr bool first(int j) {
    for (int i = 0; i < j; ++i)
      if (of(i) != 0) return false;
    return true;
  }
};

template <class Tableau>
struct FinalWeights {
  static constexpr double of(int j) { return Tableau::b[j]; }
  static constexpr bool first(int j) {
    for (int i = 0; i < j; ++i)
      if (of(i) != 0) return false;
    return true;
  }
};

/// One stage of an explicit Runge-Kutta step on every site: evaluate the generator at the stage's
/// spins, form the increment, and move the step's first spins to where the next stage looks, or to
/// the end of the step.
template <class Tableau, class Update, class Isotropy, int StageIndex, class Generator, class Real>
struct RungeKuttaStage {
  static constexpr int stages = Tableau::stages;
  static constexpr bool last = StageIndex == stages - 1;

  Generator generator;
  Isotropy isotropy;
  SiteArray<Real, 3> start;                                    // spins at the begin of the step
  SiteArray<Real, 3> level;                                    // spins of this stage
  SiteArray<Real, 3> increments[stages > 1 ? stages - 1 : 1];  // of earlier stages
  OutputArray<Real, 3> increment;                              // of this stage
  OutputArray<Real, 3> next;  // spins of the next stage, or of the end
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, level);
    Vec3<Value> const m0 = StageIndex == 0 ? stencil.center() : site.load(start);
    Vec3<Value> const a = Value(dt) * isotropy(stencil.center(), evaluate(generator, stencil));

    Vec3<Value> f[stages];
    unrolled(std::make_integer_sequence<int, StageIndex>{}, [&](auto j) {
      if constexpr (reads_increment<Tableau, Update>(StageIndex, j()))
        f[j()] = site.load(increments[j()]);
    });
    Vec3<Value> argument{Value(0), Value(0), Value(0)};
    if constexpr (Update::increment_needs_argument && StageIndex > 0)
      argument = weighted_sum<StageWeights<Tableau, StageIndex>, StageIndex>(f);

    if constexpr (StageIndex == 0 && Update::increment_needs_argument) {
      f[0] = a;  // the inverse tangent at 0 is the identity
    } else if constexpr (Update::keeps_generators && !last) {
      f[StageIndex] = a;
    } else {
      f[StageIndex] = Update::increment(argument, a, stencil.center());
    }

    if constexpr (last) {
      if constexpr (Update::keeps_generators) increments_from_generators(f);
      site.store(Update::finish(weighted_sum<FinalWeights<Tableau>, stages>(f), m0), next);
    } else {
      if constexpr (stores_increment<Tableau, Update>(StageIndex))
        site.store(f[StageIndex], increment);
      site.store(
          Update::move(weighted_sum<StageWeights<Tableau, StageIndex + 1>, StageIndex + 1>(f), m0),
          next);
    }
  }

 private:
  // Later increments first: each needs the generators before it.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static void increments_from_generators(Vec3<Value>* f) {
    unrolled(std::make_integer_sequence<int, stages - 2>{}, [&](auto j) {
      constexpr int stage = stages - 2 - j();
      f[stage] =
          Update::increment(weighted_sum<StageWeights<Tableau, stage>, stage>(f), f[stage], f[0]);
    });
  }
};

}  // namespace cayspin::detail
