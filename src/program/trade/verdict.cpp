// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "verdict.hpp"

#include <algorithm>

namespace cayspin::program::trade {
namespace {

constexpr std::size_t best_ladders = 3;
constexpr int turns = 3;

// Returns the cheapest few ladders, each with only the rungs that determine its time, cheapest
// first.
std::vector<Ladder> cheapest(std::vector<Ladder> const& ladders, double error) {
  std::vector<Ladder> all;
  for (auto const& ladder : ladders) all.push_back(around(ladder, error));
  std::erase_if(all, [](Ladder const& ladder) { return ladder.rungs.empty(); });
  std::ranges::stable_sort(all, {},
                           [&](Ladder const& ladder) { return seconds_to(ladder, error); });
  if (all.size() > best_ladders) all.resize(best_ladders);
  return all;
}

}  // namespace

Verdict judge(Pilot const& pilot, Reference const& reference, std::vector<Ladder> const& ladders,
              double asked, std::optional<Precision> precision) {
  Verdict verdict{asked, advise(pilot, {asked, {}, precision, nullptr})};
  auto const& choice = verdict.advised.choice;
  if (!choice) return verdict;
  double const horizon = reference.horizon.time;
  verdict.error = reference.solution.measure(choice->candidate, choice->steps, false, {}).error;
  verdict.seconds = infinite;
  auto best = cheapest(ladders, asked);
  for (int turn = 0; turn < turns; ++turn) {
    auto const again = [&](Candidate const& candidate, Steps const& steps, double& seconds) {
      double const now = pilot.run(candidate, horizon, steps, measured_well).seconds();
      seconds = turn == 0 ? now : std::min(seconds, now);
    };
    again(choice->candidate, choice->steps, verdict.seconds);
    for (auto& ladder : best)
      for (auto& rung : ladder.rungs) again(ladder.candidate, rung.steps, rung.seconds);
  }
  verdict.best = infinite;
  for (auto const& ladder : best) verdict.best = std::min(verdict.best, seconds_to(ladder, asked));
  return verdict;
}

}  // namespace cayspin::program::trade
