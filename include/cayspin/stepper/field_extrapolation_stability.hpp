// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stability.hpp>
#include <cayspin/stepper/field_history.hpp>
#include <cayspin/stepper/tableau.hpp>

#include <array>
#include <cstddef>
#include <limits>

// The largest stable time step of field extrapolation, for one transverse mode of a nearly uniform
// state: u' = (-damping + i) (a u + b v). The term a u comes from the spin itself, in the field of
// the others and in its local field. The term b v comes from the extrapolated field of the others.
namespace cayspin::inline v0_1::detail {

/// The amplitude after a step from those now and before, newest first. z = dt (a + b) (-damping +
/// i); `own` = a / (a + b); q = dt times the part of A along the spin.
template <std::size_t Order>
Complex extrapolated_mode(std::array<Complex, Order> const& amplitudes, Complex z, double own,
                          double q) {
  using Linear = LinearUpdate<update::Lie<Cayley>>;
  using Tableau = tableau::Classical4;
  std::array<double, Order> nodes;
  for (std::size_t j = 0; j < Order; ++j) nodes[j] = 0.0 - static_cast<double>(j);
  auto const others = [&](double x) {
    auto const weights = interpolation_weights(nodes, x);
    Complex sum = 0;
    for (std::size_t j = 0; j < Order; ++j) sum += weights[j] * amplitudes[j];
    return sum;
  };
  NearAxis increment, total;
  for (int stage = 0; stage < Tableau::stages; ++stage) {
    double const x = stage == 0 ? 0 : Tableau::a[stage][stage - 1];
    NearAxis const argument = x * increment;
    Complex const growth = Linear::growth(argument);
    Complex const rate = z * (own * (amplitudes[0] + growth) + (1 - own) * others(x));
    increment = Linear::increment(argument, {Complex(0, 1) * rate + q * growth, q}, 0, 0);
    total = total + Tableau::b[stage] * increment;
  }
  return amplitudes[0] + Linear::growth(total);
}

/// Does u[n + 1] = c[0] u[n] + c[1] u[n - 1] + .. grow by more than round-off? By the test of Schur
/// and Cohn: all roots of the characteristic polynomial lie within a circle.
template <std::size_t Order>
bool recursion_grows(std::array<Complex, Order> const& coefficients) {
  std::array<Complex, Order + 1> p{};  // of falling powers
  p[0] = 1;
  double const radius = 1 + 1e-11;
  double power = 1;
  for (std::size_t j = 0; j < Order; ++j) p[j + 1] = -coefficients[j] / (power *= radius);
  for (std::size_t degree = Order; degree > 0; --degree) {
    Complex const first = p[0], last = p[degree];
    if (!(std::norm(last) < std::norm(first))) return true;
    auto const old = p;
    for (std::size_t j = 0; j < degree; ++j)
      p[j] = std::conj(first) * old[j] - last * std::conj(old[degree - j]);
  }
  return false;
}

template <std::size_t Order>
bool extrapolated_mode_grows(Complex z, double own, double q) {
  std::array<Complex, Order> coefficients;
  for (std::size_t j = 0; j < Order; ++j) {
    std::array<Complex, Order> unit{};
    unit[j] = 1;
    coefficients[j] = extrapolated_mode<Order>(unit, z, own, q);
  }
  return recursion_grows(coefficients);
}

/// The largest dt at which no mode grows, at most the linear limit of either generator. It holds
/// for fields whose part from other spins is exchange between neighbours. The stiffest mode is then
/// the one with opposite neighbours, and half of its rate comes from the other spins.
template <std::size_t Order>
double largest_stable_extrapolation(double field_bound, double damping, bool precession) {
  double const never = std::numeric_limits<double>::infinity();
  Complex const rate(-damping, precession ? 1 : 0);
  if (!(field_bound > 0) || std::abs(rate) == 0) return never;
  double const unit = 1 / (field_bound * std::abs(rate)), own = 0.5;
  double limit = 1e3 * unit;             // of the scan; the method does not get there
  for (double const along : {0.0, own})  // A's part along the spin: of `orthogonal`, and of others
    limit = first_amplifying_step(
        [&](double dt, bool) {
          return extrapolated_mode_grows<Order>(dt * field_bound * rate, own,
                                                precession ? dt * field_bound * along : 0);
        },
        unit, limit, 1e-3);
  return limit;
}

}  // namespace cayspin::inline v0_1::detail
