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

namespace cayspin::inline v0_1 {

/// How StiffGauss solves a step's equations.
struct StiffOptions {
  /// Of the rotation vectors' remaining error on any site. 0: round-off where the generator is
  /// conservative, otherwise 1/200 of the usual first correction, or 1/1000 where that
  /// is small and the order 4.
  double tolerance = 0;
  int iterations = 30;  ///< corrections before the step is halved
  int halvings = 12;    ///< of a step, before NotConverged
};

namespace detail {

/// The last three values of A at stages of earlier steps, the last one first.
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
  void forget() {
    known_ = 0;
    usual_ = std::numeric_limits<double>::infinity();
  }
  /// Takes x of the last step, and leaves other memory in it.
  void remember(std::array<Spins, std::size_t{Stages}>& x) {
    std::rotate(earlier_.begin(), earlier_.end() - Stages, earlier_.end());
    for (std::size_t i = 0; i < x.size(); ++i) swap(x[x.size() - 1 - i], earlier_[i]);
    known_ = std::min(known_ + Stages, fields);
  }

  template <class Visit>
  void visit_memory(Visit const& visit) {
    visit("known", known_);
    visit("usual", usual_);
    for (int i = 0; i < known_; ++i)
      visit("earlier_" + std::to_string(i), earlier_[static_cast<std::size_t>(i)]);
  }

  void extrapolate_in(Guess& kernel) const {
    kernel.count = known_;
    for (int i = 0; i < known_; ++i) {
      kernel.earlier[i] = earlier_[static_cast<std::size_t>(i)].array();
      for (int stage = 0; stage < Stages; ++stage)
        kernel.coefficients[stage][i] = coefficient(stage, i);
    }
  }

  /// Of the error that corrections leave, given the first of them. Spin waves that are too short
  /// for dt are not damped, and extrapolation amplifies what is left of them: so a first correction
  /// that is larger than usual is not a measure.
  double tolerance(double first) {
    double const least = 16 * epsilon;
    first = usual_ = std::clamp(first, least, std::max(least, 1.2 * usual_));
    double const share = Stages == 1 ? 0.005 : std::clamp(std::sqrt(first), 0.001, 0.005);
    return std::max(share * first, least);
  }

 private:
  // Lagrange's.
  double coefficient(int stage, int i) const {
    auto const& nodes = GaussLegendre<Stages>::nodes;
    auto const time = [&](int k) {  // in units of dt
      return nodes[static_cast<std::size_t>(Stages - 1 - k % Stages)] - k / Stages - 1;
    };
    double product = 1;
    for (int k = 0; k < known_; ++k)
      if (k != i)
        product *= (nodes[static_cast<std::size_t>(stage)] - time(k)) / (time(i) - time(k));
    return product;
  }

  std::array<Spins, std::size_t{fields}> earlier_;
  int known_ = 0;
  double usual_ = std::numeric_limits<double>::infinity();  // first correction
};

}  // namespace detail
}  // namespace cayspin::inline v0_1
