// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "situation.hpp"

namespace cayspin::extremes {

Section temperatures() {
  using enum Fate;
  Section section{"Temperatures",
                  R"(
Methods that take one; damping 0.1, field 1. T = 0 has the bits of a run without [thermal]. `run`
warns where noise turns spins by half a radian a step.)",
                  {exact, bounded, warned, refused, detected},
                  {},
                  {}};
  auto const add = [&](char const* name, Setting setting, double temperature,
                       Against against = Against::nothing) {
    setting.temperature = temperature;
    section.situations.push_back({name, setting, setting, against});
  };
  add("T = 0", {.damping = 0.1}, 0, Against::no_noise);
  add("T 1e-300", {.damping = 0.1, .dt = 1e-12}, 1e-300, Against::solution);
  add("T 1", {.damping = 0.1}, 1);
  add("T 1e3", {.damping = 0.1}, 1e3);
  add("T 1e300", {.damping = 0.1}, 1e300);
  add("field 1e-300", {.field = 1e-300, .damping = 0.1}, 1);
  add("field and T 1e300, dt 1e-303", {.field = 1e300, .damping = 0.1, .dt = 1e-303}, 1e300);
  add("NaN", {.damping = 0.1, .dt = 1e-3, .steps = 20, .shape = {64, 1, 1}, .fault_at = 3}, 1);
  section.situations.back().detected_by = 4;
  return section;
}

Section dear_fields() {
  using enum Fate;
  Section section{"Dear fields",
                  R"(
Methods that take one; damping 0.1, field 1, and a slab's field of 0.5 that is dear.)",
                  {exact, bounded, warned, detected},
                  {exact, drifts, warned, detected},
                  {}};
  auto const add = [&](char const* name, Setting setting, double strength,
                       Against against = Against::nothing) {
    setting.dear = strength;
    section.situations.push_back({name, setting, setting, against});
  };
  add("dt 1e-300", {.damping = 0.1, .dt = 1e-300}, 0.5, Against::solution);
  add("dt 1e-3", {.damping = 0.1, .dt = 1e-3}, 0.5);
  add("dt 1e8", {.damping = 0.1, .dt = 1e8}, 0.5);
  add("1000 substeps", {.damping = 0.1, .substeps = 1000}, 0.5);
  add("strength 1e-300", {.damping = 0.1, .dt = 1e-12}, 1e-300, Against::solution);
  add("strength 1e300, dt 1e-303", {.damping = 0.1, .dt = 1e-303}, 1e300);
  add("NaN", {.damping = 0.1, .dt = 1e-3, .steps = 20, .shape = {64, 1, 1}, .fault_at = 3}, 0.5);
  section.situations.back().detected_by = 4;
  return section;
}

}  // namespace cayspin::extremes
