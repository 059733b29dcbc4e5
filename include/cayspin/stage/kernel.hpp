// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/isotropy/energy.hpp>
#include <cayspin/stage/arrays.hpp>
#include <cayspin/stage/update.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>
#include <type_traits>

namespace cayspin::inline v0_2::detail {

/// Returns true if the weights with indices below j are all 0.
template <class Weights>
KOKKOS_FUNCTION constexpr bool is_first(int j) {
  for (int i = 0; i < j; ++i)
    if (Weights::at(i) != 0) return false;
  return true;
}

/// Returns the sum of Weights::at(j) * v[j] over those j < Count whose weight is not 0.
template <class Weights, int Count, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> weighted_sum(Vec3<Value> const* v) {
  Vec3<Value> sum{Value(0), Value(0), Value(0)};
  unrolled<Count>([&](auto j) {
    constexpr double weight = Weights::at(j());
    constexpr bool first = is_first<Weights>(j());
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
  KOKKOS_FUNCTION static constexpr double at(int j) { return Tableau::a[Row][j]; }
};

template <class Tableau>
struct FinalWeights {
  KOKKOS_FUNCTION static constexpr double at(int j) { return Tableau::b[j]; }
};

template <class Tableau, int Row>
struct SecondWeights {
  KOKKOS_FUNCTION static constexpr double at(int j) { return second_weight<Tableau>(Row, j); }
};

/// Weights that turn a chain's sum of b[j] * (increment j) into a sum over the coordinates of
/// spins: increment j equals the coordinates of the spin of stage j + 1, divided by a[j + 1][j].
/// Since no stage follows the last increment, that increment stays in the sum, with the weight
/// `last`.
template <class Tableau>
struct ChartWeights {
  static constexpr double last = Tableau::b[Tableau::stages - 1];
  KOKKOS_FUNCTION static constexpr double spin(int j) {
    return Tableau::b[j] / Tableau::a[j + 1][j];
  }
};

/// True if an update's increments depend on A only through A x m.
template <class Update>
inline constexpr bool needs_turning_alone = requires { requires Update::needs_turning_alone; };

/// Formula of isotropy::Energy for a method. The methods that have one specialise this.
template <class Tableau, class Update>
struct EnergyCorrection {
  static_assert(std::is_same_v<Tableau, void>,
                "isotropy::Energy belongs to LieHeun, Rkmk4 and Series4 in Cayley coordinates.");
};
template <class Tableau, class Update>
using EnergyCorrectionOf = typename EnergyCorrection<Tableau, Update>::type;

/// One stage of an explicit Runge-Kutta step on every site: evaluates the generator at the stage's
/// spins, forms the increment, and moves the spins at the start of the step to the next stage, or
/// to the end of the step.
template <class Tableau, class Update, class Isotropy, int StageIndex, class Generator, class Real>
struct RungeKuttaStage {
  using Flow = StageDataFlow<Tableau, Update, StageIndex>;
  using value_type = Real;
  using RowArrays = StageArrays<Rows<Real>, Tableau::stages>;
  static constexpr int stages = Tableau::stages, stages_after = stages - 1 - StageIndex;
  static constexpr bool last = Flow::last, turning_alone = needs_turning_alone<Update>;
  /// True if the next stage is at the end of the step.
  static constexpr bool arrives = is_first_same_as_last<Tableau> && StageIndex == stages - 2;

  Generator generator;
  Isotropy isotropy;
  Real dt;

  /// `rows`: StageArrays or DeviceArrays.
  template <class Site, class Arrays>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Arrays const& rows) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real, decltype(rows.level)> const stencil(site, rows.level);
    Vec3<Value> const& m = stencil.center();
    Vec3<Value> const xi = stage_generator(stencil);
    auto const& m0 = spin_at_start(site, rows, m);
    if constexpr (Flow::recovers) {
      site.store(on_chart(site, rows, xi, m, m0), rows.next);
      return;
    }
    Vec3<Value> const a = Value(dt) * xi;

    Vec3<Value> f[std::size_t{stages}];
    unrolled<StageIndex>([&](auto j) {
      if constexpr (Flow::reads_increment(j())) f[j()] = site.load(rows.increments[j]);
    });
    Vec3<Value> argument{Value(0), Value(0), Value(0)};
    if constexpr (Update::increment_needs_argument && StageIndex > 0)
      argument = weighted_sum<StageWeights<Tableau, StageIndex>, StageIndex>(f);

    if constexpr (StageIndex == 0 && Update::increment_needs_argument) {
      f[0] = a;  // the inverse differential at 0 is the identity
    } else {
      f[StageIndex] = Update::increment(argument, a, m, m0);
    }

    if constexpr (last) {
      // Calls are nested, because g++ would copy named values through memory.
      if constexpr (Flow::carried > 0)
        store_compensated(site, rows, f, completed(site, total(site, rows, f), m0), m0);
      else
        site.store(turned_again(f, Update::finish(completed(site, total(site, rows, f), m0), m0)),
                   rows.next);
    } else {
      if constexpr (Flow::writes_sum) site.store(sum_up_to_here(site, rows, f), rows.sum);
      if constexpr (Flow::stores_increment) site.store(f[StageIndex], rows.increment);
      auto const on = weighted_sum<StageWeights<Tableau, StageIndex + 1>, StageIndex + 1>(f);
      site.store(turned_again(f, arrives ? Update::finish(on, m0) : Update::move(on, m0)),
                 rows.next);
    }
  }

 private:
  template <class Site, class Arrays, class Value>
  KOKKOS_FORCEINLINE_FUNCTION static decltype(auto) spin_at_start(Site const& site,
                                                                  Arrays const& rows,
                                                                  Vec3<Value> const& m) {
    if constexpr (Flow::reads_start)
      return site.load(rows.start);
    else
      return (m);  // by reference: g++ would copy a value through memory
  }

  // Returns A + sigma * m, or A if the isotropy acts only at the end of the step. If the update
  // needs only A x m, returns A plus some multiple of m.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto stage_generator(Stencil const& stencil) const {
    using Vector = typename Stencil::vector_type;
    constexpr bool at_the_end = std::is_same_v<Isotropy, isotropy::Energy>;
    static_assert(
        at_the_end || requires(Isotropy const& sigma, Vector const& m) { sigma(m, m); },
        "This isotropy policy does not go with this stepper: Zero and Constant go with all on "
        "the group, FiniteDifference, Analytic and Connection with LieEuler.");
    if constexpr (turning_alone)
      return turning_part(generator, stencil);
    else if constexpr (at_the_end)
      return evaluate(generator, stencil);
    else
      return isotropy(stencil.center(), evaluate(generator, stencil));
  }

  template <class Value, int Index>
  KOKKOS_FORCEINLINE_FUNCTION static Value weight() {
    constexpr double b = Tableau::b[Index];
    return Value(static_cast<scalar_t<Value>>(b));
  }

  // Moves a spin by the tableau's second rotation, if any, to the next stage or the end of the
  // step.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> turned_again(Vec3<Value> const* f,
                                                              Vec3<Value> const& m) {
    if constexpr (has_second_rotation<Tableau>(StageIndex + 1))
      return Update::finish(weighted_sum<SecondWeights<Tableau, StageIndex + 1>, StageIndex + 1>(f),
                            m);
    else
      return m;
  }

  template <class Site, class Arrays, class Value>
  KOKKOS_FORCEINLINE_FUNCTION static void store_compensated(Site const& site, Arrays const& rows,
                                                            Vec3<Value> const* f,
                                                            Vec3<Value> const& on,
                                                            Vec3<Value> const& m0) {
    Vec3<Value> displacement = Update::displacement(on, m0).vector();
    if constexpr (has_second_rotation<Tableau>(stages)) {
      auto const again = weighted_sum<SecondWeights<Tableau, stages>, stages>(f);
      displacement =
          displacement + Update::displacement(again, Vec3<Value>(m0 + displacement)).vector();
    }
    auto const end = rounded_sum(m0, Vec3<Value>(site.load(rows.carried_before[0]) + displacement));
    site.store(end.sum, rows.next);
    site.store(end.residual, rows.carried[0]);
  }

  template <class Site, class Arrays, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> total(Site const& site, Arrays const& rows,
                                                Vec3<Value> const* f) const {
    if constexpr (keeps_sum<Tableau, Update>) {
      return sum_up_to_here(site, rows, f);
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

  // Returns the spin of the next stage. In the last stage it returns the spin at the end of the
  // step; for this it recovers the increment of each earlier stage from the spin of the stage that
  // follows that one.
  template <class Site, class Arrays, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> on_chart(Site const& site, Arrays const& rows,
                                                   Vec3<Value> const& a, Vec3<Value> const& m,
                                                   Vec3<Value> const& m0) const {
    if constexpr (!last) {
      constexpr double factor = Tableau::a[StageIndex + 1][StageIndex];
      Value const step(static_cast<Real>(factor) * dt);
      if constexpr (StageIndex == 0)
        return Update::advance(step, a, m);
      else
        return Update::advance(step, a, m, m0);
    } else {
      Vec3<Value> spins[std::size_t{StageIndex}];
      unrolled<StageIndex - 1>([&](auto j) { spins[j()] = site.load(rows.increments[j]); });
      spins[StageIndex - 1] = m;
      return Update::template arrive<ChartWeights<Tableau>, StageIndex>(Value(dt), a, spins, m0);
    }
  }

  // Returns the stored sum plus this stage's weighted increment. An odd stage also adds the
  // weighted increment of the stage before it, which stored no sum.
  template <class Site, class Arrays, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> sum_up_to_here(Site const& site, Arrays const& rows,
                                                         Vec3<Value> const* f) const {
    Vec3<Value> total = weight<Value, StageIndex>() * f[StageIndex];
    if constexpr (StageIndex % 2 == 1)
      total = multiply_add(weight<Value, StageIndex - 1>(), f[StageIndex - 1], total);
    if constexpr (Flow::reads_sum) total = total + site.load(rows.sum_before);
    return total;
  }
};

}  // namespace cayspin::inline v0_2::detail
