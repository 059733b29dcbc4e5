// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Approximations to (c + b K)^-1, beside K applied site by site in double.
#include "../support/backends.hpp"

#include <cayspin/solver/helmholtz.hpp>

#include <algorithm>
#include <complex>

namespace cayspin::test {
namespace {

using Number = std::complex<double>;
using Numbers = std::vector<Number>;  // (sites, 3)

struct Problem {
  std::string name;
  Lattice lattice;
  std::array<double, 3> couplings;
};

Lattice closed(Lattice lattice) {
  lattice.boundary.fill(Boundary::periodic);
  return lattice;
}

/// Lattices of any size, with open and periodic axes, where two or three axes couple.
std::vector<Problem> grids() {
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

/// Lattices where one axis couples.
std::vector<Problem> lines() {
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
      add("y ", Lattice::cubic(37, n, 3), {0, 30, 0});
      add("z ", Lattice::cubic(5, 2, n), {0, 0, 2e4});
    }
  problems.push_back({"one site", Lattice::chain(1), {700, 0, 0}});
  problems.push_back({"no coupling", Lattice::square(5, 4), {0, -3, 0}});
  return problems;
}

Number as_number(float b) { return b; }
Number as_number(double b) { return b; }
template <class Real>
Number as_number(Kokkos::complex<Real> b) {
  return {b.real(), b.imag()};
}

/// (c + b K) u
Numbers applied(Problem const& problem, double c, Number b, Numbers const& u) {
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
          if (shape[axis] == 1 || !(problem.couplings[axis] > 0) ||
              (outside && problem.lattice.boundary[axis] == Boundary::open))
            continue;
          other[axis] = (other[axis] + shape[axis]) % shape[axis];
          std::int64_t const there = (other[2] * shape[1] + other[1]) * shape[0] + other[0];
          sum += problem.couplings[axis] *
                 (u[here] - u[static_cast<std::size_t>(3 * there + component)]);
        }
      result[here] = c * u[here] + b * sum;
    }
  }
  return result;
}

double length(Numbers const& u) {
  double square = 0;
  for (Number const& value : u) square += std::norm(value);
  return std::sqrt(square);
}

Numbers difference(Numbers u, Numbers const& v) {
  for (std::size_t i = 0; i < u.size(); ++i) u[i] -= v[i];
  return u;
}

template <class Backend>
class Helmholtz : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Exec = typename Backend::Exec;
  using MemorySpace = typename Backend::MemorySpace;

  template <class Scalar>
  using Solver = detail::Helmholtz<Scalar, MemorySpace>;

  template <int Components>
  static Numbers numbers_from(SiteField<Real, Components, MemorySpace> const& field) {
    auto const held = copy_to_host(field);
    Numbers numbers(held.size() * 3 / Components);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      std::size_t const at = i / 3 * Components + i % 3;
      numbers[i] = {held[at], Components == 6 ? held[at + 3] : Real(0)};
    }
    return numbers;
  }
  template <int Components>
  static auto field_of(Lattice const& lattice, Numbers const& numbers) {
    SiteField<Real, Components, MemorySpace> field("numbers", lattice);
    std::vector<double> held(numbers.size() * Components / 3);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      std::size_t const at = i / 3 * Components + i % 3;
      held[at] = numbers[i].real();
      if (Components == 6) held[at + 3] = numbers[i].imag();
    }
    copy_from_host(held, field);
    return field;
  }
  static Numbers random_numbers(Problem const& problem, bool complex, unsigned seed) {
    auto const sites = problem.lattice.sites();
    auto const parts = random_directions(2 * sites, seed);
    Numbers numbers(static_cast<std::size_t>(3 * sites));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      numbers[i] = {parts[i], complex ? parts[i + numbers.size()] : 0.0};
    return numbers;
  }

  template <class Scalar, int RightHandComponents = Solver<Scalar>::components, class Space = Exec>
  static Numbers solved(Solver<Scalar>& solver, Problem const& problem, double c, Scalar b,
                        Numbers const& right, Space const& exec = {}) {
    typename Solver<Scalar>::Field z("z", problem.lattice);
    solver.solve(exec, c, b, field_of<RightHandComponents>(problem.lattice, right), z);
    exec.fence();
    return numbers_from(z);
  }

  /// What solve leaves of the residual, at worst in so many corrections.
  template <class Scalar>
  static double left_over(Problem const& problem, Scalar b, int corrections) {
    constexpr bool is_complex = Solver<Scalar>::components == 6;
    Solver<Scalar> solver("Helmholtz", problem.lattice, problem.couplings);
    auto rest = random_numbers(problem, is_complex, 1);
    double worst = 0;
    for (int i = 0; i < corrections; ++i) {
      auto const step = solved<Scalar>(solver, problem, 1, b, rest);
      auto const before = length(rest);
      rest = difference(rest, applied(problem, 1, as_number(b), step));
      worst = std::max(worst, length(rest) / before);
    }
    return worst;
  }
};

TYPED_TEST_SUITE(Helmholtz, Backends, BackendName);

TYPED_TEST(Helmholtz, CyclesConvergeOnGridsOfAnySize) {
  using Real = typename TypeParam::Real;
  for (Problem const& problem : grids()) {
    SCOPED_TRACE(problem.name);
    EXPECT_LT(TestFixture::left_over(problem, Real(1), 6), 0.5);
    EXPECT_LT(TestFixture::left_over(problem, Kokkos::complex<Real>(Real(0.05), -1), 6), 0.6);
    EXPECT_LT(TestFixture::left_over(problem, Kokkos::complex<Real>(0, Real(0.01)), 6), 0.5);
  }
}

TYPED_TEST(Helmholtz, LinesAreSolvedToRoundOff) {
  using Real = typename TypeParam::Real;
  for (Problem const& problem : lines()) {
    SCOPED_TRACE(problem.name);
    // The entries of c + b K and of its inverse are at most 8e4 and 1.
    double const tolerance = 1e5 * epsilon<Real>;
    EXPECT_LT(TestFixture::left_over(problem, Real(1), 1), tolerance);
    EXPECT_LT(TestFixture::left_over(problem, Kokkos::complex<Real>(Real(0.05), -1), 1), tolerance);
  }
}

TYPED_TEST(Helmholtz, RealFormIsSymmetricAndPositive) {
  using Real = typename TypeParam::Real;
  auto problems = grids();
  for (Problem const& problem : lines()) problems.push_back(problem);
  for (Problem const& problem : problems) {
    SCOPED_TRACE(problem.name);
    typename TestFixture::template Solver<Real> solver("Helmholtz", problem.lattice,
                                                       problem.couplings);
    auto const x = TestFixture::random_numbers(problem, false, 2),
               y = TestFixture::random_numbers(problem, false, 3),
               bx = TestFixture::solved(solver, problem, 0.3, Real(1), x),
               by = TestFixture::solved(solver, problem, 0.3, Real(1), y);
    double left = 0, right = 0, square = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      left += x[i].real() * by[i].real();
      right += bx[i].real() * y[i].real();
      square += x[i].real() * bx[i].real();
    }
    EXPECT_NEAR(left, right, 200 * epsilon<Real> * length(bx) * length(y));
    EXPECT_GT(square, 0.01 * length(bx) * length(bx));
  }
}

TYPED_TEST(Helmholtz, TakesRealRightHandSides) {
  using Real = typename TypeParam::Real;
  using Complex = Kokkos::complex<Real>;
  auto problems = grids();
  for (Problem const& problem : lines()) problems.push_back(problem);
  Complex const b(Real(0.1), Real(-0.7));
  for (Problem const& problem : problems) {
    SCOPED_TRACE(problem.name);
    typename TestFixture::template Solver<Complex> solver("Helmholtz", problem.lattice,
                                                          problem.couplings);
    auto const right = TestFixture::random_numbers(problem, false, 4);
    auto const three = TestFixture::template solved<Complex, 3>(solver, problem, 1, b, right);
    auto const six = TestFixture::template solved<Complex, 6>(solver, problem, 1, b, right);
    EXPECT_EQ(length(difference(three, six)), 0);
  }
}

#if defined(KOKKOS_ENABLE_SERIAL)
TYPED_TEST(Helmholtz, BitsAreThoseOfSerial) {
  using Real = typename TypeParam::Real;
  if constexpr (!detail::is_host_execution<typename TypeParam::Exec>) {
    GTEST_SKIP() << "devices round otherwise";
  } else {
    auto problems = grids();
    for (Problem const& problem : lines()) problems.push_back(problem);
    problems.push_back({"many rows", Lattice::square(65, 70), {80, 80, 0}});
    for (Problem const& problem : problems) {
      SCOPED_TRACE(problem.name);
      typename TestFixture::template Solver<Real> solver("Helmholtz", problem.lattice,
                                                         problem.couplings);
      auto const right = TestFixture::random_numbers(problem, false, 5);
      EXPECT_EQ(
          TestFixture::solved(solver, problem, 1, Real(2), right),
          TestFixture::template solved<Real>(solver, problem, 1, Real(2), right, Kokkos::Serial()));
    }
  }
}
#endif

}  // namespace
}  // namespace cayspin::test
