// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stepper/stiff_gauss_stage.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace cayspin::inline v0_2 {

/// Options of StiffGauss.
struct StiffOptions {
  /// Bound on the largest remaining error of any site's rotation vector. 0 (the default): chosen in
  /// each step. If the generator conserves the energy, the bound is then round-off. Otherwise it is
  /// a fraction of the step's first correction: 1/200 (for order 4 down to 1/1000, if that
  /// correction is small), or at most 1/1000 in the first steps of a run. A first correction counts
  /// as at most 1.2 times that of the previous step.
  double tolerance = 0;
  int iterations = 30;  ///< most corrections before the step is halved
  int halvings = 12;    ///< most successive halvings before NotConverged is thrown
};

namespace detail {

/// The last three values of A at stages of earlier steps, latest first, and their times.
template <class Spins, int Stages>
class StiffHistory {
  using Real = typename Spins::value_type;
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();

 public:
  static constexpr int fields = 3;
  using Guess = GuessStage<Stages, fields, Real>;

  StiffHistory() = default;
  StiffHistory(std::string const& name, Lattice const& lattice)
      : earlier_(numbered_fields<Spins, std::size_t{fields}>(name, lattice)) {}

  bool is_complete() const { return known_ == fields; }
  int known() const { return known_; }
  void forget() {
    known_ = 0;
    times_ = times_of_equal_steps();
    usual_ = std::numeric_limits<double>::infinity();
  }
  /// Stores the fields x of the last step by swapping: x is left with other memory.
  void remember(std::array<Spins, std::size_t{Stages}>& x) {
    std::rotate(earlier_.begin(), earlier_.end() - Stages, earlier_.end());
    std::rotate(times_.begin(), times_.end() - Stages, times_.end());
    for (double& time : times_) time -= 1;
    for (std::size_t i = 0; i < x.size(); ++i) {
      swap(x[x.size() - 1 - i], earlier_[i]);
      times_[i] = node(x.size() - 1 - i) - 1;
    }
    known_ = std::min(known_ + Stages, fields);
  }
  /// Rescales times for a next step that is `ratio` times as long as the previous one.
  void rescale(double ratio) {
    for (double& time : times_) time /= ratio;
  }

  /// For cayspin::serialize. Methods with unequal steps call visit_times, too.
  template <class Visit>
  void visit_times(Visit const& visit) {
    for (std::size_t i = 0; i < times_.size(); ++i)
      visit("earlier_time_" + std::to_string(i), times_[i]);
  }
  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit.count("known", known_, fields);
    visit("usual", usual_);
    for (int i = 0; i < known_; ++i)
      visit("earlier_" + std::to_string(i), earlier_[static_cast<std::size_t>(i)]);
  }

  void extrapolate_in(Guess& kernel, int most) const {
    kernel.count = std::min(known_, most);
    for (int i = 0; i < kernel.count; ++i) {
      kernel.earlier[i] = earlier_[static_cast<std::size_t>(i)].array();
      for (int stage = 0; stage < Stages; ++stage)
        kernel.coefficients[stage][i] = coefficient(stage, i, kernel.count);
    }
  }

  /// Returns weights for the changes of the spins over the last three steps, latest first. The
  /// weighted sum is half the second derivative of the spins' rate, with time in units of dt. With
  /// `has_end`, dt times the rate at the end of the last step takes the place of the third change.
  /// In the first step of a run the sum is the first derivative instead.
  std::array<double, 3> second_difference(bool has_end) const
    requires(Stages == 1)
  {
    double const now = node(0), before = times_[0], other = has_end ? 1 : times_[1];
    if (known_ == 0) return {1 / (now - other), 0, 1 / (other - now)};
    double const last = -2 * times_[0], one_before = -2 * (times_[1] + last);  // step lengths
    return {1 / ((now - before) * (now - other)), 1 / ((before - now) * (before - other) * last),
            1 / ((other - now) * (other - before) * (has_end ? 1 : one_before))};
  }

  /// Returns the kernel that computes the spins within the last step, at the fraction `share` of
  /// it. A is taken as linear in time, through its values at the stages of the last two steps; as
  /// constant if there was only one step.
  StiffDenseOutput<Real> dense_output(double dt, double share) const
    requires(Stages == 1)
  {
    StiffDenseOutput<Real> kernel;
    kernel.last = kernel.before = earlier_[0].array();
    kernel.whole = static_cast<Real>(share * dt);
    if (known_ > 1) {
      kernel.before = earlier_[1].array();
      double const slope = 0.5 * (share - 1) * share * dt / (times_[0] - times_[1]);
      kernel.slope = static_cast<Real>(slope);
    }
    return kernel;
  }

  /// Returns the bound on the error that corrections may leave, and updates the usual first
  /// correction. `first`: size of the first correction of this step. Spin waves that are too short
  /// for dt are not damped, and extrapolation amplifies what is left of them. A first correction
  /// therefore counts as at most 1.2 times the usual one.
  double tolerance(double first) {
    double const least = 16 * epsilon;
    first = usual_ = std::clamp(first, least, std::max(least, 1.2 * usual_));
    double const share = Stages == 1 ? 0.005 : std::clamp(std::sqrt(first), 0.001, 0.005);
    return std::max(share * first, least);
  }

 private:
  using Times = std::array<double, std::size_t{fields}>;

  static constexpr double node(std::size_t stage) { return GaussLegendre<Stages>::nodes[stage]; }
  static constexpr Times times_of_equal_steps() {
    Times times{};
    for (int i = 0; i < fields; ++i)
      times[static_cast<std::size_t>(i)] =
          node(static_cast<std::size_t>(Stages - 1 - i % Stages)) - i / Stages - 1;
    return times;
  }
  // Returns a coefficient of Lagrange's interpolation.
  double coefficient(int stage, int i, int count) const {
    auto const at = [&](int k) { return times_[static_cast<std::size_t>(k)]; };
    double product = 1;
    for (int k = 0; k < count; ++k)
      if (k != i) product *= (node(static_cast<std::size_t>(stage)) - at(k)) / (at(i) - at(k));
    return product;
  }

  std::array<Spins, std::size_t{fields}> earlier_;
  Times times_ = times_of_equal_steps();  // from the start of the next step, in units of dt
  int known_ = 0;
  double usual_ = std::numeric_limits<double>::infinity();  // usual first correction
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
