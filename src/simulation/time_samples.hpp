// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "time_features.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation {

/// Values of vectors that depend on t: at equally spaced times, at times near their events, and at
/// times evaluated later. The first 8 million numbers of the latter are kept.
class TimeSamples {
 public:
  TimeSamples(std::span<TimeDependent const> vectors, FeatureSearch const& search);

  std::size_t components() const { return 3 * vectors_.size(); }
  std::size_t count() const { return times_.size(); }
  double end() const { return end_; }
  double time(std::size_t i) const { return times_[i]; }
  double sample(std::size_t i, std::size_t component) const { return values_[component][i]; }
  /// Returns the difference between the largest and the least sample; 0 if it may be round-off.
  double range(std::size_t component) const { return ranges_[component]; }
  /// Returns the difference between two values up to which it may be round-off.
  double round_off(std::size_t component) const { return round_off_[component]; }
  /// Returns |sample(i + 1) - sample(i)|.
  double change(std::size_t i, std::size_t component) const;
  /// Returns true if change(i, component) is at least three times as large as most changes nearby.
  bool changes_unusually(std::size_t i, std::size_t component) const;
  /// Returns the time after which no component changes; 0 if none changes at all.
  double last_change() const;
  /// Returns the index of the first sample between two times, and the index after that of the last
  /// one.
  std::pair<std::size_t, std::size_t> within(double begin, double end) const;

  /// Returns all components at t, and keeps them if there is room. A vector that is not finite at t
  /// is replaced by its value very close to t or, if that is not finite either, by 0.
  std::vector<double> const& evaluate(double t);
  double value(double t, std::size_t component) { return evaluate(t)[component]; }
  std::int64_t evaluations() const { return evaluations_; }

  std::string const& key_of(std::size_t component) const { return vectors_[component / 3].key; }
  std::string const& key_of_fastest() const;
  /// Returns true if a component varies so fast that the samples do not resolve it: on average it
  /// crosses its range more than once within four samples.
  bool are_too_coarse() const;
  /// Returns the largest length of each vector, over all values.
  std::vector<double> const& largest() const { return largest_; }
  /// Returns all values of a component that are kept, with their times, in the order of time.
  std::vector<std::pair<double, double>> all(std::size_t component) const;

 private:
  struct Fastest {
    std::size_t component = 0;
    double times_through = -1;  // how often it goes through its range, up or down
  };
  Fastest fastest() const;
  std::vector<double> times_near_events() const;
  void add_sample(double t);

  std::span<TimeDependent const> vectors_;
  double begin_, end_, apart_;
  std::vector<double> times_;
  std::vector<std::vector<double>> values_;  // [component][sample]
  std::vector<double> ranges_, round_off_, now_, largest_;
  std::vector<double> later_;  // records of t and all components
  std::int64_t evaluations_ = 0;
};

}  // namespace cayspin::simulation
