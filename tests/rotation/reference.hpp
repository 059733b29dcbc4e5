// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"

#include <cayspin/rotation/cayley.hpp>
#include <cayspin/rotation/exponential.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// Reference versions of the Cayley and exponential maps in long double, computed from their
// definitions by formulas other than the library's.
namespace cayspin::test {

using Long = std::array<long double, 3>;

inline Long operator+(Long const& a, Long const& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Long operator-(Long const& a, Long const& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Long operator*(long double s, Long const& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline long double inner(Long const& a, Long const& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Long outer(Long const& a, Long const& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline long double norm(Long const& a) { return std::sqrt(inner(a, a)); }
/// Returns the largest magnitude, or NaN if an entry is NaN, which std::max might pass over.
inline long double largest(Long const& a) {
  for (long double const x : a)
    if (std::isnan(x)) return x;
  return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
}

template <class Real>
Long widen(Vec3<Real> const& a) {
  return {a.x, a.y, a.z};
}
template <class Real>
Vec3<Real> narrow(Long const& a) {
  return {static_cast<Real>(a[0]), static_cast<Real>(a[1]), static_cast<Real>(a[2])};
}

inline Long cayley(Long const& f, Long const& x) {
  Long const c = outer(f, x);
  return x + (1 / (1 + inner(f, f) / 4)) * (c + 0.5L * outer(f, c));
}
inline Long cayley_tangent(Long const& f, Long const& y) {
  return (1 / (1 + inner(f, f) / 4)) * (y + 0.5L * outer(f, y));
}
inline Long cayley_inverse_tangent(Long const& f, Long const& y) {
  return y - 0.5L * outer(f, y) + (inner(f, y) / 4) * f;
}

/// Rodrigues' rotation: about f, by the angle |f|.
inline Long exponential(Long const& f, Long const& x) {
  long double const n = norm(f);
  if (n == 0) return x;
  Long const u = (1 / n) * f, c = outer(u, x);
  long double const half = std::sin(n / 2);
  return x + std::sin(n) * c + (2 * half * half) * outer(u, c);
}
/// Returns (1 - n/2 * cot(n/2)) / n^2.
inline long double exponential_coefficient(long double n) {
  if (n < 1e-3L) return 1 / 12.L + n * n / 720 + n * n * n * n / 30240;
  return (1 - n / 2 / std::tan(n / 2)) / (n * n);
}
inline Long exponential_inverse_tangent(Long const& f, Long const& y) {
  Long const c = outer(f, y);
  return y - 0.5L * c + exponential_coefficient(norm(f)) * outer(f, c);
}

/// Returns a random direction for this seed, normalised in long double.
inline Long direction(unsigned seed) {
  auto const d = random_directions(1, seed);
  Long const a{d[0], d[1], d[2]};
  return (1 / norm(a)) * a;
}

}  // namespace cayspin::test
