// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stepper/stiff_midpoint_stage.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace cayspin {

/// How StiffMidpoint solves a step's equation.
struct StiffOptions {
  /// Of the rotation vector's remaining error on any site. 0: round-off where the generator is
  /// conservative, otherwise 1/200 of the usual first correction, or 1e-4 and less of it for
  /// order 4.
  double tolerance = 0;
  int iterations = 30;  ///< corrections before the step is halved
  int halvings = 12;    ///< of a step, before NotConverged
};

namespace detail {

/// What A in the middle of a part of a step was in earlier steps, the last one first.
template <class Spins>
class StiffHistory {
  using Real = typename Spins::value_type;
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();

 public:
  StiffHistory() = default;
  StiffHistory(std::string const& name, Lattice const& lattice)
      : earlier_(numbered_fields<Spins, 3>(name, lattice)) {}

  bool is_complete() const { return known_ == 3; }
  void forget() {
    known_ = 0;
    usual_ = std::numeric_limits<double>::infinity();
  }
  /// Takes x, and leaves other memory in it.
  void remember(Spins& x) {
    std::rotate(earlier_.begin(), earlier_.end() - 1, earlier_.end());
    swap(x, earlier_[0]);
    known_ = std::min(known_ + 1, 3);
  }

  template <class Visit>
  void visit_memory(std::string const& prefix, Visit const& visit) {
    visit(prefix + "known", known_);
    visit(prefix + "usual", usual_);
    for (int k = 0; k < known_; ++k)
      visit(prefix + std::to_string(k), earlier_[static_cast<std::size_t>(k)]);
  }

  void extrapolate_in(GuessStage<Real>& kernel) const {
    static constexpr double coefficients[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, -1, 0}, {3, -3, 1}};
    kernel.count = known_;
    for (int i = 0; i < known_; ++i) {
      kernel.earlier[i] = earlier_[static_cast<std::size_t>(i)].array();
      kernel.coefficients[i] = coefficients[known_][i];
    }
  }

  /// Of the error that corrections leave, given the first of them. Spin waves that are too short
  /// for dt are not damped, and extrapolation amplifies what is left of them: so a first correction
  /// that is larger than usual is not a measure.
  double tolerance(double first, int order) {
    double const least = 16 * epsilon;
    first = usual_ = std::clamp(first, least, std::max(least, 1.2 * usual_));
    double const share = order == 2 ? 0.005 : std::min(1e-3, std::sqrt(first));
    return std::max(share * first, least);
  }

 private:
  std::array<Spins, 3> earlier_;
  int known_ = 0;
  double usual_ = std::numeric_limits<double>::infinity();  // first correction
};

}  // namespace detail
}  // namespace cayspin
