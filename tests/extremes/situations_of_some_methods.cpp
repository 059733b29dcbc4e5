// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Situations for only some methods: those with adaptive steps, and those that accept a temperature
// or an expensive field.
#include "situation.hpp"

namespace cayspin::extremes {

using enum Fate;
using enum Against;

Section adaptive_steps() {
  Section section{"Adaptive steps",
                  R"(
Unless a column says otherwise, the field is 1, the damping 0.1, and the tolerance 1e-4 (1e-5 in the
column "on within a step"). Here dt is the time between samples; each run has six after the start.
Unless a column says otherwise, dt is 1/128 in the columns up to "on within a step", and 1 in those
after it. The error stays below 30 times the tolerance, also if the field is switched on within a
step. A run stops if it needs a step shorter than min_dt, if a number overflows, or if an initial
length is wrong. With a damping of 1e12, steps are some 1e-12 long, and only min_dt limits their
number.)",
                  {exact, bounded, refused, detected}};
  section.add("A = 0", {.field = 0, .damping = 0.1}, solution);
  section.add("A along m", {.damping = 0.1, .along_field = true}, solution);
  section.add_denormal();
  section.add("dt 1e-300", {.damping = 0.1, .dt = 1e-300}, solution);
  section.add("1e300, dt 1e-303", {.field = 1e300, .damping = 0.1, .dt = 1e-303});
  section.add("on within a step", {.damping = 0.1, .switched_on_at = 2.5 / 128, .tolerance = 1e-5});
  section.add("damping 0", {.dt = 1});
  section.add("damping 1e-12", {.damping = 1e-12, .dt = 1});
  section.add("damping 1e12, dt 1e-13", {.damping = 1e12, .dt = 1e-13});
  section.add("damping 1e12, min_dt 1e-3", {.damping = 1e12, .dt = 1, .min_dt = 1e-3});
  section.add("min_dt 3", {.damping = 0.1, .dt = 1, .min_dt = 3});
  section.add("tolerance 1", {.damping = 0.1, .dt = 1, .tolerance = 1});
  section.add("tolerance 1e-300", {.damping = 0.1, .dt = 1, .tolerance = 1e-300});
  section.add("1 + 1e-3", {.damping = 0.1, .dt = 1, .start_length = 1.001});
  return section;
}

Section temperatures() {
  Section section{"Temperatures",
                  R"(
The table has the methods with constant steps that accept a temperature. The damping is 0.1 and the
field is 1. In the column "T 1e-300" dt is 1e-12. In the column "NaN" dt is 1e-3, and a spin becomes
NaN after step 3. A run at T = 0 is bit-identical to one without `[thermal]`. `run` warns if noise
turns spins by more than half a radian per step (root mean square).)",
                  {exact, bounded, warned, refused, detected}};
  auto const add = [&](char const* name, Setting setting, double temperature,
                       Against against = nothing, std::int64_t detected_by = 6) {
    setting.temperature = temperature;
    section.add(name, setting, against, detected_by);
  };
  add("T = 0", {.damping = 0.1}, 0, no_noise);
  add("T 1e-300", {.damping = 0.1, .dt = 1e-12}, 1e-300, solution);
  add("T 1", {.damping = 0.1}, 1);
  add("T 1e3", {.damping = 0.1}, 1e3);
  add("T 1e300", {.damping = 0.1}, 1e300);
  add("field 1e-300", {.field = 1e-300, .damping = 0.1}, 1);
  add("field and T 1e300, dt 1e-303", {.field = 1e300, .damping = 0.1, .dt = 1e-303}, 1e300);
  add("NaN", {.damping = 0.1, .dt = 1e-3, .steps = 20, .shape = {64, 1, 1}, .fault_at = 3}, 1,
      nothing, 4);
  return section;
}

Section expensive_fields() {
  Section section{"Expensive fields",
                  R"(
The table has the methods that accept an expensive field. In these runs it is the demagnetising
field of a slab, with strength 0.5 unless a column says otherwise. The damping is 0.1 and the
applied field is 1. In the column "strength 1e-300" dt is 1e-12. In the column "NaN" dt is 1e-3, and
a spin becomes NaN after step 3.)",
                  {exact, bounded, warned, detected},
                  {exact, drifts, warned, detected}};
  auto const add = [&](char const* name, Setting setting, double strength,
                       Against against = nothing, std::int64_t detected_by = 6) {
    setting.multirate = strength;
    section.add(name, setting, against, detected_by);
  };
  add("dt 1e-300", {.damping = 0.1, .dt = 1e-300}, 0.5, solution);
  add("dt 1e-3", {.damping = 0.1, .dt = 1e-3}, 0.5);
  add("dt 1e8", {.damping = 0.1, .dt = 1e8}, 0.5);
  add("1000 substeps", {.damping = 0.1, .substeps = 1000}, 0.5);
  add("strength 1e-300", {.damping = 0.1, .dt = 1e-12}, 1e-300, solution);
  add("strength 1e300, dt 1e-303", {.damping = 0.1, .dt = 1e-303}, 1e300);
  add("NaN", {.damping = 0.1, .dt = 1e-3, .steps = 20, .shape = {64, 1, 1}, .fault_at = 3}, 0.5,
      nothing, 4);
  return section;
}

}  // namespace cayspin::extremes
