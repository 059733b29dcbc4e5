// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Linear systems on lattices, and the residuals that solvers leave.
namespace cayspin::test {

using Number = std::complex<double>;
using Numbers = std::vector<Number>;  // (sites, 3)

struct Problem {
  std::string name;
  Lattice lattice;
  std::array<double, 3> couplings;
};

inline Lattice closed(Lattice lattice) {
  lattice.boundary.fill(Boundary::periodic);
  return lattice;
}

/// Lattices of many sizes with open and periodic axes, where two or three axes couple.
inline std::vector<Problem> grids() {
  auto mixed = Lattice::cubic(9, 14, 5);
  mixed.boundary[1] = Boundary::periodic;
  return {{"33 x 47", Lattice::square(33, 47), {80, 80, 0}},
          {"33 x 47 periodic", closed(Lattice::square(33, 47)), {80, 80, 0}},
          {"31 x 2, one axis stronger", Lattice::square(31, 2), {300, 20, 0}},
          {"17 x 16 periodic, one axis weaker", closed(Lattice::square(17, 16)), {3, 50, 0}},
          {"15 x 15 x 15", Lattice::cubic(15, 15, 15), {5000, 5000, 5000}},
          {"9 x 14 x 5 mixed", mixed, {60, 40, 55}},
          {"weak", Lattice::square(12, 11), {1e-3, 1e-3, 0}}};
}

/// Lattices where at most one axis couples.
inline std::vector<Problem> lines() {
  std::vector<Problem> problems;
  for (std::int64_t const n : {2, 3, 4, 5, 100})
    for (bool const periodic : {false, true}) {
      auto const add = [&](char const* axis, Lattice const& lattice,
                           std::array<double, 3> couplings) {
        problems.push_back({axis + std::to_string(n) + (periodic ? " periodic" : ""),
                            periodic ? closed(lattice) : lattice, couplings});
      };
      add("x ", Lattice::chain(n), {700, 0, 0});
      add("x in planes ", Lattice::cubic(n, 3, 2), {700, 0, 0});
      add("x in padded planes ", Lattice::cubic(12 + n, 16, 4), {700, 0, 0});
      add("y ", Lattice::cubic(37, n, 3), {0, 30, 0});
      add("z ", Lattice::cubic(5, 2, n), {0, 0, 2e4});
    }
  problems.push_back({"one site", Lattice::chain(1), {700, 0, 0}});
  problems.push_back({"no coupling", Lattice::square(5, 4), {0, 0, 0}});
  problems.push_back({"x 1031", Lattice::chain(1031), {700, 0, 0}});
  problems.push_back({"x 1030 periodic", closed(Lattice::chain(1030)), {700, 0, 0}});
  return problems;
}

/// Lattices with antiferromagnetic neighbours along some axes.
inline std::vector<Problem> alternating() {
  auto mixed = Lattice::cubic(9, 14, 5);
  mixed.boundary[1] = Boundary::periodic;
  return {{"x 9", Lattice::chain(9), {-700, 0, 0}},
          {"x 10 periodic", closed(Lattice::chain(10)), {-700, 0, 0}},
          {"y 2 periodic", closed(Lattice::cubic(9, 2, 3)), {0, -30, 0}},
          {"y 8", Lattice::cubic(9, 8, 3), {0, -30, 0}},
          {"33 x 47", Lattice::square(33, 47), {-80, -80, 0}},
          {"9 x 14 x 5 mixed", mixed, {60, -40, -55}}};
}

/// Returns (c + b * K) * u, where K is minus the Laplacian with the couplings of the axes; for a
/// negative coupling, neighbours are added instead of subtracted.
inline Numbers applied(Problem const& problem, double c, Number b, Numbers const& u) {
  auto const& shape = problem.lattice.shape;
  Numbers result(u.size());
  for (std::int64_t site = 0; site < problem.lattice.sites(); ++site) {
    std::array const index{site % shape[0], site / shape[0] % shape[1], site / shape[0] / shape[1]};
    for (std::int64_t component = 0; component < 3; ++component) {
      auto const here = static_cast<std::size_t>(3 * site + component);
      Number sum = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::int64_t const way : {-1, 1}) {
          auto other = index;
          other[axis] += way;
          bool const outside = other[axis] < 0 || other[axis] >= shape[axis];
          if (shape[axis] == 1 || (outside && problem.lattice.boundary[axis] == Boundary::open))
            continue;
          other[axis] = (other[axis] + shape[axis]) % shape[axis];
          std::int64_t const there = (other[2] * shape[1] + other[1]) * shape[0] + other[0];
          double const coupling = problem.couplings[axis];
          sum += std::abs(coupling) * u[here] -
                 coupling * u[static_cast<std::size_t>(3 * there + component)];
        }
      result[here] = c * u[here] + b * sum;
    }
  }
  return result;
}

inline double length(Numbers const& u) {
  double square = 0;
  for (Number const& value : u) square += std::norm(value);
  return std::sqrt(square);
}

inline Numbers difference(Numbers u, Numbers const& v) {
  for (std::size_t i = 0; i < u.size(); ++i) u[i] -= v[i];
  return u;
}

template <int Components, class Real, class MemorySpace>
Numbers numbers_from(SiteField<Real, Components, MemorySpace> const& field) {
  auto const held = copy_to_host(field);
  Numbers numbers(held.size() * 3 / Components);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::size_t const at = i / 3 * Components + i % 3;
    numbers[i] = {held[at], Components == 6 ? held[at + 3] : Real(0)};
  }
  return numbers;
}
template <class Field>
Field field_of(Lattice const& lattice, Numbers const& numbers) {
  Field field("numbers", lattice);
  constexpr std::size_t components = Field::components;
  std::vector<double> held(numbers.size() * components / 3);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::size_t const at = i / 3 * components + i % 3;
    held[at] = numbers[i].real();
    if (components == 6) held[at + 3] = numbers[i].imag();
  }
  copy_from_host(held, field);
  return field;
}
inline Numbers random_numbers(Problem const& problem, bool complex, unsigned seed) {
  auto const sites = problem.lattice.sites();
  auto const parts = random_directions(2 * sites, seed);
  Numbers numbers(static_cast<std::size_t>(3 * sites));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = {parts[i], complex ? parts[i + numbers.size()] : 0.0};
  return numbers;
}

/// Returns the mean factor by which a correction with `solve` reduces the residual of `apply`.
/// Takes at most `corrections` corrections, and none once round-off is near.
template <class Real, class Solve, class Apply>
double left_over(Numbers rest, int corrections, Solve const& solve, Apply const& apply) {
  double const first = length(rest);
  int done = 0;
  while (done < corrections && length(rest) > 1e4 * epsilon<Real> * first) {
    rest = difference(rest, apply(solve(rest)));
    ++done;
  }
  return done == 0 ? 0 : std::pow(length(rest) / first, 1.0 / done);
}

}  // namespace cayspin::test
