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

/// Values of vectors that depend on t: at equal times, at times near their events, and at those
/// that were asked for since.
class TimeSamples {
 public:
  TimeSamples(std::span<TimeDependent const> vectors, FeatureSearch const& search);

  std::size_t components() const { return 3 * vectors_.size(); }
  std::size_t count() const { return times_.size(); }
  double end() const { return end_; }
  double time(std::size_t i) const { return times_[i]; }
  double sample(std::size_t i, std::size_t component) const { return values_[component][i]; }
  /// Largest minus least sample.
  double range(std::size_t component) const { return ranges_[component]; }
  /// |sample(i + 1) - sample(i)|
  double change(std::size_t i, std::size_t component) const;
  /// Is that three times as much as most changes nearby?
  bool changes_unusually(std::size_t i, std::size_t component) const;
  /// The first sample from which on none changes.
  double last_change() const;
  /// First and last + 1 of the samples between two times.
  std::pair<std::size_t, std::size_t> within(double begin, double end) const;

  /// All components at t, which is kept. Finite, also where t is a removable singularity.
  std::vector<double> const& evaluate(double t);
  double value(double t, std::size_t component) { return evaluate(t)[component]; }
  std::int64_t evaluations() const { return evaluations_; }

  std::string const& key_of(std::size_t component) const { return vectors_[component / 3].key; }
  std::string const& key_of_fastest() const;
  /// Does a component go through its range more than once in four samples? Then what lies between
  /// them is not known.
  bool are_too_coarse() const;
  /// The largest length of each vector, of all values.
  std::vector<double> const& largest() const { return largest_; }
  /// All values of a component by time, at a time once.
  std::vector<std::pair<double, double>> all(std::size_t component) const;

 private:
  struct Fastest {
    std::size_t component = 0;
    double times_through = -1;  // its range, up or down
  };
  Fastest fastest() const;
  std::vector<double> times_near_events() const;
  void add_sample(double t);

  std::span<TimeDependent const> vectors_;
  double end_, apart_;
  std::vector<double> times_;
  std::vector<std::vector<double>> values_;  // [component][sample]
  std::vector<double> ranges_, now_, largest_;
  std::vector<double> later_;  // t and all components, again and again
  std::int64_t evaluations_ = 0;
};

}  // namespace cayspin::simulation
