// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hand_written.hpp"

#include <cmath>
#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hand_written {

void advise_huge_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  constexpr std::uintptr_t page = std::uintptr_t(2) << 20;
  auto const address = reinterpret_cast<std::uintptr_t>(begin);
  std::uintptr_t const first = (address + page - 1) / page * page;
  std::uintptr_t const last = (address + bytes) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

namespace {

template <class Real>
struct Slope {
  Real x, y, z;
};

template <class Real>
[[gnu::always_inline]] inline Slope<Real> slope(Cube<Real> const& c, Vectors<Real> const& v,
                                                std::size_t i, std::size_t left, std::size_t right,
                                                std::size_t down, std::size_t up, std::size_t front,
                                                std::size_t back) {
  Real const mx = v.x.data[i], my = v.y.data[i], mz = v.z.data[i];
  Real const lx = v.x.data[left] + v.x.data[right] + v.x.data[down] + v.x.data[up] +
                  v.x.data[front] + v.x.data[back] - 6 * mx;
  Real const ly = v.y.data[left] + v.y.data[right] + v.y.data[down] + v.y.data[up] +
                  v.y.data[front] + v.y.data[back] - 6 * my;
  Real const lz = v.z.data[left] + v.z.data[right] + v.z.data[down] + v.z.data[up] +
                  v.z.data[front] + v.z.data[back] - 6 * mz;
  Real const hx = c.exchange * lx, hy = c.exchange * ly;
  Real const hz = c.exchange * lz + c.anisotropy * mz + c.applied;
  Real const ax = hx + c.damping * (my * hz - mz * hy);
  Real const ay = hy + c.damping * (mz * hx - mx * hz);
  Real const az = hz + c.damping * (mx * hy - my * hx);
  return {ay * mz - az * my, az * mx - ax * mz, ax * my - ay * mx};
}

// Calls body(i, left, right, down, up, front, back) for every site; a missing neighbour is the
// site itself. The inner loop has no branch; the two ends of a row stand outside it.
template <class Real, class Body>
void for_each(Cube<Real> const& cube, Body body) {
  std::size_t const row = static_cast<std::size_t>(cube.n), plane = row * row;
  int const n = cube.n;
#pragma omp parallel for collapse(2) schedule(static)
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y) {
      std::size_t const o = static_cast<std::size_t>(z) * plane + static_cast<std::size_t>(y) * row;
      std::size_t const down = y > 0 ? o - row : o, up = y + 1 < n ? o + row : o;
      std::size_t const front = z > 0 ? o - plane : o, back = z + 1 < n ? o + plane : o;
      std::size_t const end = row - 1;
      body(o, o, o + 1, down, up, front, back);
#pragma GCC ivdep
      for (std::size_t x = 1; x < end; ++x)
        body(o + x, o + x - 1, o + x + 1, down + x, up + x, front + x, back + x);
      body(o + end, o + end - 1, o + end, down + end, up + end, front + end, back + end);
    }
}

}  // namespace

template <class Real>
void fill(Vectors<Real>& vectors, std::vector<double> const& from) {
  std::size_t const sites = from.size() / 3;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < sites; ++i) {
    vectors.x.data[i] = static_cast<Real>(from[3 * i]);
    vectors.y.data[i] = static_cast<Real>(from[3 * i + 1]);
    vectors.z.data[i] = static_cast<Real>(from[3 * i + 2]);
  }
}

template <class Real>
void Heun<Real>::step(Vectors<Real>& m, Real dt) {
  Cube<Real> const cube = cube_;
  Vectors<Real>&v = v_, &k = k_;
  for_each(cube, [&, cube](std::size_t i, auto... neighbors) {
    auto const s = slope(cube, m, i, neighbors...);
    k.x.data[i] = s.x, k.y.data[i] = s.y, k.z.data[i] = s.z;
    v.x.data[i] = m.x.data[i] + dt * s.x;
    v.y.data[i] = m.y.data[i] + dt * s.y;
    v.z.data[i] = m.z.data[i] + dt * s.z;
  });
  for_each(cube, [&, cube](std::size_t i, auto... neighbors) {
    auto const s = slope(cube, v, i, neighbors...);
    Real const half = dt / 2;
    Real const x = m.x.data[i] + half * (k.x.data[i] + s.x);
    Real const y = m.y.data[i] + half * (k.y.data[i] + s.y);
    Real const z = m.z.data[i] + half * (k.z.data[i] + s.z);
    Real const scale = 1 / std::sqrt(x * x + y * y + z * z);
    m.x.data[i] = scale * x, m.y.data[i] = scale * y, m.z.data[i] = scale * z;
  });
}

template <class Real>
template <bool First>
void RungeKutta4<Real>::stage(Vectors<Real> const& m, Vectors<Real> const& at, Vectors<Real>& next,
                              Real step, Real weight) {
  Cube<Real> const cube = cube_;
  Vectors<Real>& sum = sum_;
  for_each(cube, [&, cube](std::size_t i, auto... neighbors) {
    auto const s = slope(cube, at, i, neighbors...);
    sum.x.data[i] = First ? s.x : sum.x.data[i] + weight * s.x;
    sum.y.data[i] = First ? s.y : sum.y.data[i] + weight * s.y;
    sum.z.data[i] = First ? s.z : sum.z.data[i] + weight * s.z;
    next.x.data[i] = m.x.data[i] + step * s.x;
    next.y.data[i] = m.y.data[i] + step * s.y;
    next.z.data[i] = m.z.data[i] + step * s.z;
  });
}

template <class Real>
void RungeKutta4<Real>::step(Vectors<Real>& m, Real dt) {
  Cube<Real> const cube = cube_;
  stage<true>(m, m, v_, dt / 2, 1);
  stage<false>(m, v_, w_, dt / 2, 2);
  stage<false>(m, w_, v_, dt, 2);
  Vectors<Real>&v = v_, &sum = sum_;
  for_each(cube, [&, cube](std::size_t i, auto... neighbors) {
    auto const s = slope(cube, v, i, neighbors...);
    Real const sixth = dt / 6;
    Real const x = m.x.data[i] + sixth * (sum.x.data[i] + s.x);
    Real const y = m.y.data[i] + sixth * (sum.y.data[i] + s.y);
    Real const z = m.z.data[i] + sixth * (sum.z.data[i] + s.z);
    Real const scale = 1 / std::sqrt(x * x + y * y + z * z);
    m.x.data[i] = scale * x, m.y.data[i] = scale * y, m.z.data[i] = scale * z;
  });
}

template void fill(Vectors<float>&, std::vector<double> const&);
template void fill(Vectors<double>&, std::vector<double> const&);
template class Heun<float>;
template class Heun<double>;
template class RungeKutta4<float>;
template class RungeKutta4<double>;

}  // namespace hand_written
