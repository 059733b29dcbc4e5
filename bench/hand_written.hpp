// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <new>
#include <vector>

// What a good engineer writes in a day for exactly one scene, without a library: separate component
// arrays, OpenMP over rows, a vectorised inner loop, one fused loop per stage, renormalised at the
// end of the step. Exchange with six neighbours (open ends), uniaxial anisotropy and field along z,
// damping. It is the yardstick of the benchmarks: it shares no code with cayspin, and is compiled
// on its own with the flags that serve it best.
namespace hand_written {

/// Asks for 2 MiB pages; without them the loop waits for address translation beyond the caches.
void advise_huge_pages(void* begin, std::size_t bytes);

template <class Real>
struct Array {
  explicit Array(std::size_t n)
      : data(static_cast<Real*>(::operator new(n * sizeof(Real), std::align_val_t(64)))) {
    advise_huge_pages(data, n * sizeof(Real));
  }
  ~Array() { ::operator delete(data, std::align_val_t(64)); }
  Array(Array const&) = delete;
  Array& operator=(Array const&) = delete;
  Real* data;
};

template <class Real>
struct Vectors {
  explicit Vectors(std::size_t n) : x(n), y(n), z(n) {}
  Array<Real> x, y, z;
};

/// From (sites, 3); each thread touches first what it works on.
template <class Real>
void fill(Vectors<Real>& vectors, std::vector<double> const& from);

/// n x n x n sites and the coefficients of the scene.
template <class Real>
struct Cube {
  int n;
  Real exchange, anisotropy, applied, damping;

  std::size_t sites() const { return static_cast<std::size_t>(n) * n * n; }
};

template <class Real>
class Heun {
 public:
  explicit Heun(Cube<Real> const& cube) : cube_(cube), v_(cube.sites()), k_(cube.sites()) {}
  void step(Vectors<Real>& m, Real dt);

 private:
  Cube<Real> cube_;
  Vectors<Real> v_, k_;
};

template <class Real>
class RungeKutta4 {
 public:
  explicit RungeKutta4(Cube<Real> const& cube)
      : cube_(cube), v_(cube.sites()), w_(cube.sites()), sum_(cube.sites()) {}
  void step(Vectors<Real>& m, Real dt);

 private:
  template <bool First>
  void stage(Vectors<Real> const& m, Vectors<Real> const& at, Vectors<Real>& next, Real step,
             Real weight);

  Cube<Real> cube_;
  Vectors<Real> v_, w_, sum_;
};

}  // namespace hand_written
