// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "situation.hpp"

#include <limits>
#include <numbers>

namespace cayspin::extremes {
namespace {

using enum Fate;
using enum Against;

Situation both(std::string name, Setting const& setting, Against against = nothing) {
  return {std::move(name), setting, setting, against};
}

Section steps() {
  Section section{"Steps",
                  R"(
One spin in a field of 1, damping 0.1, dt from 1e-300 to 1e300. Runs are exact where nothing
moves by an epsilon, then bounded. `run` warns above the stable dt, or above 2 radians a step
where none is known. ab2 is unstable already at dt 1, which is detected.)",
                  {exact, bounded, warned, detected},
                  {exact, drifts, warned},
                  {}};
  for (char const* dt : {"1e-300", "1e-12", "1e-3", "1", "1e8", "1e160", "1e300"}) {
    double const number = std::stod(dt);
    section.situations.push_back(both(std::string("dt ") + dt, {.damping = 0.1, .dt = number},
                                      number < 1e-9 ? solution : nothing));
  }
  return section;
}

Section turns() {
  Section section{"Turns",
                  R"(
One spin or body, damping 0. dt |A| is pi, which the Cayley map cannot rotate by; 2 pi, where
the exponential's inverse tangent has its pole; 1e8; and 1e160, whose square overflows. `run`
warns in all four. The exponential is exact where A rests, up to 1e8. An overflow stops the run at
its first step.)",
                  {exact, warned},
                  {warned},
                  {}};
  auto const add = [&](char const* name, double turn) {
    section.situations.push_back(both(name, {.field = 128 * turn}, solution));
  };
  add("pi", std::numbers::pi);
  add("2 pi", 2 * std::numbers::pi);
  add("1e8", 1e8);
  add("1e160", 1e160);
  return section;
}

Section fields() {
  using Double = std::numeric_limits<double>;
  using Single = std::numeric_limits<float>;
  Section section{"Fields",
                  R"(
Damping 0.1. A spin without a field, or along it, rests. Numbers below the smallest normal one
count as zero: rates err by at most 2.3e-308, in single precision 1.2e-38. Numbers too large
stop the run at its first step. A field that is switched on within a step costs every method its
order there: the error is at most dt times the field.)",
                  {exact, bounded, warned, refused, detected},
                  {exact, drifts, detected},
                  {both("A = 0", {.field = 0, .damping = 0.1}, solution),
                   both("A along m", {.damping = 0.1, .along_field = true}, solution),
                   {"denormal",
                    {.field = Double::min() / 16, .damping = 0.1},
                    {.field = Single::min() / 16, .damping = 0.1},
                    solution},
                   both("1e300, dt 1e-303", {.field = 1e300, .damping = 0.1, .dt = 1e-303}),
                   both("on within a step", {.damping = 0.1, .switched_on_at = 2.5 / 128})}};
  section.situations[3].detected_by = 1;
  return section;
}

Section dampings() {
  Section section{"Damping",
                  R"(
One spin in a field of 1. At damping 1e-12 a method may add more energy than the damping takes:
`run` warns, or stops when the energy rises. 1e12 is far above the stable dt.)",
                  {bounded, warned, refused, detected},
                  {drifts, warned},
                  {}};
  for (char const* damping : {"0", "1e-12", "1e12"})
    section.situations.push_back(
        both(damping, {.damping = std::stod(damping), .asks_for_damping = true}));
  return section;
}

Section starts() {
  Section section{
      "Starts",
      R"(
The program normalises every start. Here the length is wrong all the same. More than 64 epsilon
are detected before the first step; one ulp is kept or normalised away. `classical_*` are not
checked.)",
      {bounded, warned, detected},
      {drifts},
      {both("1 + 1e-3", {.damping = 0.1, .dt = 1e-3, .start_length = 1.001}),
       {"1 + ulp",
        {.damping = 0.1, .dt = 1e-3, .start_length = 1 + std::numeric_limits<double>::epsilon()},
        {.damping = 0.1,
         .dt = 1e-3,
         .start_length = 1 + static_cast<double>(std::numeric_limits<float>::epsilon())}}}};
  for (auto& situation : section.situations) situation.detected_by = 0;
  return section;
}

Section lattices() {
  Section section{"Lattices",
                  R"(
Uniform spins with exchange 1 in a field of 1, damping 0.1, dt 1e-3. Exact: each spin is where
one alone is, to 8 epsilon. fx and red_black are bounded. A lattice that does not fit is refused
with what it needs and what there is.)",
                  {exact, refused},
                  {exact, refused},
                  {}};
  auto const add = [&](char const* name, std::array<std::int64_t, 3> const& shape) {
    section.situations.push_back(
        both(name, {.damping = 0.1, .dt = 1e-3, .shape = shape}, one_spin));
  };
  add("1", {1, 1, 1});
  add("2", {2, 1, 1});
  add("13", {13, 1, 1});
  add("7 x 5 x 3", {7, 5, 3});
  add("1 x 1 x 11", {1, 1, 11});
  add("3e8 x 3e6", {300'000'000, 3'000'000, 1});
  return section;
}

Section faults() {
  Setting few{.damping = 0.1, .dt = 1e-3, .steps = 20, .shape = {64, 1, 1}, .fault_at = 3};
  Setting many = few;
  many.shape = {5000, 1, 1};
  Section section{"Faults",
                  R"(
64 spins, and 5000, one of which becomes NaN after step 3. The guard detects it at the next
step, above 4096 sites within ten steps. No frame is written after the fault.)",
                  {detected},
                  {detected},
                  {both("64 spins", few), both("5000 spins", many)}};
  section.situations[0].detected_by = 4;
  section.situations[1].detected_by = 13;
  return section;
}

Section drift() {
  Setting alone{.steps = 5000};
  Setting newton = alone;
  newton.normalized = 100;
  return {"Drift",
          R"(
One spin, damping 0, 5000 steps. `Every(100, Normalize{})`, a Newton step towards |m| = 1 every
100 steps, keeps | |m| - 1 | below 4 epsilon times 100 whatever the number of steps.)",
          {bounded, warned},
          {drifts, warned},
          {both("alone", alone), both("with Newton steps", newton)}};
}

}  // namespace

std::string to_string(Fate fate) {
  switch (fate) {
    case exact:
      return "exact";
    case bounded:
      return "bounded";
    case warned:
      return "warned";
    case drifts:
      return "drifts";
    case refused:
      return "refused";
    case detected:
      return "detected";
  }
  return "";
}

std::vector<Section> sections() {
  return {steps(), turns(), fields(), dampings(), starts(), lattices(), faults(), drift()};
}

Section longest_runs() {
  Setting alone{.dt = 0.37, .steps = 100'000'000};
  Setting newton = alone;
  newton.normalized = 1000;
  Section section{"1e8 steps",
                  R"(
One spin in a field of 1, dt 0.37, rkmk4 in both rotations. Round-off adds up where steps are
alike: | |m| - 1 | grows by some 0.01 epsilon a step, to 3e-10 in double precision. In single
precision it reaches 0.01 after some 7e6 steps, where the run stops. A Newton step every 1000
steps keeps it below an epsilon.)",
                  {bounded, detected},
                  {},
                  {both("alone", alone), both("with Newton steps", newton)}};
  for (auto& situation : section.situations) situation.detected_by = alone.steps;
  return section;
}

}  // namespace cayspin::extremes
