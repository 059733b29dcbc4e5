// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "time_samples.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace cayspin::simulation {

TimeSamples::TimeSamples(std::span<TimeDependent const> vectors, FeatureSearch const& search)
    : vectors_(vectors),
      begin_(search.begin),
      end_(search.end),
      apart_((end_ - begin_) / static_cast<double>(search.samples)),
      values_(3 * vectors.size()),
      ranges_(3 * vectors.size()),
      round_off_(3 * vectors.size()),
      now_(3 * vectors.size()),
      largest_(vectors.size()) {
  std::vector<double> equal(static_cast<std::size_t>(search.samples + 1));
  for (std::size_t i = 0; i < equal.size(); ++i)
    equal[i] =
        begin_ + (end_ - begin_) * (static_cast<double>(i) / static_cast<double>(search.samples));
  std::ranges::merge(equal, times_near_events(), std::back_inserter(times_));
  times_.erase(std::ranges::unique(times_).begin(), times_.end());
  for (auto& values : values_) values.reserve(times_.size());
  for (double const t : times_) add_sample(t);
  for (std::size_t c = 0; c < components(); ++c) {
    auto const [least, most] = std::ranges::minmax(values_[c]);
    round_off_[c] =
        32 * std::numeric_limits<double>::epsilon() * std::max(std::abs(least), std::abs(most));
    ranges_[c] = most - least > round_off_[c] ? most - least : 0;
  }
  later_.clear();
}

// Returns times that come ever closer to each event, so that no pulse that starts, ends or has its
// middle there is missed.
std::vector<double> TimeSamples::times_near_events() const {
  constexpr int halvings = 45;
  std::vector<double> times;
  auto const add = [&](double t) {
    if (t > begin_ && t < end_) times.push_back(t);
  };
  for (auto const& vector : vectors_)
    for (double const event : vector.events) {
      if (!(event >= begin_) || !(event <= end_)) continue;
      add(event);
      for (int i = 0; i < halvings; ++i) {
        add(event - std::ldexp(apart_, -i));
        add(event + std::ldexp(apart_, -i));
      }
    }
  std::ranges::sort(times);
  return times;
}

void TimeSamples::add_sample(double t) {
  evaluate(t);
  for (std::size_t c = 0; c < components(); ++c) values_[c].push_back(now_[c]);
  later_.clear();
}

std::vector<double> const& TimeSamples::evaluate(double t) {
  ++evaluations_;
  for (std::size_t v = 0; v < vectors_.size(); ++v) {
    double* const three = &now_[3 * v];
    auto const is_finite = [&] {
      return std::all_of(three, three + 3, [](double x) { return std::isfinite(x); });
    };
    vectors_[v].value(t, three);
    for (double const aside : {1e-9 * apart_, -1e-9 * apart_}) {
      if (is_finite()) break;
      vectors_[v].value(t + aside, three);
    }
    if (!is_finite()) std::fill_n(three, 3, 0.0);
    largest_[v] = std::max(largest_[v], std::hypot(three[0], three[1], three[2]));
  }
  constexpr std::size_t most_kept = 8'000'000;
  if (later_.size() < most_kept) {
    later_.push_back(t);
    later_.insert(later_.end(), now_.begin(), now_.end());
  }
  return now_;
}

double TimeSamples::change(std::size_t i, std::size_t component) const {
  auto const& values = values_[component];
  return std::abs(values[i + 1] - values[i]);
}

bool TimeSamples::changes_unusually(std::size_t i, std::size_t component) const {
  constexpr std::size_t beside = 4;
  double const usual = change(i, component) / 3;
  int more = 0, less = 0;
  std::size_t const first = i > beside ? i - beside : 0;
  for (std::size_t at = first; at <= i + beside && at + 1 < count(); ++at)
    if (at != i) (change(at, component) > usual ? more : less)++;
  return less > more;
}

double TimeSamples::last_change() const {
  double last = 0;
  for (std::size_t c = 0; c < components(); ++c)
    for (std::size_t i = count() - 1; i-- > 0;)
      if (change(i, c) > std::max(1e-12 * range(c), round_off(c))) {
        last = std::max(last, time(i + 1));
        break;
      }
  return last;
}

std::pair<std::size_t, std::size_t> TimeSamples::within(double begin, double end) const {
  auto const first = std::ranges::lower_bound(times_, begin) - times_.begin();
  auto const last = std::ranges::upper_bound(times_, end) - times_.begin();
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(std::max(first, last))};
}

TimeSamples::Fastest TimeSamples::fastest() const {
  Fastest fastest;
  for (std::size_t c = 0; c < components(); ++c) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < count(); ++i) sum += change(i, c);
    double const times_through = ranges_[c] > 0 ? sum / ranges_[c] : 0;
    if (times_through > fastest.times_through) fastest = {c, times_through};
  }
  return fastest;
}

std::string const& TimeSamples::key_of_fastest() const { return key_of(fastest().component); }

bool TimeSamples::are_too_coarse() const {
  return 4 * fastest().times_through > static_cast<double>(count());
}

std::vector<std::pair<double, double>> TimeSamples::all(std::size_t component) const {
  std::vector<std::pair<double, double>> later, both;
  std::size_t const stride = components() + 1;
  for (std::size_t at = 0; at + stride <= later_.size(); at += stride)
    later.emplace_back(later_[at], later_[at + 1 + component]);
  std::ranges::sort(later);
  both.reserve(later.size() + count());
  std::size_t next = 0;
  for (std::size_t i = 0; i < count(); ++i) {
    for (; next < later.size() && later[next].first < times_[i]; ++next)
      both.push_back(later[next]);
    both.emplace_back(times_[i], values_[component][i]);
  }
  both.insert(both.end(), later.begin() + static_cast<std::ptrdiff_t>(next), later.end());
  return both;
}

}  // namespace cayspin::simulation
