// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hand_written_crystal.hpp"

#include <cmath>

namespace hand_written {
namespace {

template <class Real>
struct Sum {
  Real x = 0, y = 0, z = 0;

  [[gnu::always_inline]] void add(Vectors<Real> const& v, std::size_t i) {
    x += v.x.data[i], y += v.y.data[i], z += v.z.data[i];
  }
};

/// The rows that a row has neighbours in: four of the other sites of cells, and, for the second
/// shell, itself and four of its own.
struct RowsBeside {
  std::size_t other[4], own, along[4];
};

// Calls body(i, exchange field) for every site of a row; the two ends stand outside the loop.
template <bool SecondShell, bool SecondSite, class Real, class Body>
[[gnu::always_inline]] inline void for_row(Bcc<Real> const& bcc, Vectors<Real> const& v,
                                           RowsBeside const& rows, Body const& body) {
  auto const n = static_cast<std::size_t>(bcc.n);
  auto const at = [&](std::size_t x, std::size_t left, std::size_t right) {
    Sum<Real> first, second;
    for (std::size_t const row : rows.other) {
      first.add(v, row + x);
      first.add(v, row + (SecondSite ? right : left));
    }
    if constexpr (SecondShell) {
      second.add(v, rows.own + left), second.add(v, rows.own + right);
      for (std::size_t const row : rows.along) second.add(v, row + x);
    }
    body(rows.own + x, Sum<Real>{bcc.first_shell * first.x + bcc.second_shell * second.x,
                                 bcc.first_shell * first.y + bcc.second_shell * second.y,
                                 bcc.first_shell * first.z + bcc.second_shell * second.z});
  };
  at(0, n - 1, 1);
#pragma GCC ivdep
  for (std::size_t x = 1; x < n - 1; ++x) at(x, x - 1, x + 1);
  at(n - 1, n - 2, 0);
}

template <bool SecondShell, class Real, class Body>
void for_each(Bcc<Real> const& bcc, Vectors<Real> const& v, Body body) {
  auto const n = static_cast<std::size_t>(bcc.n);
  auto const row_at = [n](std::size_t site, std::size_t y, std::size_t z) {
    return ((2 * (z % n) + site) * n + y % n) * n;
  };
#pragma omp parallel for collapse(2) schedule(static)
  for (std::size_t plane = 0; plane < 2 * n; ++plane)
    for (std::size_t y = 0; y < n; ++y) {
      std::size_t const z = plane / 2, site = plane % 2;
      // The four cells along y and z with the nearest other sites begin one back, or here.
      std::size_t const back = site == 0 ? n - 1 : 0;
      RowsBeside const rows{
          {row_at(1 - site, y + back, z + back), row_at(1 - site, y + back + 1, z + back),
           row_at(1 - site, y + back, z + back + 1), row_at(1 - site, y + back + 1, z + back + 1)},
          row_at(site, y, z),
          {row_at(site, y + n - 1, z), row_at(site, y + 1, z), row_at(site, y, z + n - 1),
           row_at(site, y, z + 1)}};
      if (site == 0)
        for_row<SecondShell, false>(bcc, v, rows, body);
      else
        for_row<SecondShell, true>(bcc, v, rows, body);
    }
}

template <class Real>
[[gnu::always_inline]] inline Sum<Real> slope(Bcc<Real> const& c, Vectors<Real> const& v,
                                              std::size_t i, Sum<Real> h) {
  Real const mx = v.x.data[i], my = v.y.data[i], mz = v.z.data[i];
  h.z += c.applied;
  Real const ax = h.x + c.damping * (my * h.z - mz * h.y);
  Real const ay = h.y + c.damping * (mz * h.x - mx * h.z);
  Real const az = h.z + c.damping * (mx * h.y - my * h.x);
  return {ay * mz - az * my, az * mx - ax * mz, ax * my - ay * mx};
}

}  // namespace

template <class Real, bool SecondShell>
void HeunOnBcc<Real, SecondShell>::step(Vectors<Real>& m, Real dt) {
  Bcc<Real> const bcc = bcc_;
  Vectors<Real>&v = v_, &k = k_;
  for_each<SecondShell>(bcc, m, [&, bcc](std::size_t i, Sum<Real> const& h) {
    auto const s = slope(bcc, m, i, h);
    k.x.data[i] = s.x, k.y.data[i] = s.y, k.z.data[i] = s.z;
    v.x.data[i] = m.x.data[i] + dt * s.x;
    v.y.data[i] = m.y.data[i] + dt * s.y;
    v.z.data[i] = m.z.data[i] + dt * s.z;
  });
  for_each<SecondShell>(bcc, v, [&, bcc](std::size_t i, Sum<Real> const& h) {
    auto const s = slope(bcc, v, i, h);
    Real const half = dt / 2;
    Real const x = m.x.data[i] + half * (k.x.data[i] + s.x);
    Real const y = m.y.data[i] + half * (k.y.data[i] + s.y);
    Real const z = m.z.data[i] + half * (k.z.data[i] + s.z);
    Real const scale = 1 / std::sqrt(x * x + y * y + z * z);
    m.x.data[i] = scale * x, m.y.data[i] = scale * y, m.z.data[i] = scale * z;
  });
}

template class HeunOnBcc<float, false>;
template class HeunOnBcc<float, true>;
template class HeunOnBcc<double, false>;
template class HeunOnBcc<double, true>;

}  // namespace hand_written
