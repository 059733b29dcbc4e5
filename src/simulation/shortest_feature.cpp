// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "shortest_feature.hpp"

#include "time_samples.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace cayspin::simulation {
namespace {

using Points = std::vector<std::pair<double, double>>;  // t and value, ascending in t

// Returns the indices of the extremes after which the values turn back by more than `height`,
// preceded by the index of the first point and followed by that of the last extreme.
std::vector<std::size_t> turning_points(Points const& points, double height) {
  std::vector<std::size_t> turns{0};
  std::size_t extreme = 0;
  int direction = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    double const beyond = points[i].second - points[extreme].second;
    if (direction == 0 && std::abs(beyond) > height) {
      direction = beyond > 0 ? 1 : -1;
      extreme = i;
    } else if (direction * beyond > 0) {
      extreme = i;
    } else if (direction != 0 && std::abs(beyond) > height) {
      turns.push_back(extreme);
      direction = -direction;
      extreme = i;
    }
  }
  turns.push_back(extreme);
  return turns;
}

// Returns the time nearest to point `from` at which the value crosses `level`, if it does: after
// that point, or before it if `direction` is negative.
std::optional<double> crossing(Points const& points, std::size_t from, int direction,
                               double level) {
  bool const above = points[from].second > level;
  auto at = from;
  while (direction > 0 ? at + 1 < points.size() : at > 0) {
    auto const next = direction > 0 ? at + 1 : at - 1;
    if ((points[next].second > level) != above) {
      double const share = (level - points[at].second) / (points[next].second - points[at].second);
      return points[at].first + share * (points[next].first - points[at].first);
    }
    at = next;
  }
  return std::nullopt;
}

}  // namespace

std::optional<TimeFeatures::Shortest> shortest_feature(TimeSamples const& samples) {
  constexpr double least_height = 1e-3;
  std::optional<TimeFeatures::Shortest> shortest;
  for (std::size_t c = 0; c < samples.components(); ++c) {
    double const range = samples.range(c);
    if (range == 0) continue;
    auto const points = samples.all(c);
    auto const turns = turning_points(points, least_height * range);
    for (std::size_t i = 1; i + 1 < turns.size(); ++i) {
      auto const height = [&](std::size_t other) {
        return points[turns[i]].second - points[turns[other]].second;
      };
      // If the start or the end of the run cuts off one side of a pulse, its height is measured on
      // the other side.
      bool const first = i == 1, last = i + 2 == turns.size();
      double const before = height(i - 1), after = height(i + 1);
      bool const before_is_lower = std::abs(before) < std::abs(after);
      double const lower = before_is_lower ? before : after;
      double const higher = before_is_lower ? after : before;
      double const least = first && last ? higher : first ? after : last ? before : lower;
      double const level = points[turns[i]].second - 0.5 * least;
      auto const begin = crossing(points, turns[i], -1, level);
      auto const end = crossing(points, turns[i], 1, level);
      if (!begin || !end) continue;
      double const length = *end - *begin;
      if (length > 0 && !(shortest && shortest->length <= length))
        shortest = {length, points[turns[i]].first, samples.key_of(c)};
    }
  }
  return shortest;
}

}  // namespace cayspin::simulation
