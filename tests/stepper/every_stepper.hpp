// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/landau_lifshitz.hpp"

#include <cayspin/stepper/gauss_legendre.hpp>
#include <cayspin/stepper/stiff_gauss.hpp>

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>

#include <string>

namespace cayspin::test {

/// Says whether a stepper accepts nonlocal fields, and whether it counts evaluations of the field.
struct Takes {
  bool nonlocal = true, counts_fields = true;
};

/// Calls visit(name, make, takes) for one stepper of each kind; make(like) returns a new one.
template <class Field, class Visit>
void for_each_stepper(Visit const& visit) {
  visit(
      "LieEuler", [](Field const& like) { return LieEuler(like); }, Takes());
  visit(
      "LieHeun", [](Field const& like) { return LieHeun(like); }, Takes());
  visit(
      "Rkmk4, swept",
      [](Field const& like) {
        Rkmk4 stepper(like);
        stepper.use(Path::sweep);
        return stepper;
      },
      Takes());
  visit(
      "Compensated", [](Field const& like) { return Compensated<Rkmk4<Field>>(like); }, Takes());
  visit(
      "LieEuler, Analytic", [](Field const& like) { return LieEuler(like, isotropy::Analytic()); },
      Takes());
  visit(
      "LieEuler, FiniteDifference",
      [](Field const& like) { return LieEuler(like, isotropy::FiniteDifference()); }, Takes());
  visit(
      "LieEuler, FiniteDifferenceBackward",
      [](Field const& like) { return LieEuler(like, isotropy::FiniteDifferenceBackward()); },
      Takes());
  visit(
      "LieAdamsBashforth2", [](Field const& like) { return LieAdamsBashforth2(like); }, Takes());
  visit(
      "ImplicitMidpoint", [](Field const& like) { return ImplicitMidpoint(like); }, Takes());
  visit(
      "Series4", [](Field const& like) { return Series4(like); }, Takes());
  visit(
      "RedBlack4", [](Field const& like) { return RedBlack4(like); },
      Takes{.nonlocal = false, .counts_fields = false});
  visit(
      "AdaptiveRkmk",
      [](Field const& like) {
        return AdaptiveRkmk<Field, tableau::BogackiShampine3>(like, {.tolerance = 1e-4});
      },
      Takes());
  visit(
      "StiffGauss2", [](Field const& like) { return StiffGauss2(like); }, Takes());
  visit(
      "AdaptiveStiffGauss2",
      [](Field const& like) { return AdaptiveStiffGauss2(like, {.tolerance = 1e-4}); }, Takes());
}

}  // namespace cayspin::test
