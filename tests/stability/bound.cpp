// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The a-priori bound: the largest eigenvalue of the exchange, and the step limits of methods.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

#include <Eigen/Dense>

#include <limits>

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns the largest eigenvalue of the matrix of the Exchange term, which is built column by
/// column.
double largest_eigenvalue(Lattice const& lattice, double constant) {
  std::int64_t const n = lattice.sites();
  Eigen::MatrixXd matrix(n, n);
  Spins spins("spins", lattice), fields("fields", lattice);
  Space const exec;
  for (std::int64_t column = 0; column < n; ++column) {
    std::vector<double> numbers(3 * n, 0.0);
    numbers[3 * column] = 1;
    copy_from_host(numbers, spins);
    evaluate_field(exec, Exchange{lattice, constant}, spins, 0, fields);
    exec.fence();
    auto const column_numbers = copy_to_host(fields);
    for (std::int64_t row = 0; row < n; ++row) matrix(row, column) = -column_numbers[3 * row];
  }
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm() + 1e-300);
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

TEST(ExchangeBound, IsTheLargestEigenvalue) {
  std::array<std::int64_t, 3> const shapes[] = {{1, 1, 1}, {2, 1, 1}, {3, 1, 1}, {8, 1, 1},
                                                {9, 1, 1}, {1, 5, 1}, {4, 3, 1}, {5, 7, 1},
                                                {3, 4, 5}, {2, 3, 4}, {5, 5, 3}};
  Boundary const open = Boundary::open, periodic = Boundary::periodic;
  std::array<Boundary, 3> const boundaries[] = {{open, open, open},
                                                {periodic, periodic, periodic},
                                                {periodic, open, periodic},
                                                {open, periodic, open}};
  for (auto const& shape : shapes)
    for (auto const& boundary : boundaries) {
      Lattice const lattice{shape, {0.5, 0.7, 1.1}, boundary};
      double const bound = exchange_bound(lattice, 1.3);
      EXPECT_NEAR(bound, largest_eigenvalue(lattice, 1.3), 1e-12 * bound)
          << shape[0] << ' ' << shape[1] << ' ' << shape[2] << " periodic "
          << (boundary[0] == periodic) << (boundary[1] == periodic) << (boundary[2] == periodic);
      EXPECT_EQ(exchange_bound(lattice, -1.3), bound);
    }
}

/// Returns y of largest_stable_step = y / field_bound, computed with a field bound of 7.
template <class Stepper>
double scaled_limit(double damping, bool precession = true) {
  return 7 * largest_stable_step<Stepper>(7, damping, {.precession = precession});
}

// The values of y in the table solve |R(y * (-damping + i))| = 1, where R is the stability
// polynomial of order 1, 2 or 4. They were computed with 30 digits.
struct Row {
  double damping;
  char const *euler, *heun, *rk4;
};
Row const table[] = {{.001, "0.001999998", "0.2013287", "2.8305393"},
                     {.01, "0.019998", "0.44397331", "2.8484267"},
                     {.02, "0.039984006", "0.56868657", "2.8660486"},
                     {.05, "0.099750623", "0.79862022", "2.9060952"},
                     {.1, "0.1980198", "1.0424614", "2.9359703"},
                     {.2, "0.38461538", "1.3557833", "2.8853702"},
                     {.5, "0.8000000", "1.7207289", "2.3730210"},
                     {1, "1.0000000", "1.5436890", "1.9122667"},
                     {2, "0.8000000", "0.96105118", "1.2750775"},
                     {5, "0.38461538", "0.39940909", "0.55220962"},
                     {10, "0.1980198", "0.1999804", "0.27802753"}};

TEST(StepLimit, Table) {
  for (Row const& row : table) {
    auto const expect = [&](char const* method, double limit, char const* reference) {
      expect_figure(std::string(method) + ", damping " + std::to_string(row.damping).substr(0, 6),
                    limit, reference, 0);
    };
    expect("Euler", scaled_limit<ClassicalEuler<Spins>>(row.damping), row.euler);
    expect("geometric Euler", scaled_limit<LieEuler<Spins>>(row.damping), row.euler);
    expect("classical Heun", scaled_limit<ClassicalHeun<Spins>>(row.damping), row.heun);
    expect("geometric Heun", scaled_limit<LieHeun<Spins>>(row.damping), row.heun);
    expect("classical rk4", scaled_limit<ClassicalRk4<Spins>>(row.damping), row.rk4);
    expect("rkmk4", scaled_limit<Rkmk4<Spins>>(row.damping), row.rk4);

    double const l = row.damping, l2 = 1 + l * l, y = scaled_limit<ClassicalHeun<Spins>>(l);
    EXPECT_NEAR(scaled_limit<LieEuler<Spins>>(l), 2 * l / l2, 1e-12);
    EXPECT_NEAR(-2 * l + 2 * l * l * y - l * l2 * y * y + l2 * l2 * y * y * y / 4, 0,
                1e-11 * l2 * l2);
  }
}

TEST(StepLimit, GeometryAndRenormalisingDoNotMatter) {
  for (Row const& row : table) {
    double const rk4 = scaled_limit<ClassicalRk4<Spins>>(row.damping);
    using Exponential4 = Rkmk4<Spins, isotropy::Zero, Exponential>;
    EXPECT_NEAR(scaled_limit<Rkmk4<Spins>>(row.damping), rk4, 1e-9);
    EXPECT_NEAR(scaled_limit<Exponential4>(row.damping), rk4, 1e-9);
    EXPECT_NEAR(scaled_limit<ProjectedRk4<Spins>>(row.damping), rk4, 1e-9);
    using Stereographic4 = StereographicRungeKutta<Spins, tableau::Classical4>;
    EXPECT_NEAR(scaled_limit<Stereographic4>(row.damping), rk4, 1e-9);
  }
}

TEST(StepLimit, Overdamped) {
  for (double const damping : {0.05, 1.0, 10.0}) {
    EXPECT_NEAR(damping * scaled_limit<LieEuler<Spins>>(damping, false), 2, 1e-9);
    EXPECT_NEAR(damping * scaled_limit<ClassicalHeun<Spins>>(damping, false), 2, 1e-9);
    expect_figure("rkmk4, overdamped", damping * scaled_limit<Rkmk4<Spins>>(damping, false),
                  "2.7853", 0);
  }
}

TEST(StepLimit, ConstantSigma) {
  using Stepper = LieEuler<Spins, isotropy::Constant>;
  double const s = 7;
  for (double const damping : {0.05, 1.0})
    for (double const sigma : {-20.0, -3.0, -0.5, 0.5, 3.0, 6.9}) {
      double const limit = 2 * damping / ((1 + damping * damping) * s - sigma);
      EXPECT_NEAR(largest_stable_step<Stepper>(s, damping, {.sigma = sigma}), limit, 1e-6 * limit)
          << damping << ' ' << sigma;
    }
}

constexpr int modes = 400;

/// A term that does not couple spins: fields along z, different at each site, up to `largest`.
struct FieldOfModes {
  double largest;
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const number = detail::lane_numbers<Value>() + Value(1.0 + stencil.site().x());
    return Vec3<Value>{Value(0.0), Value(0.0), Value(largest / modes) * number};
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(Value(0.0) - dot(stencil.center(), field(stencil)));
  }
};

/// Returns the largest factor by which a step changes the amplitude of a mode. Each spin is a mode:
/// a small tilt off its field.
template <class Stepper>
double amplification(double largest, double damping, double sigma, double dt) {
  auto const generator = orthogonal(LandauLifshitz{EffectiveField{FieldOfModes{largest}}, damping});
  auto const start = make_spins(Lattice::chain(modes), [](auto, auto, auto) {
    return Vector{1e-6, 0, 1};
  });
  auto const numbers =
      copy_to_host(run<Stepper>(generator, start, dt, 1, isotropy::Constant{sigma}));
  double amplitude = 0;
  for (int mode = 0; mode < modes; ++mode)
    amplitude = larger(amplitude, std::hypot(numbers[3 * mode], numbers[3 * mode + 1]));
  return amplitude / 1e-6;
}

template <class Stepper>
void expect_first_growth_at_the_limit(std::string const& method) {
  double const s = 7;
  for (double const damping : {0.05, 1.0})
    for (double const sigma : {-20.0, -3.0, 5.0, 20.0}) {
      double const limit = largest_stable_step<Stepper>(s, damping, {.sigma = sigma});
      if (limit == infinity) {
        std::printf("    %s damping %g sigma %g: no limit\n", method.c_str(), damping, sigma);
        for (double dt = 1e-3; dt < 100; dt *= 1.05)
          EXPECT_LT(amplification<Stepper>(s, damping, sigma, dt), 1 + 1e-8) << dt;
        continue;
      }
      double const below = amplification<Stepper>(s, damping, sigma, 0.999 * limit);
      double const above = amplification<Stepper>(s, damping, sigma, 1.001 * limit);
      std::printf("    %s damping %g sigma %g: limit %.5g, |R| %.8f below, %.8f above\n",
                  method.c_str(), damping, sigma, limit, below, above);
      EXPECT_LT(below, 1);
      EXPECT_GT(above, 1);
    }
}

TEST(StepLimit, ConstantSigmaOfHigherOrders) {
  using isotropy::Constant;
  expect_first_growth_at_the_limit<LieHeun<Spins, Constant>>("Heun");
  expect_first_growth_at_the_limit<Rkmk4<Spins, Constant>>("rkmk4");
  expect_first_growth_at_the_limit<Rkmk4<Spins, Constant, Exponential>>("rkmk4, exponential");
}

TEST(StepLimit, NoneAndZero) {
  // With a sigma above (1 + damping^2) times the field bound, spins are turned about themselves
  // faster than they move, and any step is stable.
  using Stepper = LieEuler<Spins, isotropy::Constant>;
  EXPECT_EQ(largest_stable_step<Stepper>(7, 0.05, {.sigma = 7.1}), infinity);
  EXPECT_EQ(largest_stable_step<LieEuler<Spins>>(0, 0.05), infinity);
  EXPECT_EQ(largest_stable_step<LieEuler<Spins>>(7, 0, {.precession = false}), infinity);
  // Euler and Heun amplify undamped precession at any dt.
  EXPECT_EQ(largest_stable_step<LieEuler<Spins>>(7, 0), 0);
  EXPECT_EQ(largest_stable_step<ClassicalHeun<Spins>>(7, 0), 0);
  EXPECT_NEAR(7 * largest_stable_step<Rkmk4<Spins>>(7, 0), std::sqrt(8), 1e-9);
}

TEST(StepLimit, BoundsThatAreNone) {
  double const nan = std::nan("");
  auto const refuses = [](double bound, double damping) {
    std::string const sentence =
        "cayspin::largest_stable_step: the field bound and the damping must be >= 0 and finite";
    for (bool const precession : {true, false}) {
      try {
        largest_stable_step<Rkmk4<Spins>>(bound, damping, {.precession = precession});
        ADD_FAILURE() << bound << ", " << damping;
      } catch (std::invalid_argument const& error) {
        EXPECT_EQ(error.what(), sentence);
      }
    }
  };
  for (double const wrong : {nan, -1.0, -1e-300, infinity, -infinity}) {
    refuses(wrong, 0.05);
    refuses(1, wrong);
  }
  refuses(1e200, 1e200);  // the rate overflows
  EXPECT_THROW((largest_stable_step<Rkmk4<Spins, isotropy::Constant>>(1, 0.1, {.sigma = nan})),
               std::invalid_argument);
  EXPECT_GT(largest_stable_step<Rkmk4<Spins>>(1e300, 0.05), 0);
  EXPECT_EQ(largest_stable_step<Rkmk4<Spins>>(-0.0, 0.05), infinity);
  for (double const wrong : {nan, infinity})
    EXPECT_THROW(exchange_bound(Lattice::chain(4), wrong), std::invalid_argument);
}

}  // namespace
