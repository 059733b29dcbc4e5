// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "situation.hpp"

#include <limits>

namespace cayspin::extremes {

Section adaptive_steps() {
  using enum Fate;
  using Double = std::numeric_limits<double>;
  using Single = std::numeric_limits<float>;
  Section section{"Adaptive steps",
                  R"(
The tolerance is 1e-4 and the field 1 unless the table says otherwise; dt is from one look to the
next, and t runs from 0 to 6 or 6/128. The error stays below 30 times the tolerance, also where
the field is switched on within a step. A run stops when a step would have to be below min_dt,
when numbers are too large for the precision, and when the start is wrong. Damping of 1e12 takes
steps of 1e-12: only min_dt bounds their number.)",
                  {exact, bounded, refused, detected},
                  {},
                  {}};
  auto const add = [&](char const* name, Setting const& setting,
                       Against against = Against::nothing) {
    section.situations.push_back({name, setting, setting, against});
  };
  add("A = 0", {.field = 0, .damping = 0.1}, Against::solution);
  add("A along m", {.damping = 0.1, .along_field = true}, Against::solution);
  section.situations.push_back({"denormal",
                                {.field = Double::min() / 16, .damping = 0.1},
                                {.field = Single::min() / 16, .damping = 0.1},
                                Against::solution});
  add("dt 1e-300", {.damping = 0.1, .dt = 1e-300}, Against::solution);
  add("1e300, dt 1e-303", {.field = 1e300, .damping = 0.1, .dt = 1e-303});
  add("on within a step", {.damping = 0.1, .switched_on_at = 2.5 / 128, .tolerance = 1e-5});
  add("damping 0", {.dt = 1});
  add("damping 1e-12", {.damping = 1e-12, .dt = 1});
  add("damping 1e12, dt 1e-13", {.damping = 1e12, .dt = 1e-13});
  add("damping 1e12, min_dt 1e-3", {.damping = 1e12, .dt = 1, .min_dt = 1e-3});
  add("min_dt 3", {.damping = 0.1, .dt = 1, .min_dt = 3});
  add("tolerance 1", {.damping = 0.1, .dt = 1, .tolerance = 1});
  add("tolerance 1e-300", {.damping = 0.1, .dt = 1, .tolerance = 1e-300});
  add("1 + 1e-3", {.damping = 0.1, .dt = 1, .start_length = 1.001});
  return section;
}

}  // namespace cayspin::extremes
