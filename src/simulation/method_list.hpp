// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/io/method.hpp>
#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stepper/tableau_dormand_prince8.hpp>
#include <cayspin/stepper/tableau_order6.hpp>

#include <tuple>

// The methods of scenes, one row each. From here come the words of scenes and what they refuse,
// `cayspin methods`, the candidates of `cayspin trade`, the tables of extremes, and what is
// compiled. No Kokkos is needed to read it. A new tableau is a struct in
// cayspin/stepper/tableau.hpp and a row.
namespace cayspin::simulation {

/// What makes the steppers of a method. Defined in families.hpp.
namespace family {
template <class Tableau>
struct Group;  // Runge-Kutta-Munthe-Kaas, and the same tableau in the stereographic chart
template <class Tableau>
struct Classical;  // Runge-Kutta in space
template <class Tableau>
struct Projected;  // the same, each step divided by the length
template <class Tableau>
struct AdaptiveGroup;
template <class Tableau>
struct AdaptiveProjected;
struct AsPrinted;
struct CommutatorFree;
struct AdamsBashforth;
struct ImplicitEuler;
struct ImplicitMidpoint;
struct Series;
struct PaperSeries;
struct Automatic;
template <int Order>
struct FieldExtrapolation;
template <int Order>
struct RedBlack;
template <int Order>
struct Stiff;
struct AdaptiveStiff;
}  // namespace family

/// A method and what makes its steppers.
template <class Family>
struct Row : io::Method {
  using family = Family;
};

/// A row whose order and evaluations are those that it says.
template <class Family>
struct RowOf {
  static constexpr Row<Family> with(io::Method method) { return {method}; }
};

/// Those of a tableau are its own.
template <template <class> class Family, class Tableau>
struct RowOf<Family<Tableau>> {
  static constexpr Row<Family<Tableau>> with(io::Method method) {
    method.order = Tableau::order;
    if (!method.adaptive) method.evaluations = Tableau::stages;
    return {method};
  }
};

template <class Family>
constexpr Row<Family> row(io::Method const& method) {
  return RowOf<Family>::with(method);
}

/// A method on the Lie group: in Cayley coordinates, with the generators default and orthogonal and
/// no sigma, where the row says nothing else.
constexpr io::Method lie(io::Method method) {
  if (method.rotations.empty()) method.rotations = {io::Rotation::cayley};
  if (method.generators.empty())
    method.generators = {io::Generator::standard, io::Generator::orthogonal};
  if (method.isotropies.empty()) method.isotropies = {io::Isotropy::zero};
  return method;
}

namespace sets {
using enum io::Isotropy;
using enum io::Rotation;
using enum io::Generator;
using enum io::SystemKind;
using enum io::Neighbors;
using enum io::Trial;

inline constexpr io::SetOf<io::Rotation> both_rotations{cayley, exponential};
inline constexpr io::SetOf<io::Generator> with_chart{standard, orthogonal, tangent};
inline constexpr io::SetOf<io::Isotropy> a_number{zero, constant};
}  // namespace sets

inline constexpr auto method_list = [] {
  using namespace sets;
  using namespace family;
  return std::tuple{
      row<Group<tableau::Euler>>(lie(
          {.word = "euler",
           .rotations = both_rotations,
           .generators = with_chart,
           .isotropies = {zero, constant, analytic, finite_difference, finite_difference_backward},
           .energy_kinds = {llg},
           .trials = {plain}})),
      row<ImplicitEuler>(lie({.word = "implicit_euler",
                              .order = 1,
                              .rotations = both_rotations,
                              .isotropies = {zero, constant, analytic}})),
      row<Group<tableau::Heun>>(lie({.word = "heun",
                                     .rotations = both_rotations,
                                     .generators = with_chart,
                                     .isotropies = a_number,
                                     .energy_kinds = {llg, rigid_body},
                                     .trials = {plain, in_chart, single_precision}})),
      row<Group<tableau::Classical4>>(lie(
          {.word = "rkmk4",
           .compensated = true,
           .rotations = both_rotations,
           .generators = with_chart,
           .isotropies = a_number,
           .energy_kinds = {llg, rigid_body},
           .trials = {plain, in_chart, sigma, single_precision, compensated_single_precision}})),
      row<AsPrinted>(
          lie({.word = "rkmk4_as_printed", .order = 3, .evaluations = 4, .isotropies = a_number})),
      row<Group<tableau::Oscillatory64>>(lie({.word = "rkmk64",
                                              .generators = with_chart,
                                              .isotropies = a_number,
                                              .trials = {plain, in_chart}})),
      row<Group<tableau::Tsitouras5>>(
          lie({.word = "rkmk5",
               .compensated = true,
               .generators = with_chart,
               .isotropies = a_number,
               .trials = {plain, in_chart, compensated_single_precision}})),
      row<Group<tableau::Oscillatory86>>(lie({.word = "rkmk86",
                                              .generators = with_chart,
                                              .isotropies = a_number,
                                              .trials = {plain, in_chart, sigma}})),
      row<Group<tableau::Damped86>>(lie({.word = "rkmk86_damped",
                                         .generators = with_chart,
                                         .isotropies = a_number,
                                         .trials = {plain, in_chart}})),
      row<Group<tableau::DormandPrince8>>(lie({.word = "rkmk8",
                                               .generators = with_chart,
                                               .isotropies = a_number,
                                               .trials = {plain, in_chart, sigma}})),
      row<Series>(lie({.word = "series4",
                       .order = 4,
                       .evaluations = 4,
                       .differentiates_field = true,
                       .energy_kinds = {rigid_body},
                       .trials = {plain}})),
      row<PaperSeries>(lie({.word = "series4_paper",
                            .order = 4,
                            .evaluations = 4,
                            .differentiates_field = true,
                            .energy_kinds = {rigid_body}})),
      row<AdamsBashforth>(lie({.word = "ab2",
                               .order = 2,
                               .evaluations = 1,
                               .rotations = both_rotations,
                               .isotropies = a_number,
                               .trials = {plain}})),
      row<ImplicitMidpoint>(lie({.word = "implicit_midpoint", .order = 2, .trials = {plain}})),
      row<Stiff<2>>(lie({.word = "stiff2", .order = 2, .stiff = true, .trials = {plain}})),
      row<Stiff<4>>(lie({.word = "stiff4", .order = 4, .stiff = true, .trials = {plain}})),
      row<AdaptiveStiff>(lie({.word = "stiff2_adaptive",
                              .order = 2,
                              .adaptive = true,
                              .stiff = true,
                              .trials = {plain}})),
      row<CommutatorFree>(lie({.word = "cf4",
                               .order = 4,
                               .evaluations = 4,
                               .rotations = {exponential},
                               .isotropies = a_number,
                               .trials = {plain, sigma}})),
      row<FieldExtrapolation<3>>(lie({.word = "fx3",
                                      .order = 3,
                                      .evaluations = 1,
                                      .neighbors = predicted,
                                      .trials = {plain}})),
      row<FieldExtrapolation<4>>(lie({.word = "fx4",
                                      .order = 4,
                                      .evaluations = 1,
                                      .neighbors = predicted,
                                      .trials = {plain}})),
      row<RedBlack<2>>(lie({.word = "red_black2",
                            .order = 2,
                            .evaluations = 1,
                            .neighbors = by_colour,
                            .generators = {standard},
                            .trials = {plain}})),
      row<RedBlack<4>>(lie({.word = "red_black4",
                            .order = 4,
                            .evaluations = 5,
                            .neighbors = by_colour,
                            .generators = {standard},
                            .trials = {plain}})),
      row<AdaptiveGroup<tableau::Tsitouras5>>(lie({.word = "tsit5",
                                                   .adaptive = true,
                                                   .rotations = both_rotations,
                                                   .generators = with_chart,
                                                   .isotropies = a_number,
                                                   .trials = {plain, in_chart, sigma}})),
      row<AdaptiveGroup<tableau::DormandPrince5>>(lie({.word = "dp5",
                                                       .adaptive = true,
                                                       .rotations = both_rotations,
                                                       .generators = with_chart,
                                                       .isotropies = a_number,
                                                       .trials = {plain, in_chart, sigma}})),
      row<AdaptiveGroup<tableau::BogackiShampine3>>(lie({.word = "bs3",
                                                         .adaptive = true,
                                                         .rotations = both_rotations,
                                                         .generators = with_chart,
                                                         .isotropies = a_number,
                                                         .trials = {plain, in_chart}})),
      row<Classical<tableau::Euler>>({.word = "classical_euler", .keeps_length = false}),
      row<Classical<tableau::Heun>>({.word = "classical_heun", .keeps_length = false}),
      row<Classical<tableau::Classical4>>({.word = "classical_rk4", .keeps_length = false}),
      row<Projected<tableau::Euler>>({.word = "projected_euler"}),
      row<Projected<tableau::Heun>>({.word = "projected_heun", .trials = {plain}}),
      row<Projected<tableau::Classical4>>(
          {.word = "projected_rk4",
           .compensated = true,
           .trials = {plain, single_precision, compensated_single_precision}}),
      row<Projected<tableau::Oscillatory64>>({.word = "projected_rk64", .trials = {plain}}),
      row<Projected<tableau::Oscillatory74>>(
          {.word = "projected_rk74", .trials = {plain, single_precision}}),
      row<Projected<tableau::Oscillatory86>>({.word = "projected_rk86", .trials = {plain}}),
      row<Projected<tableau::DormandPrince5>>({.word = "projected_rk5",
                                               .compensated = true,
                                               .trials = {plain, compensated_single_precision}}),
      row<Projected<tableau::DormandPrince8>>({.word = "projected_rk8", .trials = {plain}}),
      row<AdaptiveProjected<tableau::DormandPrince5>>(
          {.word = "projected_dp5", .adaptive = true, .trials = {plain}}),
      row<Automatic>({.word = "auto", .automatic = true})};
}();

}  // namespace cayspin::simulation
