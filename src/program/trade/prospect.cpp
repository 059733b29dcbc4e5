// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "prospect.hpp"

#include <algorithm>
#include <cmath>

namespace cayspin::program::trade {
namespace {

constexpr double near = 4;        // above this error / requested error, no order > order_ counts
constexpr double most_finer = 5;  // largest ratio of a cost to that of the finest trial
constexpr double close = 0.94;    // ratio of two costs above which they count as equal

}  // namespace

double Prospect::resolution(Steps const& steps) const {
  return candidate_.method->adaptive ? 1 / steps.tolerance : static_cast<double>(steps.count);
}

Steps Prospect::steps_of(double resolution) const {
  if (candidate_.method->adaptive) return {0, std::min(1 / resolution, coarsest_.tolerance)};
  auto const count = static_cast<std::int64_t>(std::ceil(resolution - 1e-9));
  return {std::max(count, coarsest_.count), 0};
}

bool Prospect::allows(Steps const& steps) const {
  return !candidate_.method->adaptive || steps.tolerance >= candidate_.least_tolerance();
}

void Prospect::add(Try one, double unknown) {
  double const now = resolution(one.steps);
  auto const finer = std::ranges::upper_bound(
      tries_, now, {}, [this](Try const& other) { return resolution(other.steps); });
  // An error below five times the uncertainty of the reference is replaced by one extrapolated from
  // the next coarser trial, but moved by at most that uncertainty.
  if (finer != tries_.begin() && one.error < 5 * unknown) {
    auto const& coarser = *std::prev(finer);
    double const by_order = coarser.error * std::pow(now / resolution(coarser.steps), -order_);
    one.error = std::clamp(by_order, one.error - unknown, one.error + unknown);
  }
  one.error = std::max(one.error, 1e-16);
  tries_.insert(finer, one);
}

void Prospect::add_time(Steps const& steps, double seconds) {
  timed_twice_ = true;
  for (auto& one : tries_)
    if (resolution(one.steps) == resolution(steps)) one.seconds = std::min(one.seconds, seconds);
}

Try const* Prospect::passing(double error) const {
  Try const* coarsest = nullptr;
  for (auto one = tries_.rbegin(); one != tries_.rend() && one->error <= error; ++one)
    coarsest = &*one;
  return coarsest;
}

// Returns the order that the two finest trials show, or the method's own if they show none.
double Prospect::seen_order() const {
  if (tries_.size() < 2) return order_;
  auto const &a = tries_[tries_.size() - 2], &b = tries_.back();
  double const seen =
      std::log(a.error / b.error) / std::log(resolution(b.steps) / resolution(a.steps));
  return std::isfinite(seen) ? seen : order_;
}

// Returns the resolution that should have this error, interpolated by a power law. Where steps
// become stable, errors drop too abruptly for a power law. Then returns the geometric mean of the
// interval's ends or, if that costs about as much as the passing trial, the resolution of that
// trial.
double Prospect::between(Try const& failing, Try const& passing, double error) const {
  double const from = resolution(failing.steps), to = resolution(passing.steps);
  double const slope = std::log(failing.error / passing.error) / std::log(to / from);
  if (slope <= order_ + 1) return std::min(to, from * std::pow(failing.error / error, 1 / slope));
  double const halfway = std::sqrt(from * to);
  return std::pow(halfway / to, cost_order_) < close ? halfway : to;
}

Steps Prospect::needed(double error) const {
  if (auto const* const fine = passing(error)) {
    if (fine != tries_.data()) return steps_of(between(*(fine - 1), *fine, error));
    return steps_of(resolution(fine->steps) * std::pow(fine->error / error, 1 / order_));
  }
  auto const& last = tries_.back();
  double const finest = resolution(last.steps);
  if (!std::isfinite(last.error)) return steps_of(1.5 * finest);
  double const most = last.error < near * error ? order_ + 1 : order_;
  double const order = std::clamp(seen_order(), 0.5 * order_, most);
  return steps_of(finest * std::pow(last.error / error, 1 / order));
}

double Prospect::seconds_of(Steps const& steps) const {
  double const wanted = resolution(steps);
  double per_evaluation = infinite;
  Try const* nearest = nullptr;
  auto const apart = [&](Try const& one) {
    return std::abs(std::log(resolution(one.steps) / wanted));
  };
  for (auto const& one : tries_) {
    if (!std::isfinite(one.error)) continue;
    per_evaluation = std::min(per_evaluation, one.seconds / static_cast<double>(one.evaluations));
    if (!nearest || apart(one) < apart(*nearest)) nearest = &one;
  }
  if (!nearest) return per_evaluation;
  return per_evaluation * static_cast<double>(nearest->evaluations) *
         std::pow(wanted / resolution(nearest->steps), cost_order_);
}

Steps Prospect::next(double error) const {
  if (tries_.empty()) return first_;
  double const most = resolution(tries_.back().steps) * std::pow(most_finer, 1 / cost_order_);
  auto steps = steps_of(std::min(resolution(needed(error)), most));
  for (auto const& one : tries_)  // steps that were tried already are made slightly finer
    if (one.steps.count == steps.count && one.steps.tolerance == steps.tolerance)
      steps = steps_of(1.01 * resolution(steps) + 1e-6);
  return steps;
}

bool Prospect::is_settled(double error, double goal) const {
  auto const* const fine = passing(error);
  return fine && std::pow(resolution(needed(goal)) / resolution(fine->steps), cost_order_) > close;
}

bool Prospect::is_round_off(double error) const {
  return tries_.size() > 2 && tries_.back().error > error &&
         tries_.back().error < 100 * candidate_.least_tolerance() && seen_order() < 0.2 * order_;
}

}  // namespace cayspin::program::trade
