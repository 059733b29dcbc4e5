// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Steps on lattices with vacancies, in methods that divide by the length of a spin, which is zero
// on vacant sites. They are compared with steps on a lattice of the occupied sites.
#include "../support/backends.hpp"
#include "../support/coefficients.hpp"
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

#include <cayspin/stepper/adaptive_runge_kutta.hpp>
#include <cayspin/stepper/adaptive_stiff_gauss.hpp>
#include <cayspin/stepper/stiff_gauss.hpp>

namespace cayspin::test {
namespace {

template <class Real>
using SpinsOf = SpinField<Real, Space::memory_space>;

/// A box, with an occupation for each site.
struct Shape {
  Lattice box;
  std::vector<double> occupied;

  template <class Real>
  auto occupation() const {
    ScalarField<Real, Space::memory_space> field("occupation", box);
    copy_from_host(std::vector<Real>(occupied.begin(), occupied.end()), field);
    return field;
  }

  /// Returns random spins that are zero on vacant sites.
  template <class Field>
  Field start(unsigned seed) const {
    auto numbers = copy_to_host(random_spins<Field>(box, seed));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (occupied[i / 3] == 0) numbers[i] = 0;
    Field spins("spins", box);
    copy_from_host(numbers, spins);
    return spins;
  }

  /// Returns a generator with vacancies, whose field has exchange, an anisotropy, a local
  /// demagnetising field and an applied field.
  template <class Real>
  auto generator(double exchange, double damping) const {
    return LandauLifshitz(
        FieldWithVacancies(
            EffectiveField(Exchange(box, exchange), UniaxialAnisotropy(0.7, {1, 2, 3}),
                           SlabDemag(Vector{0, 0, 1}, 0.6), Zeeman({0.3, -0.2, 0.5})),
            occupation<Real>()),
        damping);
  }
};

template <class Occupied>
Shape shape_of(Lattice const& box, Occupied const& occupied) {
  Shape shape{box, {}};
  auto const [nx, ny, nz] = box.shape;
  for (std::int64_t k = 0; k < nz; ++k)
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i) shape.occupied.push_back(occupied(i, j, k) ? 1 : 0);
  return shape;
}

Shape disc(std::int64_t width, std::int64_t height = 1) {
  double const middle = 0.5 * static_cast<double>(width - 1), radius = middle - 0.6;
  return shape_of({{width, width, height}}, [=](auto i, auto j, auto) {
    return std::hypot(static_cast<double>(i) - middle, static_cast<double>(j) - middle) < radius;
  });
}

template <class Field>
void expect_vacant_spins_are_zero(Field const& spins, Shape const& shape) {
  auto const numbers = copy_to_host(spins);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (shape.occupied[i / 3] == 0) {
      ASSERT_EQ(numbers[i], 0) << "site " << i / 3;
    }
  }
}

/// Compares steps of a film among the vacant sites of a box with steps of the film by itself.
template <class Stepper>
void expect_that_of_the_film_alone(char const* name, double tolerance) {
  using Field = typename Stepper::spins_type;
  using Real = typename Field::value_type;
  SCOPED_TRACE(name);
  // The film starts at the first site of the box, so that packs cut its rows as they do without a
  // box.
  Lattice const film{{13, 7, 3}}, box{{21, 11, 4}};
  auto const within = [](auto i, auto j, auto k) { return i < 13 && j < 7 && k < 3; };
  auto const shape = shape_of(box, within);
  auto const alone = shape_of(film, [](auto...) { return true; });
  auto const start = alone.template start<Field>(5);
  Field around("spins", box);
  auto const numbers = copy_to_host(start);
  std::vector<Real> in_box(static_cast<std::size_t>(3 * box.sites()));
  auto const place = [](std::int64_t site) {
    return site % 13 + 21 * (site / 13 % 7 + 11 * (site / 91));
  };
  for (std::int64_t site = 0; site < film.sites(); ++site)
    for (std::int64_t c = 0; c < 3; ++c)
      in_box[static_cast<std::size_t>(3 * place(site) + c)] =
          numbers[static_cast<std::size_t>(3 * site + c)];
  copy_from_host(in_box, around);

  constexpr int steps = 10;
  auto const end = run<Stepper>(alone.template generator<Real>(2, 0.1), start, 0.05, steps);
  auto const end_in_box = run<Stepper>(shape.template generator<Real>(2, 0.1), around, 0.05, steps);
  expect_vacant_spins_are_zero(end_in_box, shape);
  auto const one = copy_to_host(end), other = copy_to_host(end_in_box);
  double largest = 0;
  for (std::int64_t site = 0; site < film.sites(); ++site)
    for (std::int64_t c = 0; c < 3; ++c)
      largest = larger(
          largest,
          std::abs(static_cast<double>(one[static_cast<std::size_t>(3 * site + c)]) -
                   static_cast<double>(other[static_cast<std::size_t>(3 * place(site) + c)])));
  std::printf("    %-22s %.3g epsilon\n", name, largest / epsilon<Real>);
  EXPECT_LE(largest, tolerance * epsilon<Real>);
  EXPECT_GT(largest_distance(end, start), 0.01);
}

template <class Real>
struct Vacancies : ::testing::Test {
  using Field = SpinsOf<Real>;
};
TYPED_TEST_SUITE(Vacancies, Precisions, PrecisionName);

template <class Field>
using Chart4 = StereographicRungeKutta<Field, tableau::Classical4>;
/// A method in the stereographic chart that stores its increments, while Chart4 recomputes them
/// from the spins of its stages.
template <class Field>
using ChartOfThreeEighths = StereographicRungeKutta<Field, tableau::ThreeEighths4>;

TYPED_TEST(Vacancies, GiveTheBitsOfTheFilmAloneByProjectionAndInTheChart) {
  using Field = typename TestFixture::Field;
  expect_that_of_the_film_alone<ProjectedRk4<Field>>("projected_rk4", 0);
  expect_that_of_the_film_alone<ProjectedRungeKutta<Field, tableau::Oscillatory74>>("projected_74",
                                                                                    0);
  expect_that_of_the_film_alone<Compensated<ProjectedRk4<Field>>>("projected, compensated", 0);
  expect_that_of_the_film_alone<Chart4<Field>>("chart", 0);
  expect_that_of_the_film_alone<ChartOfThreeEighths<Field>>("chart, 3/8", 0);
  expect_that_of_the_film_alone<Compensated<Chart4<Field>>>("chart, compensated", 0);
}

/// A stiff stepper whose steps are solved to round-off.
template <class Stepper>
struct Solved : Stepper {
  explicit Solved(typename Stepper::spins_type const& like)
      : Stepper(like,
                StiffOptions{.tolerance = 16 * epsilon<typename Stepper::spins_type::value_type>}) {
  }
};

TYPED_TEST(Vacancies, GiveTheFilmAloneByStiffSteps) {
  using Field = typename TestFixture::Field;
  expect_that_of_the_film_alone<Solved<StiffGauss2<Field>>>("stiff2", 10 * 64);
  expect_that_of_the_film_alone<Solved<StiffGauss4<Field>>>("stiff4", 10 * 64);
}

/// An adaptive stepper with a tolerance of 1e-4.
template <class Stepper>
struct WithinTolerance : Stepper {
  using Real = typename Stepper::spins_type::value_type;
  explicit WithinTolerance(typename Stepper::spins_type const& like)
      : Stepper(like, StepOptions{.tolerance = 1e-4, .end = 10 * 0.05}) {}
};

TYPED_TEST(Vacancies, GiveTheFilmAloneByAdaptiveSteps) {
  using Field = typename TestFixture::Field;
  expect_that_of_the_film_alone<WithinTolerance<AdaptiveProjected<Field>>>("adaptive, projected",
                                                                           0);
  expect_that_of_the_film_alone<WithinTolerance<AdaptiveStereographic<Field>>>("adaptive, chart",
                                                                               0);
}

TEST(VacanciesOfAdaptiveStiffSteps, AreWithinTheToleranceOfTheFilmAlone) {
  double const tolerance = 1e-4 / epsilon<double>;
  expect_that_of_the_film_alone<WithinTolerance<AdaptiveStiffGauss2<Spins>>>("stiff_adaptive",
                                                                             tolerance);
}

/// Returns the average number of corrections per step.
template <class Stepper, class Generator>
double corrections(Generator const& generator, Spins const& start, double dt) {
  Spins spins = copy_of(start);
  Stepper stepper(spins);
  advance(stepper, generator, spins, dt, 4);
  auto const before = stepper.evaluations_done();
  advance(stepper, generator, spins, dt, 20, 4);
  EXPECT_EQ(stepper.halvings_done(), 0);
  return static_cast<double>(stepper.evaluations_done() - before) / 20;
}

TEST(VacanciesOfStiffSteps, TakeUpToThreeTimesTheCorrectionsOfAFullLattice) {
  auto const full = shape_of({{24, 24, 2}}, [](auto...) { return true; });
  for (auto const& shape :
       {disc(24, 2), shape_of({{24, 24, 8}}, [](auto, auto, auto k) { return k < 3; })}) {
    for (double const dt : {0.2, 1.0}) {
      auto const smooth = [](Shape const& of) {
        auto numbers = copy_to_host(make_spins(of.box, [](auto i, auto j, auto) {
          return Vector{std::cos(0.1 * i), std::sin(0.1 * j), 0.8};
        }));
        for (std::size_t i = 0; i < numbers.size(); ++i)
          if (of.occupied[i / 3] == 0) numbers[i] = 0;
        Spins spins("spins", of.box);
        copy_from_host(numbers, spins);
        return spins;
      };
      auto const of = [&](Shape const& one) {
        return corrections<StiffGauss2<Spins>>(one.generator<double>(10, 0.1), smooth(one), dt);
      };
      double const with = of(shape), without = of(full);
      std::printf("    dt %g: %.2f corrections a step, without vacancies %.2f\n", dt, with,
                  without);
      EXPECT_LT(with, 3 * without);
    }
  }
}

}  // namespace
}  // namespace cayspin::test
