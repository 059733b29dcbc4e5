// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Stiff steps with fields and generators other than uniform exchange, compared with explicit steps.
#include "../support/coefficients.hpp"
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/mean_field.hpp"

#include <cayspin/stepper/stiff_gauss.hpp>

namespace cayspin::test {
namespace {

Lattice film() {
  auto lattice = Lattice::square(14, 9);
  lattice.boundary[1] = Boundary::periodic;
  return lattice;
}

Spins wavy(Lattice const& lattice) {
  return make_spins(lattice, [](auto i, auto j, auto) {
    return Vector{0.5 + 0.3 * std::cos(0.2 * i), 0.3 * std::sin(0.7 * j), 0.8};
  });
}

auto numbers(double every_fifth, double others) {
  return numbers_on<Spins>(film(), [&](auto site) { return site % 5 == 0 ? every_fifth : others; });
}

/// Expects small errors with steps four times as long as those of an explicit reference run.
/// Expects halving the steps to divide the errors by about 4 (StiffGauss2) and 16 (StiffGauss4).
template <class Generator>
void expect_converges(Generator const& generator, double rate = 200) {
  auto const start = wavy(film());
  double const end = 0.5;
  int const steps = static_cast<int>(end * rate / 11);
  auto const exact = run<Rkmk4<Spins>>(generator, start, end / (16 * steps), 16 * steps);
  auto const errors = [&]<class Stepper>(Stepper const&) {
    auto const error = [&](int n) {
      return largest_distance(run<Stepper>(generator, start, end / n, n), exact);
    };
    return std::pair(error(4 * steps), error(8 * steps));
  };
  auto const [two, two_halved] = errors(StiffGauss2<Spins>(start));
  auto const [four, four_halved] = errors(StiffGauss4<Spins>(start));
  std::printf("    errors %.2e, %.2e, order 4 %.2e, %.2e\n", two, two_halved, four, four_halved);
  EXPECT_LT(two, 2e-2);
  EXPECT_NEAR(two / two_halved, 4, 1);
  EXPECT_LT(four, 0.2 * two);
  EXPECT_NEAR(std::log2(four / four_halved), 4, 0.75);
}

TEST(StiffFields, Vacancies) {
  FieldWithVacancies field(EffectiveField(Exchange(film(), 25), UniaxialAnisotropy(1, {0, 0, 1})),
                           numbers(0, 1));
  expect_converges(LandauLifshitz(field, 0.1));
}

TEST(StiffFields, SiteDependentExchange) {
  expect_converges(LandauLifshitz(
      EffectiveField(SiteDependentExchange(numbers(5, 25)), Zeeman({0.2, 0, 0.5})), 0.1));
}

TEST(StiffFields, DampingOfSites) {
  expect_converges(LandauLifshitz(EffectiveField(Exchange(film(), 25)), numbers(0.5, 0.1)));
}

TEST(StiffFields, Dmi) {
  expect_converges(LandauLifshitz(
      EffectiveField(Exchange(film(), 25), InterfacialDmi(film(), 3, {0, 0, 1})), 0.1));
}

TEST(StiffFields, FieldOfAllSpins) {
  expect_converges(LandauLifshitz(EffectiveField(Exchange(film(), 25), MeanField(2)), 0.1));
}

TEST(StiffFields, TimeDependentField) {
  auto const turning = [](double t) -> Vec3<double> {
    return {2 * std::cos(9 * t), 2 * std::sin(9 * t), 1};
  };
  expect_converges(
      LandauLifshitz(EffectiveField(Exchange(film(), 25), TimeDependentZeeman(turning)), 0.1));
}

TEST(StiffFields, WithoutPrecession) {
  expect_converges(LandauLifshitz(EffectiveField(Exchange(film(), 25)), 1, false));
}

TEST(StiffFields, OrthogonalGenerator) {
  expect_converges(
      orthogonal(LandauLifshitz(EffectiveField(Exchange(film(), 25), Zeeman({1, 0, 2})), 0.1)),
      800);
}

TEST(StiffFields, Antiferromagnet) {
  // The preconditioner does not cover exchange of the opposite sign, so steps stay short.
  auto const start = random_spins(film(), 3);
  LandauLifshitz const generator(EffectiveField(Exchange(film(), -1)), 0.1);
  auto const exact = run<Rkmk4<Spins>>(generator, start, 0.5e-3, 1000);
  auto const end = run<StiffGauss2<Spins>>(generator, start, 5e-3, 100);
  EXPECT_LT(largest_distance(end, exact), 1e-3);
}

TEST(StiffFields, ExchangeIsMeasured) {
  auto lattice = film();
  lattice.spacing = {0.5, 2, 1};
  Spins const spins = wavy(lattice), work("work", lattice);
  auto const measured = [&](auto const& generator) {
    detail::MeasuredExchange exchange;
    EXPECT_EQ(exchange.measure(Space(), "measure", generator, spins, work, 0), 6);
    return exchange;
  };
  EffectiveField const field(Exchange(lattice, 3), UniaxialAnisotropy(1, {1, 2, -1}),
                             SlabDemag(Vector{0, 0, 1}, 0.7), Zeeman({1, 2, 3}));
  auto const damped = measured(LandauLifshitz(field, 0.2));
  EXPECT_NEAR(damped.couplings[0], 12, 1e-10);
  EXPECT_NEAR(damped.couplings[1], 0.75, 1e-10);
  EXPECT_EQ(damped.couplings[2], 0);
  EXPECT_NEAR(damped.damping, 0.2, 1e-10);
  EXPECT_EQ(damped.precession, 1);
  auto const overdamped = measured(LandauLifshitz(field, 2, false));
  EXPECT_NEAR(overdamped.couplings[0], 24, 1e-10);
  EXPECT_EQ(overdamped.precession, 0);
  EXPECT_EQ(overdamped.damping, 1);
}

}  // namespace
}  // namespace cayspin::test
