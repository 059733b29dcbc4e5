// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/isotropy/energy.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stepper/update.hpp>

#include <type_traits>

namespace cayspin::detail {

/// Every stage starts from the increment before it alone, as in the classical Runge-Kutta methods.
template <class Tableau>
constexpr bool is_chain() {
  for (int i = 0; i < Tableau::stages; ++i)
    for (int j = 0; j < i; ++j)
      if ((Tableau::a[i][j] != 0) != (j == i - 1)) return false;
  return true;
}

/// In a chain that needs its increments as arguments, one array holds the last increment and one
/// the weighted sum, brought up to date at every second stage: the least that can be moved.
template <class Tableau, class Update>
inline constexpr bool keeps_sum = Tableau::stages > 2 &&
                                  is_chain<Tableau>() && Update::increment_needs_argument &&
                                  !Update::keeps_generators;

/// In a chain on a chart, each increment is read back from the spins of the stage after it: stages
/// store their spins alone.
template <class Tableau, class Update>
constexpr bool recovers_increments() {
  if constexpr (requires { Update::has_chart; }) return Tableau::stages > 1 && is_chain<Tableau>();
  return false;
}

/// Does stage `stage` (or the end of the step behind the last one) read the increment of `source`?
template <class Tableau, class Update>
constexpr bool reads_increment(int stage, int source) {
  if (source >= stage || recovers_increments<Tableau, Update>()) return false;
  if (keeps_sum<Tableau, Update>) return source == stage - 1;
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

template <class Tableau, class Update>
constexpr bool writes_sum(int stage) {
  return keeps_sum<Tableau, Update> && stage % 2 == 1 && stage + 1 < Tableau::stages;
}
template <class Tableau, class Update>
constexpr bool reads_sum(int stage) {
  return keeps_sum<Tableau, Update> && stage > 1 &&
         (stage % 2 == 1 || stage + 1 == Tableau::stages);
}

/// Fields of three numbers per site that a method needs beside the spins.
template <class Tableau, class Update>
constexpr int level_fields() {
  if (recovers_increments<Tableau, Update>()) return Tableau::stages - 1;
  return Tableau::stages < 3 ? 1 : 2;
}
template <class Tableau, class Update>
constexpr int work_fields() {
  int const levels = level_fields<Tableau, Update>();
  if (keeps_sum<Tableau, Update>) return levels + 2;
  int increments = 0;
  for (int stage = 0; stage + 1 < Tableau::stages; ++stage)
    increments += stores_increment<Tableau, Update>(stage);
  return levels + increments;
}

/// sum of Weights<j> * v[j] over those j < Count with a weight.
template <class Weights, int Count, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> weighted_sum(Vec3<Value> const* v) {
  Vec3<Value> sum{Value(0), Value(0), Value(0)};
  unrolled<Count>([&](auto j) {
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
  KOKKOS_FUNCTION static constexpr double of(int j) { return Tableau::a[Row][j]; }
  KOKKOS_FUNCTION static constexpr bool first(int j) {
    for (int i = 0; i < j; ++i)
      if (of(i) != 0) return false;
    return true;
  }
};

template <class Tableau>
struct FinalWeights {
  KOKKOS_FUNCTION static constexpr double of(int j) { return Tableau::b[j]; }
  KOKKOS_FUNCTION static constexpr bool first(int j) {
    for (int i = 0; i < j; ++i)
      if (of(i) != 0) return false;
    return true;
  }
};

/// isotropy::Energy's formula for a method.
template <class Tableau, class Update>
struct EnergyCorrection {
  static_assert(std::is_same_v<Tableau, void>,
                "isotropy::Energy belongs to LieHeun, Rkmk4 and Series4 in Cayley coordinates.");
};
template <>
struct EnergyCorrection<tableau::Heun, update::LieUncorrected<Cayley>> {
  using type = HeunCorrection;
};
template <>
struct EnergyCorrection<tableau::Classical4, update::Lie<Cayley>> {
  using type = Rkmk4Correction;
};
template <class Tableau, class Update>
using EnergyCorrectionOf = typename EnergyCorrection<Tableau, Update>::type;

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
  SiteArray<Real, 3> increments[stages > 1 ? stages - 1 : 1];  // of earlier stages, or spins
  OutputArray<Real, 3> sum;                                    // of weighted increments
  OutputArray<Real, 3> increment;                              // of this stage
  OutputArray<Real, 3> next;  // spins of the next stage, or of the end
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, level);
    Vec3<Value> const m0 = StageIndex == 0 ? stencil.center() : site.load(start);
    Vec3<Value> const a = Value(dt) * xi(stencil.center(), evaluate(generator, stencil));

    if constexpr (recovers_increments<Tableau, Update>()) {
      site.store(on_chart(site, a, stencil.center(), m0), next);
      return;
    }

    Vec3<Value> f[stages];
    unrolled<StageIndex>([&](auto j) {
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
      f[StageIndex] = Update::increment(argument, a, stencil.center(), m0);
    }

    if constexpr (last) {
      if constexpr (Update::keeps_generators) increments_from_generators(f, m0);
      site.store(Update::finish(completed(site, total(site, f), m0), m0), next);
    } else {
      if constexpr (writes_sum<Tableau, Update>(StageIndex))
        site.store(sum_up_to_here(site, f), sum);
      if constexpr (stores_increment<Tableau, Update>(StageIndex))
        site.store(f[StageIndex], increment);
      site.store(
          Update::move(weighted_sum<StageWeights<Tableau, StageIndex + 1>, StageIndex + 1>(f), m0),
          next);
    }
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> xi(Vec3<Value> const& m, Vec3<Value> const& a) const {
    if constexpr (std::is_same_v<Isotropy, isotropy::Energy>) {
      return a;  // completed at the end of the step
    } else {
      static_assert(
          requires { isotropy(m, a); },
          "This isotropy policy does not go with this stepper: Zero and Constant go with all on "
          "the group, FiniteDifference, Analytic and Connection with LieEuler.");
      return isotropy(m, a);
    }
  }

  template <class Value, int Of>
  KOKKOS_FORCEINLINE_FUNCTION static Value weight() {
    constexpr double b = Tableau::b[Of];
    return Value(static_cast<scalar_t<Value>>(b));
  }

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> total(Site const& site, Vec3<Value> const* f) const {
    if constexpr (keeps_sum<Tableau, Update>) {
      return sum_up_to_here(site, f);
    } else {
      return weighted_sum<FinalWeights<Tableau>, stages>(f);
    }
  }

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> completed(Site const& site, Vec3<Value> const& f,
                                                    Vec3<Value> const& m0) const {
    if constexpr (std::is_same_v<Isotropy, isotropy::Energy>) {
      return corrected<EnergyCorrectionOf<Tableau, Update>>(generator, site, f, m0, Value(dt));
    } else {
      return f;
    }
  }

  // The next stage's spins; at the end the step's, with increment j from the spins after stage j.
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> on_chart(Site const& site, Vec3<Value> const& a,
                                                   Vec3<Value> const& m,
                                                   Vec3<Value> const& m0) const {
    if constexpr (!last) {
      constexpr double factor = Tableau::a[StageIndex + 1][StageIndex];
      return Update::advance(Vec3<Value>(Value(static_cast<scalar_t<Value>>(factor)) * a), m, m0);
    } else {
      Vec3<Value> sum = weight<Value, StageIndex>() * Update::increment(m0, a, m, m0);
      unrolled<StageIndex>([&](auto j) {
        constexpr double factor = Tableau::b[j()] / Tableau::a[j() + 1][j()];
        if constexpr (factor != 0) {
          Vec3<Value> const after = j() + 1 == StageIndex ? m : site.load(increments[j()]);
          sum = multiply_add(Value(static_cast<scalar_t<Value>>(factor)),
                             Update::coordinates(after, m0), sum);
        }
      });
      return Update::finish(sum, m0);
    }
  }

  // The stored sum, the increment before this one where an even stage left it out, and this one.
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> sum_up_to_here(Site const& site,
                                                         Vec3<Value> const* f) const {
    Vec3<Value> total = weight<Value, StageIndex>() * f[StageIndex];
    if constexpr (StageIndex % 2 == 1)
      total = multiply_add(weight<Value, StageIndex - 1>(), f[StageIndex - 1], total);
    if constexpr (reads_sum<Tableau, Update>(StageIndex)) total = total + site.load(sum);
    return total;
  }

  // Later increments first: each needs the generators before it.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static void increments_from_generators(Vec3<Value>* f,
                                                                     Vec3<Value> const& m0) {
    unrolled<stages - 2>([&](auto j) {
      constexpr int stage = stages - 2 - j();
      f[stage] =
          Update::increment(weighted_sum<StageWeights<Tableau, stage>, stage>(f), f[stage], m0, m0);
    });
  }
};

}  // namespace cayspin::detail
