// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hand_written_chain.hpp"

#include <cmath>
#include <utility>

namespace hand_written {
namespace {

struct Numbers {
  double *x, *y, *z;
};

Numbers numbers(Vectors<double> const& v) { return {v.x.data, v.y.data, v.z.data}; }

struct Vector {
  double x, y, z;
};

[[gnu::always_inline]] inline Vector slope(Chain const& c, Numbers const& v, std::size_t i,
                                           std::size_t left, std::size_t right) {
  double const mx = v.x[i], my = v.y[i], mz = v.z[i];
  double const hx = c.exchange * (v.x[left] + v.x[right] - 2 * mx);
  double const hy = c.exchange * (v.y[left] + v.y[right] - 2 * my);
  double const hz = c.exchange * (v.z[left] + v.z[right] - 2 * mz) + c.anisotropy * mz + c.applied;
  double const ax = hx + c.damping * (my * hz - mz * hy);
  double const ay = hy + c.damping * (mz * hx - mx * hz);
  double const az = hz + c.damping * (mx * hy - my * hx);
  return {ay * mz - az * my, az * mx - ax * mz, ax * my - ay * mx};
}

// Calls body(i, slope) for every site; a missing neighbour is the site itself.
template <class Body>
[[gnu::always_inline]] inline void for_each(Chain const& c, Numbers const v, Body body) {
  std::size_t const end = c.n - 1;
  body(0, slope(c, v, 0, 0, 1));
#pragma GCC ivdep
  for (std::size_t i = 1; i < end; ++i) body(i, slope(c, v, i, i - 1, i + 1));
  body(end, slope(c, v, end, end - 1, end));
}

[[gnu::always_inline]] inline void store(Vector const& v, Numbers const& to, std::size_t i) {
  to.x[i] = v.x, to.y[i] = v.y, to.z[i] = v.z;
}
[[gnu::always_inline]] inline Vector moved(Numbers const& from, std::size_t i, double step,
                                           Vector const& s) {
  return {from.x[i] + step * s.x, from.y[i] + step * s.y, from.z[i] + step * s.z};
}
[[gnu::always_inline]] inline void store_unit(Vector const& v, Numbers const& to, std::size_t i) {
  double const scale = 1 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  store({scale * v.x, scale * v.y, scale * v.z}, to, i);
}

}  // namespace

template <Loops loops>
ChainSteps<loops>::ChainSteps(Chain const& chain)
    : chain_(chain), v_(chain.n), w_(chain.n), sum_(chain.n) {}

template <Loops loops>
void ChainSteps<loops>::euler(Vectors<double>& spins, double dt, std::int64_t steps) {
  Chain const chain = chain_;
  Numbers m = numbers(spins), next = numbers(v_);
  for (std::int64_t step = 0; step < steps; ++step) {
    for_each(chain, m,
             [=](std::size_t i, Vector const& s) { store_unit(moved(m, i, dt, s), next, i); });
    std::swap(m, next);
  }
  if (m.x != spins.x.data)
    for (std::size_t i = 0; i < chain.n; ++i) store({m.x[i], m.y[i], m.z[i]}, next, i);
}

template <Loops loops>
void ChainSteps<loops>::heun(Vectors<double>& spins, double dt, std::int64_t steps) {
  Chain const chain = chain_;
  Numbers const m = numbers(spins), v = numbers(v_), k = numbers(sum_);
  double const half = dt / 2;
  for (std::int64_t step = 0; step < steps; ++step) {
    for_each(chain, m, [=](std::size_t i, Vector const& s) {
      store(s, k, i);
      store(moved(m, i, dt, s), v, i);
    });
    for_each(chain, v, [=](std::size_t i, Vector const& s) {
      store_unit(moved(m, i, half, {k.x[i] + s.x, k.y[i] + s.y, k.z[i] + s.z}), m, i);
    });
  }
}

template <Loops loops>
void ChainSteps<loops>::runge_kutta4(Vectors<double>& spins, double dt, std::int64_t steps) {
  Chain const chain = chain_;
  Numbers const m = numbers(spins), v = numbers(v_), w = numbers(w_), sum = numbers(sum_);
  double const half = dt / 2, sixth = dt / 6;
  for (std::int64_t step = 0; step < steps; ++step) {
    for_each(chain, m, [=](std::size_t i, Vector const& s) {
      store(s, sum, i);
      store(moved(m, i, half, s), v, i);
    });
    for_each(chain, v, [=](std::size_t i, Vector const& s) {
      store(moved(sum, i, 2, s), sum, i);
      store(moved(m, i, half, s), w, i);
    });
    for_each(chain, w, [=](std::size_t i, Vector const& s) {
      store(moved(sum, i, 2, s), sum, i);
      store(moved(m, i, dt, s), v, i);
    });
    for_each(chain, v, [=](std::size_t i, Vector const& s) {
      store_unit(moved(m, i, sixth, moved(sum, i, 1, s)), m, i);
    });
  }
}

template class ChainSteps<Loops::HAND_WRITTEN_LOOPS>;

}  // namespace hand_written
