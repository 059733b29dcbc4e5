// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimize.hpp>
#include <cayspin/path/found.hpp>

namespace cayspin::inline v0_2::detail {

/// Relaxes an end of a path. Adds the evaluations to `unfinished`, and sets its end to what it is
/// if this end does not converge.
template <class Exec, class Field, class Spins>
Minimum relax_end(Exec const& exec, Field const& field, Spins& spins, PathOptions const& options,
                  MinimumEnergyPath& unfinished) {
  auto const found = minimize(
      exec, field, spins,
      {.torque = options.torque,
       .evaluations = options.evaluations,
       .time = options.time,
       .preconditioned = options.preconditioned,
       .observer = [&](Minimum const& now) {
         auto const evaluations = unfinished.evaluations + now.evaluations;
         return options.observer ? options.observer({evaluations, now.energy.value, now.torque})
                                 : Next::proceed;
       }});
  unfinished.evaluations += found.evaluations;
  unfinished.end =
      found.end == MinimizeEnd::interrupted ? PathEnd::interrupted : PathEnd::ends_not_at_rest;
  return found;
}

}  // namespace cayspin::inline v0_2::detail
