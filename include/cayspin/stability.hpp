// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/rotation/exponential.hpp>
#include <cayspin/stage/data_flow.hpp>
#include <cayspin/stage/update.hpp>
#include <cayspin/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

// The largest stable time step of a method for the Landau-Lifshitz equation, computed before a run.
// The stages of the method are applied to one transverse mode of a nearly uniform state. The
// amplitude u of the mode obeys u' = s * (-damping + i) * u, where s is the effective field of the
// mode. sigma is the component of the generator along the spins.
namespace cayspin::inline v0_2 {

namespace detail {

using Complex = std::complex<double>;

/// Coordinates in the Lie algebra near the uniform state: the component transverse to the direction
/// of that state (first order in the mode's amplitude), and the component parallel to it (zeroth
/// order).
struct NearAxis {
  Complex transverse{0, 0};
  double parallel = 0;
};

inline NearAxis operator+(NearAxis const& a, NearAxis const& b) {
  return {a.transverse + b.transverse, a.parallel + b.parallel};
}
inline NearAxis operator*(double s, NearAxis const& a) {
  return {s * a.transverse, s * a.parallel};
}

template <class Update>
struct LinearUpdate;

// Returns the transverse part of f x y, as a complex number like NearAxis::transverse.
inline Complex transverse_cross(NearAxis const& f, NearAxis const& y) {
  return Complex(0, 1) * (f.parallel * y.transverse - y.parallel * f.transverse);
}

template <>
struct LinearUpdate<update::Lie<Cayley>> {
  static NearAxis increment(NearAxis const& f, NearAxis const& y, Complex, Complex) {
    return {
        y.transverse - 0.5 * transverse_cross(f, y) + 0.25 * f.parallel * y.parallel * f.transverse,
        y.parallel * (1 + 0.25 * f.parallel * f.parallel)};
  }
  /// Returns the change of the amplitude by the rotation with coordinates f; before the rotation,
  /// the amplitude is 1.
  static Complex growth(NearAxis const& f) {
    return Complex(0, -1) * f.transverse / Complex(1, -0.5 * f.parallel);
  }
};

template <>
struct LinearUpdate<update::Lie<Exponential>> {
  static NearAxis increment(NearAxis const& f, NearAxis const& y, Complex, Complex) {
    double const n = f.parallel, half = 0.5 * n;
    double const c =
        std::abs(n) < 1e-2 ? 1. / 12 + n * n / 720 : (1 - half / std::tan(half)) / (n * n);
    return {y.transverse - 0.5 * transverse_cross(f, y) +
                c * n * (y.parallel * f.transverse - n * y.transverse),
            y.parallel};
  }
  static Complex growth(NearAxis const& f) {
    double const n = f.parallel, half = 0.5 * n;
    Complex const mean =  // (exp(i n) - 1) / (i n)
        (std::abs(n) < 1e-8 ? 1.0 : std::sin(half) / half) * std::polar(1.0, half);
    return Complex(0, -1) * f.transverse * mean;
  }
};

template <class Rotation>
struct LinearUpdate<update::LieUncorrected<Rotation>> : LinearUpdate<update::Lie<Rotation>> {
  static NearAxis increment(NearAxis const&, NearAxis const& y, Complex, Complex) { return y; }
};

template <>
struct LinearUpdate<update::Stereographic> {
  static NearAxis increment(NearAxis const&, NearAxis const&, Complex z, Complex amplitude) {
    return {0.5 * z * amplitude, 0};
  }
  static Complex growth(NearAxis const& f) { return 2.0 * f.transverse; }
};

template <>
struct LinearUpdate<update::Classical> {
  static NearAxis increment(NearAxis const&, NearAxis const&, Complex z, Complex amplitude) {
    return {z * amplitude, 0};
  }
  static Complex growth(NearAxis const& f) { return f.transverse; }
};

template <>
struct LinearUpdate<update::Projected> : LinearUpdate<update::Classical> {};

/// Returns the growth of the amplitude from the start of the step to stage `row`, or to the end of
/// the step if `row` is the number of stages: by the rotation with coordinates `first`, and by a
/// second rotation if the tableau has one.
template <class Tableau, class Linear, class Coordinates>
Complex growth_to(int row, NearAxis const& first, Coordinates const& increments) {
  Complex const growth = Linear::growth(first);
  NearAxis second;
  for (int j = 0; j < row && j < Tableau::stages; ++j)
    second = second + second_weight<Tableau>(row, j) * increments[j];
  // Makes the coordinates relative to the spin after the first rotation.
  second.transverse -= second.parallel * growth;
  return growth + Linear::growth(second);
}

/// Returns the factor by which one step multiplies the amplitude of the mode, minus 1, for
/// z = dt * s * (-damping + i) and q = dt * sigma.
template <class Tableau, class Update>
Complex mode_growth(Complex z, double q) {
  using Linear = LinearUpdate<Update>;
  constexpr int stages = Tableau::stages;
  std::array<NearAxis, std::size_t{stages}> increments;
  for (int stage = 0; stage < stages; ++stage) {
    NearAxis argument;
    for (int j = 0; j < stage; ++j) argument = argument + Tableau::a[stage][j] * increments[j];
    Complex const growth = growth_to<Tableau, Linear>(stage, argument, increments);
    NearAxis const generator{Complex(0, 1) * z * (1.0 + growth) + q * growth, q};
    increments[stage] = Linear::increment(argument, generator, z, 1.0 + growth);
  }
  NearAxis total;
  for (int j = 0; j < stages; ++j) total = total + Tableau::b[j] * increments[j];
  return growth_to<Tableau, Linear>(stages, total, increments);
}

/// Returns the largest sum of absolute weights in a row of the tableau, at least 1: the tableau
/// magnifies round-off by at most this factor.
template <class Tableau>
constexpr double largest_row() {
  double largest = 1;
  for (int row = 0; row <= Tableau::stages; ++row) {
    double sum = 0;
    for (int j = 0; j < Tableau::stages; ++j) {
      double const weight = row < Tableau::stages ? Tableau::a[row][j] : Tableau::b[j];
      sum += weight < 0 ? -weight : weight;
    }
    if (largest < sum) largest = sum;
  }
  return largest;
}

/// Returns mode_growth for one step of a method; a stepper may define its own mode_growth.
template <class Stepper>
Complex growth_of_step(Complex z, double q) {
  if constexpr (requires { Stepper::mode_growth(z, q); })
    return Stepper::mode_growth(z, q);
  else
    return mode_growth<typename Stepper::tableau_type, typename Stepper::update_type>(z, q);
}

/// Returns true if the mode grows. If `clearly` is true or sigma is not 0, only growth beyond
/// round-off counts; otherwise growth that round-off could hide counts, too.
template <class Stepper>
bool amplifies(Complex rate, double dt, double sigma, bool clearly) {
  Complex const growth = growth_of_step<Stepper>(dt * rate, dt * sigma);
  double const excess = 2 * growth.real() + std::norm(growth);  // |1 + growth|^2 - 1
  double const size = 4 * std::numeric_limits<double>::epsilon() *
                      largest_row<typename Stepper::tableau_type>() * std::abs(growth);
  // Round-off is relative to |growth|^2 without sigma, to |growth| with it.
  if (sigma != 0) return !(excess < size);
  return !(excess < (clearly ? size : -size) * std::abs(growth));
}

/// Returns the largest dt up to which a mode does not grow, but at most `limit`; 0 if the mode
/// grows even at dt = 1e-9 * unit. grows(dt, clearly) has the meaning of amplifies(), and `unit` is
/// the time scale of the mode. The search starts at dt = from * unit. If the mode grows clearly
/// there, the search goes down, otherwise up. It does not start at a shorter step, where round-off
/// hides the small growth that methods of high order cause.
template <class Grows>
double first_amplifying_step(Grows const& grows, double unit, double limit, double from) {
  double stable = from * unit, unstable = stable;
  if (stable >= limit) return limit;
  bool const clearly = !grows(stable, true);
  if (!clearly) {
    while (grows(stable, clearly)) {
      unstable = stable;
      stable /= 2;
      if (stable < 1e-9 * unit) return 0;
    }
  } else {
    while (!grows(unstable, clearly)) {
      stable = unstable;
      if (stable >= limit) return limit;
      unstable *= 1.01;
    }
  }
  for (int halving = 0; halving < 60; ++halving) {
    double const middle = 0.5 * (stable + unstable);
    (grows(middle, clearly) ? unstable : stable) = middle;
  }
  return std::min(stable, limit);
}

/// Throws std::invalid_argument for a negative or non-finite bound or damping.
inline void check_bound(double field_bound, double damping) {
  if (!(field_bound >= 0) || !(damping >= 0) ||
      !std::isfinite(field_bound * std::hypot(damping, 1.0)))
    throw std::invalid_argument(
        "cayspin::largest_stable_step: the field bound and the damping must be >= 0 and finite");
}

}  // namespace detail

/// Returns the largest eigenvalue of -|constant| times the discrete Laplacian of the lattice, a
/// bound on the exchange field. Throws std::invalid_argument when the constant is not finite.
inline double exchange_bound(Lattice const& of_spins, double constant) {
  detail::finite(constant, "cayspin::exchange_bound: the constant");
  Lattice const& lattice = whole(of_spins);
  double bound = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const n = static_cast<double>(lattice.shape[axis]);
    if (lattice.shape[axis] <= 1) continue;
    double share = 1;
    if (lattice.boundary[axis] == Boundary::open)
      share = std::pow(std::sin(std::numbers::pi * (n - 1) / (2 * n)), 2);
    else if (lattice.shape[axis] % 2 == 1)
      share = std::pow(std::cos(std::numbers::pi / (2 * n)), 2);
    bound += 4 * std::abs(constant) / (lattice.spacing[axis] * lattice.spacing[axis]) * share;
  }
  return bound;
}

/// Parameters of the equation that largest_stable_step needs in addition to the field and the
/// damping.
struct StabilityOptions {
  bool precession = true;
  double sigma = 0;  ///< of isotropy::Constant
};

/// Returns the largest dt at which no mode of a nearly uniform state grows by more than round-off.
/// It is computed before a run, and never above the stability limit of the linearised equation.
/// Returns 0 when modes grow at every dt, infinity when no mode grows at any dt. `field_bound`:
/// exchange_bound + |applied field| + sum of |anisotropy constants| + sum of |demag strengths|.
/// Throws std::invalid_argument for a bound or a damping that is negative or not finite, and for a
/// sigma that is not finite.
///   largest_stable_step<Rkmk4<Spins>>(field_bound, damping, {.precession = false})
template <class Stepper>
double largest_stable_step(double field_bound, double damping,
                           StabilityOptions const& options = {}) {
  detail::check_bound(field_bound, damping);
  double const sigma = detail::finite(options.sigma, "cayspin::largest_stable_step: sigma");
  double limit = std::numeric_limits<double>::infinity();
  detail::Complex const rate(-damping, options.precession ? 1 : 0);
  if (!(field_bound > 0) || std::abs(rate) == 0) return limit;
  // The end of the search: no explicit method is stable that far.
  limit = 1e3 / (field_bound * std::abs(rate));
  double const scan_end = limit;
  // Without sigma, the limit of a mode is proportional to 1/s, so the stiffest mode decides. With
  // sigma, any mode may decide.
  int const modes = sigma == 0 ? 1 : 400;
  for (int mode = modes; mode >= 1; --mode) {
    auto const of_mode = field_bound * (static_cast<double>(mode) / modes) * rate;
    limit = detail::first_amplifying_step(
        [&](double dt, bool clearly) {
          return detail::amplifies<Stepper>(of_mode, dt, sigma, clearly);
        },
        1 / std::abs(of_mode), limit, sigma == 0 ? 0.05 : 1e-3);
  }
  return limit < scan_end ? limit : std::numeric_limits<double>::infinity();
}

}  // namespace cayspin::inline v0_2
