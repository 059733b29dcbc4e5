// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hand_written.hpp"

#include <cmath>
#include <utility>

// The steps of all scenes. A file that includes this defines for_each(scene, spins, body), which
// calls body(site, dm/dt) for every site. Everything is inlined, because the files that include
// this are compiled with different options.
namespace hand_written {

#define HAND_WRITTEN_INLINE [[gnu::always_inline]] inline

template <class Real>
struct Vector {
  Real x, y, z;
};

template <class Real>
struct Numbers {
  Real *x, *y, *z;
};
template <class Real>
HAND_WRITTEN_INLINE Numbers<Real> numbers(Vectors<Real> const& v) {
  return {v.x.data, v.y.data, v.z.data};
}

template <class Real>
HAND_WRITTEN_INLINE void store(Vector<Real> const& v, Numbers<Real> const& to, std::size_t i) {
  to.x[i] = v.x, to.y[i] = v.y, to.z[i] = v.z;
}
template <class Real>
HAND_WRITTEN_INLINE void store_unit(Vector<Real> const& v, Numbers<Real> const& to, std::size_t i) {
  Real const scale = 1 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  store({scale * v.x, scale * v.y, scale * v.z}, to, i);
}
template <class Real>
HAND_WRITTEN_INLINE Vector<Real> moved(Numbers<Real> const& from, std::size_t i, Real step,
                                       Vector<Real> const& s) {
  return {from.x[i] + step * s.x, from.y[i] + step * s.y, from.z[i] + step * s.z};
}

/// Returns A x m, where A = h + damping * (m x h).
template <class Real>
HAND_WRITTEN_INLINE Vector<Real> rate(Real damping, Vector<Real> const& m, Vector<Real> const& h) {
  Real const ax = h.x + damping * (m.y * h.z - m.z * h.y);
  Real const ay = h.y + damping * (m.z * h.x - m.x * h.z);
  Real const az = h.z + damping * (m.x * h.y - m.y * h.x);
  return {ay * m.z - az * m.y, az * m.x - ax * m.z, ax * m.y - ay * m.x};
}

template <class Scene>
void Steps<Scene>::euler(Vectors<Real>& spins, Real dt, std::int64_t steps) {
  Scene const scene = scene_;
  auto m = numbers(spins), next = numbers(v_);
  for (std::int64_t step = 0; step < steps; ++step) {
    for_each(scene, m, [=](std::size_t i, Vector<Real> const& s) {
      store_unit(moved(m, i, dt, s), next, i);
    });
    std::swap(m, next);
  }
  if (m.x != spins.x.data)
    for (std::size_t i = 0; i < scene.sites(); ++i) store<Real>({m.x[i], m.y[i], m.z[i]}, next, i);
}

template <class Scene>
void Steps<Scene>::heun(Vectors<Real>& spins, Real dt, std::int64_t steps) {
  Scene const scene = scene_;
  auto const m = numbers(spins), v = numbers(v_), k = numbers(sum_);
  Real const half = dt / 2;
  for (std::int64_t step = 0; step < steps; ++step) {
    for_each(scene, m, [=](std::size_t i, Vector<Real> const& s) {
      store(s, k, i);
      store(moved(m, i, dt, s), v, i);
    });
    for_each(scene, v, [=](std::size_t i, Vector<Real> const& s) {
      store_unit(moved(m, i, half, {k.x[i] + s.x, k.y[i] + s.y, k.z[i] + s.z}), m, i);
    });
  }
}

template <class Scene>
void Steps<Scene>::runge_kutta4(Vectors<Real>& spins, Real dt, std::int64_t steps) {
  Scene const scene = scene_;
  auto const m = numbers(spins), v = numbers(v_), w = numbers(w_), sum = numbers(sum_);
  Real const half = dt / 2, sixth = dt / 6;
  for (std::int64_t step = 0; step < steps; ++step) {
    for_each(scene, m, [=](std::size_t i, Vector<Real> const& s) {
      store(s, sum, i);
      store(moved(m, i, half, s), v, i);
    });
    for_each(scene, v, [=](std::size_t i, Vector<Real> const& s) {
      store(moved(sum, i, Real(2), s), sum, i);
      store(moved(m, i, half, s), w, i);
    });
    for_each(scene, w, [=](std::size_t i, Vector<Real> const& s) {
      store(moved(sum, i, Real(2), s), sum, i);
      store(moved(m, i, dt, s), v, i);
    });
    for_each(scene, v, [=](std::size_t i, Vector<Real> const& s) {
      store_unit(moved(m, i, sixth, moved(sum, i, Real(1), s)), m, i);
    });
  }
}

}  // namespace hand_written
