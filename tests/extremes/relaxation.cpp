// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "../support/larger.hpp"
#include "setting_scene.hpp"
#include "simulation/scene_field.hpp"
#include "trial.hpp"

#include <cayspin/minimize.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace cayspin::extremes {
namespace {

using HostSpace = Kokkos::DefaultHostExecutionSpace;

template <class Real>
Outcome relax(Setting const& setting, Against against, io::Scene const& scene, Plan const& plan) {
  using Spins = SpinField<Real, HostSpace::memory_space>;
  Spins spins("spins", plan.lattice);
  copy_from_host(io::initial_spins(scene), spins);
  if (setting.fault_at >= 0)
    spins.set(spins.sites() / 2, {std::numeric_limits<Real>::quiet_NaN(), Real(0), Real(1)});
  auto const start = copy_to_host(spins);
  Minimum found;
  try {
    found = minimize(HostSpace(),
                     field_of<Spins>(scene, plan.lattice, false).made_for(FieldFor::energy), spins,
                     {.torque = setting.torque});
  } catch (std::invalid_argument const& error) {
    bool const by_bound = setting.torque < Minimizer<Spins>::least_bound;
    return {.fate = by_bound ? Fate::refused : Fate::detected, .step = 0, .message = error.what()};
  }
  if (found.end != MinimizeEnd::converged)
    return {.fate = Fate::detected,
            .step = found.iterations,
            .message = std::string(to_string(found.end))};

  constexpr double eps = std::numeric_limits<Real>::epsilon();
  auto const end = copy_to_host(spins);
  double off = 0, error = 0;
  for (std::size_t i = 0; i < end.size(); i += 3) {
    double const x = end[i], y = end[i + 1], z = end[i + 2], length = std::hypot(x, y, z);
    off = cayspin::test::larger(off, std::abs(length - 1));
    error = cayspin::test::larger(error, std::hypot(x / length, y / length, z / length - 1));
  }
  // A torque below the bound leaves each spin within about torque / field (radians) of the field.
  bool const rests = against == Against::solution && error <= 2 * setting.torque / setting.field;
  Fate const fate = off > 4 * eps  ? Fate::drifts
                    : end == start ? Fate::exact
                    : rests        ? Fate::bounded
                                   : Fate::drifts;
  return {fate, -1, 1, off / eps, error / eps, {}};
}

}  // namespace

Outcome try_to_relax(Integrator const& integrator, Situation const& situation,
                     Precision precision) {
  bool const in_double = precision == Precision::double_precision;
  auto const& setting = in_double ? situation.in_double : situation.in_single;
  auto const scene = scene_of(integrator, setting);
  auto const plan = make_plan(scene, precision);
  return in_double ? relax<double>(setting, situation.against, scene, plan)
                   : relax<float>(setting, situation.against, scene, plan);
}

Section equilibria() {
  using enum Fate;
  Section section{"Equilibria",
                  R"(
Unless a column says otherwise, the search of `cayspin relax` starts from random spins with exchange
1 in a field of 1, and ends when the torque is below 1e-6. In the first two columns there is no
exchange. In this table "exact" means that all spins stay bit-identical, and "bounded" that all
spins end along the field.)",
                  {exact, bounded, refused, detected}};
  auto const add = [&](char const* name, Setting setting, Against against) {
    setting.steps = 1;
    if (setting.shape == std::array<std::int64_t, 3>{1, 1, 1} && setting.initial.empty() &&
        !setting.along_field) {
      setting.shape = {7, 5, 3};
      setting.initial = "random = { seed = 4 }";
    }
    section.add(name, setting, against, 100'000);
  };
  std::string const against_field = "uniform = [0, 0, -1]", at_angle = "uniform = [0.6, 0, 0.8]";
  add("no field", {.field = 0, .exchange = 0}, Against::start);
  add("field 1e-300", {.field = 1e-300, .exchange = 0}, Against::start);
  add("m along H", {.shape = {7, 5, 3}, .along_field = true}, Against::start);
  add("m against H", {.shape = {7, 5, 3}, .initial = against_field}, Against::solution);
  add("one spin", {.initial = at_angle}, Against::solution);
  add("exchange 1e6", {.exchange = 1e6}, Against::solution);
  add("exchange 1e300", {.exchange = 1e300}, Against::solution);
  add("field 1e30, bound 1e24", {.field = 1e30, .torque = 1e24}, Against::solution);
  add("field 1e300", {.field = 1e300}, Against::solution);
  add("bound 1e-200", {.torque = 1e-200}, Against::solution);
  add("NaN", {.fault_at = 0}, Against::solution);
  return section;
}

}  // namespace cayspin::extremes
