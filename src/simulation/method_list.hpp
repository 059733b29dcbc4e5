// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/method.hpp"

#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stepper/tableau_dormand_prince8.hpp>
#include <cayspin/stepper/tableau_order6.hpp>

#include <tuple>
#include <type_traits>

// The methods that a scene can choose, one row each. The rows define the methods' names in scenes,
// the options that each method accepts, the list of `cayspin methods`, the candidates of `cayspin
// trade`, and which steppers are compiled. The file needs no Kokkos, because it only declares
// steppers. To add a tableau, write a struct in cayspin/stepper/tableau.hpp and a row; to add a
// stepper, declare it here and add a row.
namespace cayspin::inline v0_2 {

template <class Spins, class Isotropy, class Rotation>
class LieEuler;
template <class Spins, class Isotropy, class Rotation>
class LieHeun;
template <class Spins, class Isotropy, class Rotation>
class Rkmk4;
template <class Spins, class Tableau, class Isotropy, class Rotation>
class Rkmk;
template <class Spins, class Tableau, class Isotropy, class Rotation>
class AdaptiveRkmk;
template <class Spins, class Tableau>
class StereographicRungeKutta;
template <class Spins, class Tableau>
class AdaptiveStereographic;
template <class Spins, class Tableau>
class ClassicalRungeKutta;
template <class Spins, class Tableau>
class ProjectedRungeKutta;
template <class Spins, class Tableau>
class AdaptiveProjected;
template <class Spins, class Isotropy>
class Rkmk4AsPrinted;
template <class Spins, class Isotropy>
class CommutatorFree4;
template <class Spins, class Isotropy, class Rotation>
class LieAdamsBashforth2;
template <class Spins, class Isotropy, class Rotation>
class ImplicitLieEuler;
template <class Spins>
class ImplicitMidpoint;
template <class Spins, int Order>
class StiffGauss;
template <class Spins>
class AdaptiveStiffGauss2;
template <class Spins, int Order>
class RedBlack;
template <class Spins, class Isotropy, class Series>
class Series4;
namespace detail {
struct DirectSeries;
struct PaperSeries;
}  // namespace detail
namespace isotropy {
struct Zero;
struct Energy;
}  // namespace isotropy
struct Cayley;

}  // namespace cayspin::inline v0_2

namespace cayspin::simulation {

/// A family defines the steppers of a method. Its template Stepper takes the type of the spins, an
/// isotropy and a rotation, and ignores an isotropy or a rotation that the method does not let the
/// user choose. If the method accepts the generator "tangent", the family also has Chart.
namespace family {

template <template <class> class Of>
struct Plain {
  template <class Spins, class, class>
  using Stepper = Of<Spins>;
};
template <template <class, class> class Of>
struct WithIsotropy {
  static constexpr bool takes_sigma = true;
  template <class Spins, class Isotropy, class>
  using Stepper = Of<Spins, Isotropy>;
};
template <template <class, class, class> class Of>
struct WithRotation {
  static constexpr bool takes_sigma = true;
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = Of<Spins, Isotropy, Rotation>;
};
template <template <class, int> class Of, int Order>
struct OfOrder {
  template <class Spins, class, class>
  using Stepper = Of<Spins, Order>;
};

/// A Runge-Kutta method in R^3 instead of on the sphere. Spins leave the sphere unless the method
/// projects them onto it after each step.
template <template <class, class> class Of, class Tableau>
struct InSpace {
  using tableau_type = Tableau;
  template <class Spins, class, class>
  using Stepper = Of<Spins, Tableau>;
};
/// The Runge-Kutta-Munthe-Kaas method of a tableau, and the same tableau in the stereographic
/// chart.
template <class Tableau>
struct Group {
  using tableau_type = Tableau;
  static constexpr bool takes_sigma = true, has_chart = true;
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = Rkmk<Spins, Tableau, Isotropy, Rotation>;
  template <class Spins>
  using Chart = StereographicRungeKutta<Spins, Tableau>;
};
/// Like Group, for a tableau whose stepper is a separate class.
template <template <class, class, class> class Of, class Tableau>
struct GroupBy : Group<Tableau> {
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = Of<Spins, Isotropy, Rotation>;
};
template <class Tableau>
struct AdaptiveGroup {
  using tableau_type = Tableau;
  static constexpr bool takes_sigma = true, has_chart = true;
  template <class Spins, class Isotropy, class Rotation>
  using Stepper = AdaptiveRkmk<Spins, Tableau, Isotropy, Rotation>;
  template <class Spins>
  using Chart = AdaptiveStereographic<Spins, Tableau>;
};

/// The methods of Series4. Spins and rigid bodies have separate variants, and the isotropy "energy"
/// is only for rigid bodies.
template <class Of>
struct Series {
  template <class Spins, class Isotropy, class>
  using Stepper = Series4<Spins,
                          std::conditional_t<std::is_same_v<Isotropy, isotropy::Energy>,
                                             isotropy::Energy, isotropy::Zero>,
                          Of>;
  /// Stepper whose largest stable step is used: without a sigma and for linear equations, steps of
  /// Series4 equal those of RKMK4.
  template <class Spins>
  using StableAs = Rkmk4<Spins, isotropy::Zero, Cayley>;
  static constexpr bool distinguishes_rigid_bodies = true;
  static constexpr int work_fields_of_rigid_bodies = 1;
};

struct Automatic {};

}  // namespace family

namespace sets {
using enum io::Isotropy;
using enum io::Rotation;
using enum io::Generator;
using enum io::Trial;

inline constexpr io::SetOf<io::Rotation> both_rotations{cayley, exponential};
}  // namespace sets

/// A method and its family of steppers. If the family has a tableau, the order is the tableau's,
/// and so is the number of evaluations unless the method is adaptive.
template <class Family>
struct Row : io::Method {
  using family = Family;

  constexpr Row(io::Method const& method) : io::Method(method) {
    if constexpr (requires { typename Family::tableau_type; }) {
      order = Family::tableau_type::order;
      if (!adaptive) evaluations = Family::tableau_type::stages;
    }
  }
};

/// A method on the Lie group. Unless its row says otherwise, it uses Cayley coordinates, accepts
/// the generators standard and orthogonal, and tangent if the family has a chart, and accepts the
/// isotropy zero, and constant if the family takes a sigma.
template <class Family>
constexpr Row<Family> row(io::Method method) {
  using namespace sets;
  if (method.rotations.empty()) method.rotations = {cayley};
  if (method.generators.empty()) {
    method.generators = {standard, orthogonal};
    if constexpr (requires { Family::has_chart; })
      method.generators = {standard, orthogonal, tangent};
  }
  if (method.isotropies.empty()) {
    method.isotropies = {zero};
    if constexpr (requires { Family::takes_sigma; }) method.isotropies = {zero, constant};
  }
  return {method};
}

/// Return the rows of a method in R^3, and of "auto", for which the program chooses a method.
template <template <class, class> class Of, class Tableau>
constexpr Row<family::InSpace<Of, Tableau>> baseline(io::Method const& method) {
  return {method};
}
constexpr Row<family::Automatic> automatic(io::Method const& method) { return {method}; }

inline constexpr auto method_list = [] {
  using namespace sets;
  using namespace family;
  return std::tuple{
      row<GroupBy<LieEuler, tableau::Euler>>(
          {.word = "euler",
           .rotations = both_rotations,
           .isotropies = {zero, constant, analytic, finite_difference, finite_difference_backward},
           .trials = {plain}}),
      row<WithRotation<ImplicitLieEuler>>({.word = "implicit_euler",
                                           .order = 1,
                                           .rotations = both_rotations,
                                           .isotropies = {zero, constant, analytic}}),
      row<GroupBy<LieHeun, tableau::Heun>>({.word = "heun",
                                            .corrects_energy = true,
                                            .rotations = both_rotations,
                                            .trials = {plain, in_chart, single_precision}}),
      row<GroupBy<Rkmk4, tableau::Classical4>>(
          {.word = "rkmk4",
           .compensated = true,
           .corrects_energy = true,
           .rotations = both_rotations,
           .trials = {plain, in_chart, sigma, single_precision, compensated_single_precision}}),
      row<WithIsotropy<Rkmk4AsPrinted>>({.word = "rkmk4_as_printed", .order = 3, .evaluations = 4}),
      row<Group<tableau::Oscillatory64>>({.word = "rkmk64", .trials = {plain, in_chart}}),
      row<Group<tableau::Tsitouras5>>({.word = "rkmk5",
                                       .compensated = true,
                                       .trials = {plain, in_chart, compensated_single_precision}}),
      row<Group<tableau::Oscillatory86>>({.word = "rkmk86", .trials = {plain, in_chart, sigma}}),
      row<Group<tableau::Damped86>>({.word = "rkmk86_damped", .trials = {plain, in_chart}}),
      row<Group<tableau::DormandPrince8>>({.word = "rkmk8", .trials = {plain, in_chart, sigma}}),
      row<Series<cayspin::detail::DirectSeries>>({.word = "series4",
                                                  .order = 4,
                                                  .evaluations = 4,
                                                  .differentiates_field = true,
                                                  .corrects_energy = true,
                                                  .trials = {plain}}),
      row<Series<cayspin::detail::PaperSeries>>({.word = "series4_paper",
                                                 .order = 4,
                                                 .evaluations = 4,
                                                 .differentiates_field = true,
                                                 .corrects_energy = true}),
      row<WithRotation<LieAdamsBashforth2>>({.word = "ab2",
                                             .order = 2,
                                             .evaluations = 1,
                                             .rotations = both_rotations,
                                             .trials = {plain}}),
      row<Plain<ImplicitMidpoint>>({.word = "implicit_midpoint", .order = 2, .trials = {plain}}),
      row<OfOrder<StiffGauss, 2>>({.word = "stiff2", .order = 2, .stiff = true, .trials = {plain}}),
      row<OfOrder<StiffGauss, 4>>({.word = "stiff4", .order = 4, .stiff = true, .trials = {plain}}),
      row<Plain<AdaptiveStiffGauss2>>({.word = "stiff2_adaptive",
                                       .order = 2,
                                       .adaptive = true,
                                       .stiff = true,
                                       .trials = {plain}}),
      row<WithIsotropy<CommutatorFree4>>({.word = "cf4",
                                          .order = 4,
                                          .evaluations = 4,
                                          .rotations = {exponential},
                                          .trials = {plain, sigma}}),
      row<OfOrder<RedBlack, 2>>({.word = "red_black2",
                                 .order = 2,
                                 .evaluations = 1,
                                 .by_colour = true,
                                 .generators = {standard},
                                 .trials = {plain}}),
      row<OfOrder<RedBlack, 4>>({.word = "red_black4",
                                 .order = 4,
                                 .evaluations = 5,
                                 .by_colour = true,
                                 .generators = {standard},
                                 .trials = {plain}}),
      row<AdaptiveGroup<tableau::Tsitouras5>>({.word = "tsit5",
                                               .adaptive = true,
                                               .rotations = both_rotations,
                                               .trials = {plain, in_chart, sigma}}),
      row<AdaptiveGroup<tableau::DormandPrince5>>({.word = "dp5",
                                                   .adaptive = true,
                                                   .rotations = both_rotations,
                                                   .trials = {plain, in_chart, sigma}}),
      row<AdaptiveGroup<tableau::BogackiShampine3>>({.word = "bs3",
                                                     .adaptive = true,
                                                     .rotations = both_rotations,
                                                     .trials = {plain, in_chart}}),
      baseline<ClassicalRungeKutta, tableau::Euler>(
          {.word = "classical_euler", .keeps_length = false}),
      baseline<ClassicalRungeKutta, tableau::Heun>(
          {.word = "classical_heun", .keeps_length = false}),
      baseline<ClassicalRungeKutta, tableau::Classical4>(
          {.word = "classical_rk4", .keeps_length = false}),
      baseline<ProjectedRungeKutta, tableau::Euler>({.word = "projected_euler"}),
      baseline<ProjectedRungeKutta, tableau::Heun>({.word = "projected_heun", .trials = {plain}}),
      baseline<ProjectedRungeKutta, tableau::Classical4>(
          {.word = "projected_rk4",
           .compensated = true,
           .trials = {plain, single_precision, compensated_single_precision}}),
      baseline<ProjectedRungeKutta, tableau::Damped54>(
          {.word = "projected_rk54", .trials = {plain}}),
      baseline<ProjectedRungeKutta, tableau::Oscillatory64>(
          {.word = "projected_rk64", .trials = {plain}}),
      baseline<ProjectedRungeKutta, tableau::Oscillatory74>(
          {.word = "projected_rk74", .trials = {plain, single_precision}}),
      baseline<ProjectedRungeKutta, tableau::Oscillatory86>(
          {.word = "projected_rk86", .trials = {plain}}),
      baseline<ProjectedRungeKutta, tableau::DormandPrince5>(
          {.word = "projected_rk5",
           .compensated = true,
           .trials = {plain, compensated_single_precision}}),
      baseline<ProjectedRungeKutta, tableau::DormandPrince8>(
          {.word = "projected_rk8", .trials = {plain}}),
      baseline<AdaptiveProjected, tableau::DormandPrince5>(
          {.word = "projected_dp5", .adaptive = true, .trials = {plain}}),
      automatic({.word = "auto", .automatic = true})};
}();

}  // namespace cayspin::simulation
