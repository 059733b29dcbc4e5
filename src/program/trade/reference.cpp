// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "reference.hpp"

#include "simulation/failure.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cayspin::program::trade {
namespace {

constexpr double enough = 1e-10;
constexpr double tightest = 1e-13;
constexpr int most_halvings = 20;
constexpr int most_fewer = 4;   // halvings, at once
constexpr int most_short = 10;  // steps of a run that is never too long

// The reference is made by these.
Candidate by(char const* method) { return {{.method = io::find_method(method)}}; }

}  // namespace

void Horizon::halve(std::string why) {
  time /= 2;
  own_steps /= 2;
  seconds /= 2;
  why_shorter = std::move(why);
}

Candidate fine_tsit5() {
  auto candidate = by("tsit5");
  candidate.generator = io::Generator::tangent;
  return candidate;
}

Horizon horizon_within(Pilot const& pilot, double seconds) {
  Horizon longest;
  // From below, so that nothing is run much longer than allowed.
  for (int halvings = most_halvings;;) {
    double const time = std::ldexp(pilot.end(), -halvings);
    auto const tried = pilot.run(fine_tsit5(), time, {0, 1e-2});
    if (tried.failure) throw NumbersFailed(*tried.failure);
    auto const own_steps = tried.summary.own_steps;
    if (tried.seconds() > seconds && own_steps > most_short) {
      longest.why_shorter = fmt::format("a coarse run to the end takes {:.2g} s",
                                        std::ldexp(tried.seconds(), halvings));
      break;
    }
    longest = {time, own_steps, tried.seconds()};
    if (halvings == 0) break;
    double const longer = std::log2(seconds / std::max(tried.seconds(), 1e-9));
    int const fewer = own_steps < 3 ? most_fewer : static_cast<int>(longer) / 2;
    halvings -= std::clamp(fewer, 1, std::min(halvings, most_fewer));
  }
  return longest;
}

Reference converged_reference(Pilot const& pilot, double seconds) {
  auto horizon = horizon_within(pilot, seconds / 10);
  for (int halving = 0; halving < most_halvings; ++halving) {
    FineSolution first(pilot, horizon.time, by("tsit5"), tightest);
    double const uncertainty =
        first.distance_to(FineSolution(pilot, horizon.time, by("dp5"), tightest));
    if (uncertainty < enough) {
      first.continue_by(by("rkmk8"), enough);
      horizon.own_steps = pilot.run(fine_tsit5(), horizon.time, {0, 1e-2}).summary.own_steps;
      return {horizon, std::move(first), uncertainty};
    }
    horizon.halve(fmt::format("two methods at a tolerance of {:g} differ by {:.1e} at t = {}",
                              tightest, uncertainty,
                              time_text(pilot.scene().units, horizon.time, 6)));
  }
  throw NumbersFailed("there is no reference: " + horizon.why_shorter);
}

}  // namespace cayspin::program::trade
