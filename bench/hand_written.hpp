// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

// Code that a good engineer writes in a day for exactly one scene, without a library: separate
// component arrays, OpenMP over rows, a vectorised inner loop, one fused loop per stage,
// renormalised at the end of the step. The benchmarks compare cayspin with this code, which shares
// nothing with cayspin and is compiled separately with the flags that suit it best.
namespace hand_written {

/// Requests 2 MiB pages. Without them, loops over arrays larger than the caches wait for address
/// translation.
void advise_huge_pages(void* begin, std::size_t bytes);

template <class Number>
struct Array {
  explicit Array(std::size_t n)
      : data(static_cast<Number*>(::operator new(n * sizeof(Number), std::align_val_t(64)))) {
    advise_huge_pages(data, n * sizeof(Number));
  }
  ~Array() { ::operator delete(data, std::align_val_t(64)); }
  Array(Array const&) = delete;
  Array& operator=(Array const&) = delete;
  Number* data;
};

template <class Number>
struct Vectors {
  explicit Vectors(std::size_t n) : x(n), y(n), z(n) {}
  Array<Number> x, y, z;
};

/// Copies from an array (sites, 3); each thread is the first to touch the memory that it works on.
template <class Number>
void fill(Vectors<Number>& vectors, std::vector<double> const& from);
/// Returns a copy as an array (sites, 3).
template <class Number>
std::vector<double> numbers_of(Vectors<Number> const& vectors, std::size_t sites);

/// n x n x n sites: exchange with six neighbours (open ends), uniaxial anisotropy and field along
/// z, damping.
template <class Number>
struct Cube {
  using Real = Number;
  int n;
  Real exchange, anisotropy, applied, damping;

  std::size_t sites() const { return static_cast<std::size_t>(n) * n * n; }
};

/// bcc, n x n x n periodic cells of two sites: exchange with 8 neighbours (14 with the second
/// shell), a field along z, damping. The positions of all neighbours are hard-coded. For each z,
/// the spins of site 0 of all cells come before those of site 1.
template <class Number, bool SecondShell>
struct Bcc {
  using Real = Number;
  int n;
  Real first_shell, second_shell, applied, damping;

  std::size_t sites() const { return 2 * static_cast<std::size_t>(n) * n * n; }
};

/// One source, compiled twice: scalar, and vectorised by the compiler.
enum class Loops { scalar, vectorized };

/// n sites along x with open ends, otherwise like Cube, in double, on one thread.
template <Loops>
struct Chain {
  using Real = double;
  std::size_t n;
  double exchange, anisotropy, applied, damping;

  std::size_t sites() const { return n; }
};

/// Takes steps of one of these scenes: one loop over the sites for each stage. Spins are
/// renormalised at the end of a step.
template <class Scene>
class Steps {
  using Real = typename Scene::Real;

 public:
  explicit Steps(Scene const& scene)
      : scene_(scene), v_(scene.sites()), w_(scene.sites()), sum_(scene.sites()) {}

  void euler(Vectors<Real>& m, Real dt, std::int64_t steps = 1);
  void heun(Vectors<Real>& m, Real dt, std::int64_t steps = 1);
  void runge_kutta4(Vectors<Real>& m, Real dt, std::int64_t steps = 1);

 private:
  Scene scene_;
  Vectors<Real> v_, w_, sum_;
};

}  // namespace hand_written
