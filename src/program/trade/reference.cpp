// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "reference.hpp"

#include "simulation/failure.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

namespace cayspin::program::trade {
namespace {

constexpr double enough = 1e-10;
constexpr double tightest = 1e-13;
constexpr int most_halvings = 20;

// The reference is made by these.
Candidate by(char const* method) { return {{.method = io::find_method(method)}}; }

Candidate coarse() {
  auto candidate = by("tsit5");
  candidate.generator = io::Generator::tangent;
  return candidate;
}

}  // namespace

Reference horizon_alone(Pilot const& pilot, double seconds) {
  Reference reference;
  reference.horizon = pilot.end();
  for (int halving = 0; halving < most_halvings; ++halving, reference.horizon /= 2) {
    // From below, so that nothing is run much longer than allowed.
    bool fits = true;
    for (double part = reference.horizon / 64; fits; part *= 4) {
      auto const tried = pilot.run(coarse(), part, {0, 1e-2});
      if (tried.failure) throw NumbersFailed(*tried.failure);
      fits = tried.seconds() <= seconds;
      if (!fits)
        reference.why_shorter = fmt::format("a coarse run to the end takes {:.2g} s",
                                            tried.seconds() * pilot.end() / part);
      if (fits && part == reference.horizon) {
        reference.own_steps = tried.summary.own_steps;
        return reference;
      }
    }
  }
  throw NumbersFailed("no part of the scene is short enough to be tried");
}

Reference converged_reference(Pilot const& pilot, double seconds) {
  auto reference = horizon_alone(pilot, seconds / 40);
  for (int halving = 0; halving < most_halvings; ++halving, reference.horizon /= 2) {
    auto const& horizon = reference.horizon;
    auto first = pilot.run(by("tsit5"), horizon, {0, tightest});
    auto const second = pilot.run(by("dp5"), horizon, {0, tightest});
    reference.uncertainty = distance(first, second);
    if (reference.uncertainty < enough) {
      reference.solution = std::move(first);
      reference.own_steps = pilot.run(coarse(), horizon, {0, 1e-2}).summary.own_steps;
      return reference;
    }
    reference.why_shorter =
        fmt::format("two methods at a tolerance of {:g} differ by {:.1e} at t = {}", tightest,
                    reference.uncertainty, time_text(pilot.scene().units, horizon, 6));
  }
  throw NumbersFailed("there is no reference: " + reference.why_shorter);
}

}  // namespace cayspin::program::trade
