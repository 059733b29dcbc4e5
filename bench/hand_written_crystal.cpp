// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hand_written_steps.hpp"

namespace hand_written {

template <class Real>
HAND_WRITTEN_INLINE void add(Numbers<Real> const& v, std::size_t i, Vector<Real>& sum) {
  sum.x += v.x[i], sum.y += v.y[i], sum.z += v.z[i];
}

/// Indices of the first sites of the rows that hold the neighbours of a row: four rows of the other
/// site of the cells and, for the second shell, the row itself (`own`) and four rows of the same
/// site (`along`).
struct RowsBeside {
  std::size_t other[4], own, along[4];
};

// The two ends of a row are handled outside the loop.
template <bool SecondSite, class Real, bool SecondShell, class Body>
HAND_WRITTEN_INLINE void for_row(Bcc<Real, SecondShell> const& bcc, Numbers<Real> const& v,
                                 RowsBeside const& rows, Body const& body) {
  auto const n = static_cast<std::size_t>(bcc.n);
  auto const at = [=, bcc = bcc](std::size_t x, std::size_t left, std::size_t right) {
    Vector<Real> first{}, second{};
    for (std::size_t const row : rows.other) {
      add(v, row + x, first);
      add(v, row + (SecondSite ? right : left), first);
    }
    if constexpr (SecondShell) {
      add(v, rows.own + left, second), add(v, rows.own + right, second);
      for (std::size_t const row : rows.along) add(v, row + x, second);
    }
    std::size_t const i = rows.own + x;
    body(i, rate(bcc.damping, {v.x[i], v.y[i], v.z[i]},
                 {bcc.first_shell * first.x + bcc.second_shell * second.x,
                  bcc.first_shell * first.y + bcc.second_shell * second.y,
                  bcc.first_shell * first.z + bcc.second_shell * second.z + bcc.applied}));
  };
  at(0, n - 1, 1);
#pragma GCC ivdep
  for (std::size_t x = 1; x < n - 1; ++x) at(x, x - 1, x + 1);
  at(n - 1, n - 2, 0);
}

template <class Real, bool SecondShell, class Body>
void for_each(Bcc<Real, SecondShell> const& bcc, Numbers<Real> const v, Body body) {
  auto const n = static_cast<std::size_t>(bcc.n);
  auto const row_at = [n](std::size_t site, std::size_t y, std::size_t z) {
    return ((2 * (z % n) + site) * n + y % n) * n;
  };
#pragma omp parallel for collapse(2) schedule(static) firstprivate(body)
  for (std::size_t plane = 0; plane < 2 * n; ++plane)
    for (std::size_t y = 0; y < n; ++y) {
      std::size_t const z = plane / 2, site = plane % 2;
      // The nearest sites of the other kind are in 2 x 2 cells along y and z. For site 0 these are
      // the cell before and this cell; for site 1, this cell and the next.
      std::size_t const back = site == 0 ? n - 1 : 0;
      RowsBeside const rows{
          {row_at(1 - site, y + back, z + back), row_at(1 - site, y + back + 1, z + back),
           row_at(1 - site, y + back, z + back + 1), row_at(1 - site, y + back + 1, z + back + 1)},
          row_at(site, y, z),
          {row_at(site, y + n - 1, z), row_at(site, y + 1, z), row_at(site, y, z + n - 1),
           row_at(site, y, z + 1)}};
      if (site == 0)
        for_row<false>(bcc, v, rows, body);
      else
        for_row<true>(bcc, v, rows, body);
    }
}

// The benchmark uses only Heun's method.
template void Steps<Bcc<float, false>>::heun(Vectors<float>&, float, std::int64_t);
template void Steps<Bcc<float, true>>::heun(Vectors<float>&, float, std::int64_t);
template void Steps<Bcc<double, false>>::heun(Vectors<double>&, double, std::int64_t);
template void Steps<Bcc<double, true>>::heun(Vectors<double>&, double, std::int64_t);

}  // namespace hand_written
