// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "time_features.hpp"

#include "shortest_feature.hpp"
#include "time_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace cayspin::simulation {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Jump {
  double before, after;
};

/// Returns the jump between times `a` and `b`, located by bisection: each halving keeps the half
/// with the larger change. Returns nothing if the function proves to be continuous.
std::optional<Jump> bisect(TimeSamples& samples, std::size_t component, double a, double b) {
  double const end = samples.end();
  double at_a = samples.value(a, component), at_b = samples.value(b, component);
  int between = 0;  // halvings whose middle value is close to neither end's
  while (b - a > 2 * epsilon * std::abs(b) + 1e-18 * end) {
    double const middle = a + 0.5 * (b - a);
    if (middle <= a || middle >= b) break;
    double const now = samples.value(middle, component);
    double const left = std::abs(now - at_a), right = std::abs(at_b - now);
    if (std::min(left, right) > 0.2 * (left + right) && ++between == 3) return std::nullopt;
    if (left > right)
      b = middle, at_b = now;
    else
      a = middle, at_a = now;
  }
  return Jump{a - 2 * epsilon * std::abs(a), b + 2 * epsilon * std::abs(b)};
}

// Returns the jumps, which are sought where two successive samples differ by far more than others
// nearby; nothing if the search takes too many evaluations.
std::optional<std::vector<Jump>> find_jumps(TimeSamples& samples, std::int64_t most_evaluations) {
  std::vector<Jump> jumps;
  std::vector<std::pair<double, double>> cells;
  for (std::size_t c = 0; c < samples.components(); ++c) {
    double const range = samples.range(c);
    if (range == 0) continue;
    for (std::size_t i = 0; i + 1 < samples.count(); ++i) {
      if (samples.evaluations() > most_evaluations) return std::nullopt;
      double const least = std::max(1e-9 * range, samples.round_off(c));
      if (samples.change(i, c) > least && samples.changes_unusually(i, c))
        if (auto const jump = bisect(samples, c, samples.time(i), samples.time(i + 1)))
          jumps.push_back(*jump);
    }
  }
  std::ranges::sort(jumps, {}, &Jump::before);
  // Merges jumps that overlap: several components may jump at once, and two jumps may be too close
  // to step between them.
  std::vector<Jump> apart;
  for (auto const& jump : jumps)
    if (!apart.empty() && jump.before <= apart.back().after)
      apart.back().after = std::max(apart.back().after, jump.after);
    else
      apart.push_back(jump);
  return apart;
}

/// Divides a time span into parts in each of which a polynomial through the values at Chebyshev
/// points agrees with the values in between.
class Parts {
 public:
  Parts(TimeSamples& samples, FeatureSearch const& search)
      : samples_(samples), search_(search), values_(samples.components()) {
    search_.most_evaluations += samples.evaluations();
    for (std::size_t i = 0; i < count; ++i) {
      double const angle = (2.0 * static_cast<double>(i) + 1) * std::numbers::pi / (2 * count);
      nodes_[i] = -std::cos(angle);
      weights_[i] = (i % 2 == 0 ? 1 : -1) * std::sin(angle);
    }
  }

  /// Appends bounds on the steps in a time span without jumps. Returns false if the vectors change
  /// too often.
  bool divide(double a, double b, std::vector<StepBound>& bounds) {
    std::vector<std::pair<double, double>> open{{a, b}};
    while (!open.empty()) {
      auto const [begin, end] = open.back();
      open.pop_back();
      if (samples_.evaluations() > search_.most_evaluations)
        return bound_the_rest(begin, b, bounds);
      if (end - begin <= 64 * epsilon * std::max(std::abs(end), 1e-6 * samples_.end())) continue;
      auto const found = judge(begin, end);
      if (found == Found::constant || (found == Found::smooth && begin == a && end == b)) continue;
      if (found == Found::smooth) {
        add({begin, end, end - begin}, bounds);
        continue;
      }
      double const middle = begin + 0.5 * (end - begin);
      open.emplace_back(middle, end);
      open.emplace_back(begin, middle);
    }
    return true;
  }

 private:
  static constexpr std::size_t count = 13;
  enum class Found { constant, smooth, features };

  static void add(StepBound const& bound, std::vector<StepBound>& bounds) {
    bool const goes_on = !bounds.empty() && bounds.back().end == bound.begin &&
                         std::abs(bounds.back().max_dt - bound.max_dt) <= 1e-9 * bound.max_dt;
    if (goes_on)
      bounds.back().end = bound.end;
    else
      bounds.push_back(bound);
  }

  // Bounds the steps in the rest of a span by a single length: the shortest bound so far, halved
  // until spans of this length have no features at any of 256 places. Returns false if none of 12
  // lengths is short enough, or if the evaluations are used up.
  bool bound_the_rest(double begin, double end, std::vector<StepBound>& bounds) {
    constexpr int places = 256, halvings = 12;
    // Each span may exceed the limit here. Give up once all spans together have reached twice the
    // limit.
    if (samples_.evaluations() > 2 * search_.most_evaluations) return false;
    double length = end - begin;
    for (auto const& bound : bounds)
      if (bound.max_dt > 0) length = std::min(length, bound.max_dt);
    for (int halving = 0; halving < halvings; ++halving, length *= 0.5) {
      int place = 0;
      for (; place < places; ++place) {
        double const at = begin + (end - begin - length) * place / (places - 1);
        if (judge(at, at + length) == Found::features) break;
      }
      if (place < places) continue;
      add({begin, end, length}, bounds);
      return true;
    }
    return false;
  }

  Found judge(double begin, double end) {
    double const middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    for (std::size_t i = 0; i < count; ++i) {
      auto const now = samples_.evaluate(middle + half * nodes_[i]);
      for (std::size_t c = 0; c < values_.size(); ++c) values_[c][i] = now[c];
    }
    bool constant = true;
    for (std::size_t c = 0; c < values_.size(); ++c) {
      auto const found = judge_component(c, begin, end);
      if (found == Found::features) return found;
      constant = constant && found == Found::constant;
    }
    return constant ? Found::constant : Found::smooth;
  }

  Found judge_component(std::size_t c, double begin, double end) {
    auto const& values = values_[c];
    auto const [least, most] = std::ranges::minmax(values);
    auto const [first, last] = samples_.within(begin, end);
    double const noise = std::max(1e-12 * samples_.range(c), samples_.round_off(c));
    double const middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    auto const differs = [&](double t, double value) {
      if (value >= least - noise && value <= most + noise && most - least <= noise) return false;
      double const allowed =
          std::max({noise, 1e-6 * (most - least), search_.angle / (end - begin)});
      return !(std::abs(value - interpolated(c, (t - middle) / half)) <= allowed);
    };
    // Tests a few samples first: they suffice to show most features.
    for (std::size_t const stride : {std::max<std::size_t>(1, (last - first) / 64), std::size_t{1}})
      for (std::size_t i = first; i < last; i += stride)
        if (differs(samples_.time(i), samples_.sample(i, c))) return Found::features;
    if (last - first < 4 * count)
      for (std::size_t i = 0; i + 1 < count; ++i) {
        double const t = middle + half * 0.5 * (nodes_[i] + nodes_[i + 1]);
        if (differs(t, samples_.value(t, c))) return Found::features;
      }
    return most - least <= noise ? Found::constant : Found::smooth;
  }

  double interpolated(std::size_t c, double x) const {
    double above = 0, below = 0;
    for (std::size_t i = 0; i < count; ++i) {
      double const apart = x - nodes_[i];
      if (apart == 0) return values_[c][i];
      above += weights_[i] / apart * values_[c][i];
      below += weights_[i] / apart;
    }
    return above / below;
  }

  TimeSamples& samples_;
  FeatureSearch search_;
  std::array<double, count> nodes_, weights_;
  std::vector<std::array<double, count>> values_;
};

}  // namespace

TimeFeatures find_features(std::span<TimeDependent const> vectors, FeatureSearch const& search) {
  TimeFeatures features;
  TimeSamples samples(vectors, search);
  std::optional<std::vector<Jump>> jumps;
  if (!samples.are_too_coarse())
    jumps = find_jumps(samples, samples.evaluations() + search.most_evaluations);
  Parts parts(samples, search);
  double begin = search.begin;
  bool resolved = jumps.has_value();
  auto const part_until = [&](double end) {
    if (end > begin && resolved) resolved = parts.divide(begin, end, features.bounds);
  };
  for (auto const& jump : jumps.value_or(std::vector<Jump>())) {
    part_until(jump.before);
    features.bounds.push_back({jump.before, jump.after, 0});
    ++features.jumps;
    begin = jump.after;
  }
  part_until(search.end);
  if (!resolved) features.unresolved = samples.key_of_fastest();
  features.last_change = samples.last_change();
  features.shortest = shortest_feature(samples);
  for (std::size_t v = 0; v < vectors.size(); ++v)
    features.largest.emplace_back(vectors[v].key, samples.largest()[v]);
  return features;
}

}  // namespace cayspin::simulation
