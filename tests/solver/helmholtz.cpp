// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Approximations to (c + b * K)^-1, where K is minus the Laplacian with couplings, compared with K
// applied site by site in double.
#include "problems.hpp"

#include <cayspin/solver/helmholtz.hpp>
#include <cayspin/solver/spin_wave_solver.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace cayspin::test {
namespace {

template <class Backend>
class Helmholtz : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Exec = typename Backend::Exec;
  using MemorySpace = typename Backend::MemorySpace;
  using Field = SiteField<Real, 3, MemorySpace>;
  using Solver = detail::Helmholtz<Real, MemorySpace>;
  using SpinWaves = detail::SpinWaveSolver<Real, MemorySpace>;
  using Lines = detail::LineSolver<Kokkos::complex<Real>, MemorySpace>;

  template <class Space = Exec>
  static Numbers solved(Solver& solver, Problem const& problem, double c, double b,
                        Numbers const& right, Space const& exec = {}) {
    Field z("z", problem.lattice);
    solver.solve(exec, c, b, field_of<Field>(problem.lattice, right), z);
    exec.fence();
    return numbers_from(z);
  }
  static double left_of(Problem const& problem, double b, int corrections) {
    Solver solver("Helmholtz", problem.lattice, problem.couplings);
    return left_over<Real>(
        random_numbers(problem, false, 1), corrections,
        [&](Numbers const& rest) { return solved(solver, problem, 1, b, rest); },
        [&](Numbers const& step) { return applied(problem, 1, b, step); });
  }

  template <class Space = Exec>
  static Numbers solved_about(SpinWaves& solver, Problem const& problem, Numbers const& spins,
                              Number b, Numbers const& right, Space const& exec = {},
                              detail::SpinWaveOptions const& options = {}) {
    typename SpinWaves::Solution z("z", problem.lattice);
    solver.solve(exec, b, field_of<Field>(problem.lattice, right),
                 field_of<Field>(problem.lattice, spins), z, options);
    exec.fence();
    auto v = numbers_from(z);
    for (std::size_t i = 0; i < v.size(); i += 3) {
      auto const turned =
          cross(vector_at(spins, i), Vector{v[i].imag(), v[i + 1].imag(), v[i + 2].imag()});
      put(v, i, vector_at(v, i) + turned);
    }
    return v;
  }

  using Vector = Vec3<double>;
  static Vector vector_at(Numbers const& numbers, std::size_t i) {
    return {numbers[i].real(), numbers[i + 1].real(), numbers[i + 2].real()};
  }
  static void put(Numbers& numbers, std::size_t i, Vector const& v) {
    numbers[i] = v.x, numbers[i + 1] = v.y, numbers[i + 2] = v.z;
  }

  /// Returns spins that turn by a tenth of a radian over the length of each axis.
  static Numbers turning_spins(Lattice const& lattice) {
    Numbers spins(static_cast<std::size_t>(3 * lattice.sites()));
    for (std::int64_t site = 0; site < lattice.sites(); ++site) {
      double angle = 0;
      std::int64_t rest = site;
      for (std::int64_t const extent : lattice.shape) {
        angle += 0.1 * static_cast<double>(rest % extent) / static_cast<double>(extent);
        rest /= extent;
      }
      put(spins, static_cast<std::size_t>(3 * site),
          {0.8 * std::cos(angle), 0.8 * std::sin(angle), 0.6});
    }
    return spins;
  }

  static Numbers across(Numbers const& spins, Numbers vectors) {
    for (std::size_t i = 0; i < vectors.size(); i += 3) {
      Vector const m = vector_at(spins, i), v = vector_at(vectors, i);
      put(vectors, i, v - dot(m, v) * m);
    }
    return vectors;
  }

  /// Applies 1 + b * K in the planes normal to the spins m, where the imaginary unit of b stands
  /// for the cross product m x v. K acts on d = v x m, and a cross product with m turns the result
  /// back.
  static Numbers applied_about(Problem const& problem, Numbers const& spins, Number b,
                               Numbers const& v) {
    Numbers d(v.size());
    for (std::size_t i = 0; i < v.size(); i += 3)
      put(d, i, cross(vector_at(v, i), vector_at(spins, i)));
    auto const kd = applied(problem, 0, 1, d);
    for (std::size_t i = 0; i < v.size(); i += 3) {
      Vector const m = vector_at(spins, i), turned = cross(m, vector_at(kd, i));
      put(d, i, cross(m, vector_at(d, i) - b.real() * cross(m, turned) + b.imag() * turned));
    }
    return d;
  }

  static double left_about(Problem const& problem, Numbers const& spins, Number b,
                           int corrections) {
    SpinWaves solver("SpinWaves", problem.lattice, problem.couplings);
    return left_over<Real>(
        across(spins, random_numbers(problem, false, 1)), corrections,
        [&](Numbers const& rest) { return solved_about(solver, problem, spins, b, rest); },
        [&](Numbers const& step) { return applied_about(problem, spins, b, step); });
  }
};

TYPED_TEST_SUITE(Helmholtz, Backends, BackendName);

TYPED_TEST(Helmholtz, CyclesConvergeOnGridsOfAnySize) {
  for (Problem const& problem : grids()) {
    SCOPED_TRACE(problem.name);
    EXPECT_LT(TestFixture::left_of(problem, 1, 6), 0.5);
  }
}

TYPED_TEST(Helmholtz, AlternatingSigns) {
  for (Problem const& problem : alternating()) {
    SCOPED_TRACE(problem.name);
    auto couplings = problem.couplings;
    bool const is_exact = detail::only_coupled_axis(problem.lattice, couplings).has_value();
    EXPECT_LT(TestFixture::left_of(problem, 1, is_exact ? 1 : 6),
              is_exact ? 1e5 * epsilon<typename TypeParam::Real> : 0.5);
  }
}

TYPED_TEST(Helmholtz, CyclesConvergeOnSpinWaves) {
  for (Problem const& problem : grids()) {
    SCOPED_TRACE(problem.name);
    auto const spins = TestFixture::turning_spins(problem.lattice);
    for (Number const b : {Number(0.05, -1), Number(0, 0.01), Number(1, 0)})
      EXPECT_LT(TestFixture::left_about(problem, spins, b, 6), 0.3) << b;
  }
}

TYPED_TEST(Helmholtz, DirectionsOfTheCallBeforeMayStayInUse) {
  for (Problem const& problem : grids()) {
    SCOPED_TRACE(problem.name);
    typename TestFixture::SpinWaves solver("SpinWaves", problem.lattice, problem.couplings);
    auto const spins = TestFixture::turning_spins(problem.lattice);
    auto const right = TestFixture::across(spins, random_numbers(problem, false, 2));
    auto const solve = [&](Numbers const& about, bool same_directions) {
      return TestFixture::solved_about(solver, problem, about, {0.1, -0.7}, right, {},
                                       {.same_directions = same_directions});
    };
    auto const before = solve(spins, false);
    EXPECT_EQ(solve(spins, true), before);
    auto others = spins;
    for (std::size_t i = 0; i < others.size(); i += 3) TestFixture::put(others, i, {0.6, 0, 0.8});
    solve(others, false);
    EXPECT_NE(solve(spins, true), before);
  }
}

TYPED_TEST(Helmholtz, SpinWavesOfParallelSpinsAreSolvedByLines) {
  for (Problem const& problem : lines()) {
    SCOPED_TRACE(problem.name);
    Numbers spins(static_cast<std::size_t>(3 * problem.lattice.sites()));
    for (std::size_t i = 0; i < spins.size(); i += 3) TestFixture::put(spins, i, {0.6, 0, -0.8});
    EXPECT_LT(TestFixture::left_about(problem, spins, {0.05, -1}, 1),
              1e5 * epsilon<typename TypeParam::Real>);
  }
}

TYPED_TEST(Helmholtz, LinesAreSolvedToRoundOff) {
  using Real = typename TypeParam::Real;
  using Field = SiteField<Real, 6, typename TypeParam::MemorySpace>;
  typename TypeParam::Exec const exec;
  for (Problem const& problem : lines()) {
    SCOPED_TRACE(problem.name);
    // The norms of c + b * K and of its inverse are at most about 8e4 and 1.
    double const tolerance = 1e5 * epsilon<Real>;
    EXPECT_LT(TestFixture::left_of(problem, 1, 1), tolerance);
    Kokkos::complex<Real> const b(Real(0.05), -1);
    auto couplings = problem.couplings;
    int const axis = *detail::only_coupled_axis(problem.lattice, couplings);
    typename TestFixture::Lines solver("lines", RowLayout::of<Real>(problem.lattice), axis,
                                       couplings[static_cast<std::size_t>(axis)]);
    auto const solve = [&](Numbers const& rest) {
      Field z("z", problem.lattice);
      solver.solve(exec, 1, b, field_of<Field>(problem.lattice, rest), z);
      exec.fence();
      return numbers_from(z);
    };
    EXPECT_LT(left_over<Real>(random_numbers(problem, true, 1), 1, solve,
                              [&](Numbers const& step) {
                                return applied(problem, 1, {b.real(), b.imag()}, step);
                              }),
              tolerance);
  }
}

// On devices, and on hosts without packs, lines along x are solved number by number.
TYPED_TEST(Helmholtz, LinesOfSingleNumbersFindTheRowsOfPaddedPlanes) {
  using Real = typename TypeParam::Real;
  using Field = SiteField<Real, 3, Kokkos::HostSpace>;
  using Lines = detail::SolveLines<Real, 3>;
  Problem const problem{"", Lattice::cubic(14, 16, 4), {0, 0, 0}};
  auto const layout = RowLayout::of<Real>(problem.lattice);
  std::vector<Real> const inverse(7, Real(0.5)), ratio(7, Real(0));
  detail::LineFactors<Real> factors;
  factors.inverse = inverse.data();
  factors.ratio = ratio.data();
  factors.other = 1;
  auto const right = random_numbers(problem, false, 1);
  Field const r = field_of<Field>(problem.lattice, right), z("z", problem.lattice);
  Lines const lines{factors, layout, 0, r.array(), z.array(), Real(1)};
  for (std::int64_t task = 0; task < lines.tasks(1); ++task)
    detail::SolveLinesOnDevice<Lines>{lines}(task);
  auto const solved = numbers_from(z);
  for (std::size_t i = 0; i < right.size(); ++i)
    ASSERT_EQ(solved[i].real(), 0.5 * static_cast<double>(static_cast<Real>(right[i].real()))) << i;
}

TYPED_TEST(Helmholtz, RealFormIsSymmetricAndPositive) {
  using Real = typename TypeParam::Real;
  auto problems = grids();
  for (auto const& more : {lines(), alternating()})
    problems.insert(problems.end(), more.begin(), more.end());
  for (Problem const& problem : problems) {
    SCOPED_TRACE(problem.name);
    typename TestFixture::Solver solver("Helmholtz", problem.lattice, problem.couplings);
    auto const x = random_numbers(problem, false, 2), y = random_numbers(problem, false, 3),
               bx = TestFixture::solved(solver, problem, 0.3, Real(1), x),
               by = TestFixture::solved(solver, problem, 0.3, Real(1), y);
    double left = 0, right = 0, square = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      left += x[i].real() * by[i].real();
      right += bx[i].real() * y[i].real();
      square += x[i].real() * bx[i].real();
    }
    EXPECT_NEAR(left, right, 1000 * epsilon<float> * length(bx) * length(y));
    EXPECT_GT(square, 0.01 * length(bx) * length(bx));
  }
}

TYPED_TEST(Helmholtz, CyclesForgetWhatIsNotFinite) {
  using Real = typename TypeParam::Real;
  for (Problem const& problem : grids()) {
    SCOPED_TRACE(problem.name);
    typename TestFixture::SpinWaves solver("SpinWaves", problem.lattice, problem.couplings);
    auto const spins = TestFixture::turning_spins(problem.lattice);
    auto const right = TestFixture::across(spins, random_numbers(problem, false, 2));
    auto const solve = [&](Numbers const& r) {
      return TestFixture::solved_about(solver, problem, spins, {0.1, -0.7}, r);
    };
    auto const before = solve(right);
    auto broken = right;
    for (Number& number : broken) number = std::numeric_limits<Real>::quiet_NaN();
    solve(broken);
    EXPECT_EQ(solve(right), before);
  }
}

#if defined(KOKKOS_ENABLE_SERIAL)
TYPED_TEST(Helmholtz, BitsAreThoseOfSerial) {
  if constexpr (!detail::is_host_execution<typename TypeParam::Exec>) {
    GTEST_SKIP() << "devices round otherwise";
  } else {
    auto problems = grids();
    for (Problem const& problem : lines()) problems.push_back(problem);
    problems.push_back({"many rows", Lattice::square(131, 140), {80, 80, 0}});
    for (Problem const& problem : problems) {
      SCOPED_TRACE(problem.name);
      auto const right = random_numbers(problem, false, 5);
      typename TestFixture::Solver solver("Helmholtz", problem.lattice, problem.couplings);
      EXPECT_EQ(TestFixture::solved(solver, problem, 1, 2, right),
                TestFixture::solved(solver, problem, 1, 2, right, Kokkos::Serial()));
      typename TestFixture::SpinWaves waves("SpinWaves", problem.lattice, problem.couplings);
      auto const spins = TestFixture::turning_spins(problem.lattice);
      Number const b(0.1, -0.7);
      EXPECT_EQ(TestFixture::solved_about(waves, problem, spins, b, right),
                TestFixture::solved_about(waves, problem, spins, b, right, Kokkos::Serial()));
    }
  }
}
#endif

}  // namespace
}  // namespace cayspin::test
