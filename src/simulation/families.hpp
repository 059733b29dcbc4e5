// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "method_list.hpp"

#include <cayspin/stepper/adaptive_runge_kutta.hpp>
#include <cayspin/stepper/adaptive_stiff_gauss.hpp>
#include <cayspin/stepper/corrected_euler.hpp>
#include <cayspin/stepper/field_extrapolation.hpp>
#include <cayspin/stepper/implicit.hpp>
#include <cayspin/stepper/methods.hpp>
#include <cayspin/stepper/red_black.hpp>
#include <cayspin/stepper/series4.hpp>
#include <cayspin/stepper/stiff_gauss.hpp>
#include <cayspin/stepper/two_point.hpp>

#include <cayspin_paper/rkmk4_as_printed.hpp>

// The types behind the rows of the list of methods: Stepper for spins, an isotropy and a rotation,
// as far as these are the stepper's choice; Chart where the method takes the generator "tangent".
namespace cayspin::simulation::family {

/// A tableau's steps in the stereographic chart.
template <class Tableau>
struct InChart {
  template <class Spins>
  using Chart = StereographicRungeKutta<Spins, Tableau>;
};

template <class Tableau>
struct Group : InChart<Tableau> {
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = Rkmk<Spins, Tableau, Isotropy, Rotation>;
};
template <>
struct Group<tableau::Euler> : InChart<tableau::Euler> {
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = LieEuler<Spins, Isotropy, Rotation>;
};
template <>
struct Group<tableau::Heun> : InChart<tableau::Heun> {
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = LieHeun<Spins, Isotropy, Rotation>;
};
template <>
struct Group<tableau::Classical4> : InChart<tableau::Classical4> {
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = Rkmk4<Spins, Isotropy, Rotation>;
};

template <class Tableau>
struct Classical {
  template <class Spins, class, class>
  using Stepper = ClassicalRungeKutta<Spins, Tableau>;
};
template <class Tableau>
struct Projected {
  template <class Spins, class, class>
  using Stepper = ProjectedRungeKutta<Spins, Tableau>;
};

template <class Tableau>
struct AdaptiveGroup {
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = AdaptiveRkmk<Spins, Tableau, Isotropy, Rotation>;
  template <class Spins>
  using Chart = AdaptiveStereographic<Spins, Tableau>;
};
template <class Tableau>
struct AdaptiveProjected {
  template <class Spins, class, class>
  using Stepper = cayspin::AdaptiveProjected<Spins, Tableau>;
};

struct AsPrinted {
  template <class Spins, class Isotropy, class>
  using Stepper = Rkmk4AsPrinted<Spins, Isotropy>;
};
struct CommutatorFree {
  template <class Spins, class Isotropy, class>
  using Stepper = CommutatorFree4<Spins, Isotropy>;
};
struct AdamsBashforth {
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = LieAdamsBashforth2<Spins, Isotropy, Rotation>;
};
struct ImplicitEuler {
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = ImplicitLieEuler<Spins, Isotropy, Rotation>;
};
struct ImplicitMidpoint {
  template <class Spins, class, class>
  using Stepper = cayspin::ImplicitMidpoint<Spins>;
};
template <int Order>
struct Stiff {
  template <class Spins, class, class>
  using Stepper = StiffGauss<Spins, Order>;
};
struct AdaptiveStiff {
  template <class Spins, class, class>
  using Stepper = AdaptiveStiffGauss2<Spins>;
};
template <int Order>
struct FieldExtrapolation {
  template <class Spins, class, class>
  using Stepper =
      std::conditional_t<Order == 3, FieldExtrapolation3<Spins>, FieldExtrapolation4<Spins>>;
};
template <int Order>
struct RedBlack {
  template <class Spins, class, class>
  using Stepper = cayspin::RedBlack<Spins, Order>;
};

/// The series know spins and rigid bodies as types, and energy as an isotropy of the latter.
template <template <class, class> class Of>
struct SeriesOf {
  template <class Spins, class Isotropy, class>
  using Stepper = Of<Spins, std::conditional_t<std::is_same_v<Isotropy, isotropy::Energy>,
                                               isotropy::Energy, isotropy::Zero>>;
  /// Without a sigma its linear stages are those of RKMK4.
  template <class Spins>
  using StableAs = Rkmk4<Spins>;
  static constexpr bool distinguishes_rigid_bodies = true;
  static constexpr int work_fields_of_rigid_bodies = 1;
};
template <class Spins, class Isotropy>
using DirectSeries4 = Series4<Spins, Isotropy>;
struct Series : SeriesOf<DirectSeries4> {};
struct PaperSeries : SeriesOf<Series4Paper> {};

}  // namespace cayspin::simulation::family
