// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/probe.hpp>
#include <cayspin/solver/helmholtz.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

// First approximation of the inverse Hessian: (K + c)^-1, with the measured exchange K of a field
// and a constant c.
namespace cayspin::inline v0_2::detail {

template <class Spins>
class Preconditioner {
  using Real = typename Spins::value_type;

 public:
  /// Sets K and c, and allocates memory. Without exchange the preconditioner is 1 / c.
  void set(Lattice const& lattice, FieldStrengths const& found, bool with_exchange) {
    couplings_ = with_exchange ? found.couplings : std::array<double, 3>{};
    exchange_.emplace("Minimizer::exchange", lattice, couplings_);
    double const strongest = found.strongest();
    // A rest below this is only round-off of the exchange.
    double const least =
        100 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * strongest;
    first_shift_ = found.rest > least ? found.rest : strongest > 0 ? 1e-3 * strongest : 1;
    shift_ = first_shift_;
  }

  std::array<double, 3> const& couplings() const { return couplings_; }

  /// Sets c, within limits, to the part of the curvature along the last step s that exchange does
  /// not explain. `product`: s.y, with the change y of the gradient. `exchange_energy`: s.K s.
  /// `step_square`: s.s. `torque`: largest |m x H|. Far from equilibrium a small c gives long
  /// steps, in which waves as long as the lattice vanish before they form walls and vortices.
  /// (Those would move by only a cell per iteration.) Near equilibrium a small c slows the
  /// convergence of the stiffest long waves, so there c is at least its first value.
  void follow_curvature(double product, double exchange_energy, double step_square, double torque) {
    double const rest = (product - exchange_energy) / step_square;
    if (!std::isfinite(rest)) return;
    double const least = torque < first_shift_ ? first_shift_ : 1e-6 * first_shift_;
    shift_ = std::clamp(std::max(rest, 0.25 * shift_), least, 30 * first_shift_);
  }
  /// Sets c to its first value.
  void forget_curvature() { shift_ = first_shift_; }
  double first_shift() const { return first_shift_; }

  /// Computes `to` = (K + c + more)^-1 `from`.
  template <class Exec>
  void apply(Exec const& exec, Spins const& from, Spins const& to, double more = 0) {
    exchange_->solve(exec, shift_ + more, Real(1), from, to);
  }

 private:
  std::array<double, 3> couplings_{};
  std::optional<Helmholtz<Real, typename Spins::memory_space>> exchange_;
  double first_shift_ = 1, shift_ = 1;
};

}  // namespace cayspin::inline v0_2::detail
