// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Terms with site-dependent coefficients: H = -dE/dm, formulas by hand, equal coefficients against
// uniform terms, conserved energy, and refusals.
#include "../support/coefficients.hpp"
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "gradient.hpp"

#include <cayspin_paper/analytic_sigma.hpp>

#include <array>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace cayspin::test {
namespace {

std::function<double(Bond const&)> harmonic_mean(std::vector<double> const& a) {
  return [=](Bond const& bond) {
    double const n = a[bond.from], q = a[bond.to];
    return n == 0 || q == 0 ? 0 : 2 / (1 / n + 1 / q);
  };
}

ByHand anisotropy_by_hand(std::vector<double> const& k, std::vector<double> const& axes) {
  return {[=](auto const& m, std::int64_t site) {
            auto const e = at(axes, site);
            return (k[site] * dot(at(m, site), e)) * e;
          },
          [=](auto const& m) {
            double sum = 0;
            for (std::size_t site = 0; site < k.size(); ++site) {
              double const along = dot(at(m, site), at(axes, site));
              sum -= 0.5 * k[site] * along * along;
            }
            return sum;
          }};
}

std::vector<double> repeated(Vec3<double> const& v, std::int64_t count) {
  std::vector<double> numbers;
  for (std::int64_t site = 0; site < count; ++site) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return numbers;
}

template <class Backend>
class SiteDependent : public GradientTest<Backend> {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  typename Backend::Exec exec;
};
TYPED_TEST_SUITE(SiteDependent, Backends, BackendName);

// Products of such constants are beyond the range of float.
TYPED_TEST(SiteDependent, ExchangeOfTinyAndHugeConstants) {
  using Spins = typename TypeParam::Spins;
  using Real = typename TypeParam::Real;
  auto const lattice = Lattice::chain(6);
  auto const spins = random_spins<Spins>(lattice, 5);
  for (double const constant : {1e-30, 1e-23, 1e25}) {
    auto const constants = random_numbers_on<Spins>(lattice, constant, constant, 5);
    auto const found =
        energy(this->exec, EffectiveField(SiteDependentExchange(constants)), spins, 0).value;
    auto const uniform = energy(this->exec, EffectiveField(Exchange(lattice, constant)), spins, 0);
    EXPECT_NEAR(found / uniform.value, 1, 32 * std::numeric_limits<Real>::epsilon());
  }
}

// Products of the constants divided by the squared spacing are beyond the range of float or double.
TYPED_TEST(SiteDependent, ExchangeAcrossTinyAndHugeSpacings) {
  using Spins = typename TypeParam::Spins;
  using Real = typename TypeParam::Real;
  std::vector<std::array<double, 2>> cases{{1e12, 1e-9}, {1e-14, 1e8}};
  if (sizeof(Real) == sizeof(double)) cases.insert(cases.end(), {{1e150, 1e-50}, {1e-140, 1e20}});
  for (auto const& [constant, spacing] : cases) {
    auto const lattice = Lattice::chain(6, spacing);
    auto const spins = random_spins<Spins>(lattice, 5);
    auto const constants = random_numbers_on<Spins>(lattice, constant, constant, 5);
    auto const found =
        energy(this->exec, EffectiveField(SiteDependentExchange(constants)), spins, 0).value;
    auto const uniform = energy(this->exec, EffectiveField(Exchange(lattice, constant)), spins, 0);
    EXPECT_NEAR(found / uniform.value, 1, 32 * std::numeric_limits<Real>::epsilon()) << constant;
  }
}

TYPED_TEST(SiteDependent, ExchangeIsTheHarmonicMean) {
  using Spins = typename TypeParam::Spins;
  for (auto const& lattice : lattices)
    for (double const sign : {1.0, -1.0}) {
      auto const constants = random_numbers_on<Spins>(lattice, sign * 0.1, sign * 4, 5, 7);
      this->check("exchange", lattice, EffectiveField(SiteDependentExchange(constants)),
                  exchange_by_hand(lattice, harmonic_mean(numbers_of(constants))), 0,
                  epsilon<typename TypeParam::Real>);
    }
}

TYPED_TEST(SiteDependent, AnisotropyOfConstantAxisOrBoth) {
  using Spins = typename TypeParam::Spins;
  auto const& lattice = lattices[0];
  auto const constants = random_numbers_on<Spins>(lattice, -2, 4, 6, 5);
  auto const axes = spins_of<Spins>(lattice, random_directions(lattice.sites(), 12));
  auto const k = numbers_of(constants), e = numbers_of(axes);
  Vec3<double> const one{1, -2, 2};
  this->check("both", lattice, SiteDependentUniaxialAnisotropy(constants, axes),
              anisotropy_by_hand(k, e));
  this->check("constant", lattice, SiteDependentUniaxialAnisotropy(constants, one),
              anisotropy_by_hand(k, repeated(unit(one), lattice.sites())));
  this->check("axis", lattice, SiteDependentUniaxialAnisotropy(1.75, axes),
              anisotropy_by_hand(std::vector(k.size(), 1.75), e));
}

// The field is exactly 0, so that uniform states stay in equilibrium: with one constant, and with
// random ones including zeros, for rows that end at any place of a pack.
TYPED_TEST(SiteDependent, UniformStatesHaveNoExchange) {
  using Spins = typename TypeParam::Spins;
  for (std::int64_t nx = 1; nx <= 34; ++nx)
    for (Boundary const boundary : {Boundary::open, Boundary::periodic}) {
      auto const lattice = Lattice::cubic(nx, 2, 3, 0.3, boundary);
      auto const spins = spins_of<Spins>(
          lattice,
          repeated(at(random_directions(1, static_cast<unsigned>(nx)), 0), lattice.sites()));
      SiteDependentExchange const exchange(random_numbers_on<Spins>(lattice, 0.1, 4, 2, 3));
      auto const expect_none = [&](auto const& term) {
        for (double const h : evaluated(this->exec, term, spins)) ASSERT_EQ(h, 0) << nx;
        EXPECT_EQ(energy(this->exec, term, spins).value, 0) << nx;
      };
      expect_none(exchange);
      expect_none(Exchange(lattice, 1.7));
    }
}

// If H were not symmetric over a bond, or not -dE/dm, the energy would change however small dt is.
TEST(SiteDependentCoefficients, ConserveEnergyToTheMethodsOrder) {
  Space const exec;
  Lattice const lattice{
      {11, 4, 3}, {1, 1, 1}, {Boundary::periodic, Boundary::open, Boundary::open}};
  auto const start = random_spins(lattice, 31);
  EffectiveField const field(
      SiteDependentExchange(random_numbers_on<Spins>(lattice, 0.1, 1, 8, 9)),
      SiteDependentUniaxialAnisotropy(random_numbers_on<Spins>(lattice, -1, 1, 9),
                                      random_spins(lattice, 10)));
  LandauLifshitz const generator(field, 0.0);
  std::vector<double> dts, errors;
  for (int const steps : {40, 80, 160}) {
    auto const spins = run<Rkmk4<Spins>>(generator, start, 4.0 / steps, steps);
    dts.push_back(4.0 / steps);
    errors.push_back(std::abs(energy(exec, field, spins).value - energy(exec, field, start).value));
  }
  std::printf("    energy errors %.3g %.3g %.3g\n", errors[0], errors[1], errors[2]);
  expect_order("order of the energy error", fitted_order(dts, errors), 5, 0.4);
}

// Spins that are not coupled and have different dampings are compared with runs in which all have
// the same damping.
TYPED_TEST(SiteDependent, DampingActsSiteBySite) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::cubic(19, 3, 2);
  auto const m = random_directions(lattice.sites(), 51);
  EffectiveField const field(UniaxialAnisotropy(0.7, {1, 2, -2}), Zeeman{{0.5, 0, 1}});
  auto const after = [&](auto const& damping) {
    auto spins = spins_of<Spins>(lattice, m);
    Rkmk4 stepper(spins);
    LandauLifshitz const generator(field, damping, false);
    integrate(this->exec, stepper, generator, spins, {0, 0.1, 10});
    return numbers_of(spins);
  };
  double const dampings[] = {0, 0.25, 1.5};
  auto const found =
      after(numbers_on<Spins>(lattice, [&](auto site) { return dampings[site % 3]; }));
  for (int which = 0; which < 3; ++which) {
    auto const expected = after(dampings[which]);
    for (std::int64_t site = which; site < lattice.sites(); site += 3)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(found[3 * site + c], expected[3 * site + c]) << site;
  }
}

// The method's sigma uses the derivatives of the fields and of the generator.
TYPED_TEST(SiteDependent, EqualCoefficientsStepAlike) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::cubic(9, 3, 2, 0.8, Boundary::periodic);
  auto const constant = [&](double number) {
    return numbers_on<Spins>(lattice, [=](auto) { return number; });
  };
  auto const after = [&](auto const& generator) {
    auto spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 52));
    LieEuler<Spins, isotropy::Analytic> stepper(spins);
    integrate(this->exec, stepper, generator, spins, {0, 0.0625, 4});
    return numbers_of(spins);
  };
  auto const one = after(LandauLifshitz(
      EffectiveField(Exchange(lattice, 1.375), UniaxialAnisotropy(0.5, {0, 0, 1})), 0.25));
  auto const each = after(
      LandauLifshitz(EffectiveField(SiteDependentExchange(constant(1.375)),
                                    SiteDependentUniaxialAnisotropy(constant(0.5), {0, 0, 1})),
                     constant(0.25)));
  for (std::size_t i = 0; i < one.size(); ++i)
    ASSERT_NEAR(one[i], each[i], 256 * epsilon<typename TypeParam::Real>);
}

/// The term of docs/guide/own_field_term.md, in any memory space.
template <class Real, class MemorySpace>
struct AnisotropyOfSites {
  ScalarField<Real, MemorySpace> constants;

  struct InKernels {
    SiteArray<Real, 1> constants;

    template <class Stencil>
    KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      Value const k = stencil.site().load(constants);
      return Vec3<Value>{Value(0), Value(0), k * stencil.center().z};
    }
    template <class Stencil>
    KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      return Value(-0.5) * dot(stencil.center(), field(stencil));
    }
  };
  template <class Spins>
  void check_spins(Spins const& spins) const {
    static_assert(std::is_same_v<typename Spins::value_type, Real>);
    require_lattice("AnisotropyOfSites", constants.lattice(), spins.lattice());
  }
  template <class Exec, class Spins>
  InKernels prepare(Exec const&, Spins const&, double) const {
    return {constants.array()};
  }
  template <class Exec, class Spins>
  bool is_stationary(Exec const&, Spins const&) const {
    return true;
  }
};

TYPED_TEST(SiteDependent, UsersTermLoadsItsValues) {
  using Real = typename TypeParam::Real;
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::cubic(11, 4, 3).with_replicas(2);
  auto const m = random_directions(lattice.sites(), 53);
  auto const constants = random_numbers_on<Spins>(lattice, -1, 1, 54);
  AnisotropyOfSites<Real, typename Spins::memory_space> const users{constants};
  SiteDependentUniaxialAnisotropy const ours(constants, {0, 0, 1});
  auto const spins = spins_of<Spins>(lattice, m);
  EXPECT_EQ(evaluated(this->exec, users, spins), evaluated(this->exec, ours, spins));
  EXPECT_NEAR(energy(this->exec, users, spins).value, energy(this->exec, ours, spins).value, 1e-10);
  EXPECT_THROW(energy(this->exec, users, Spins("other", Lattice::cubic(11, 4, 3))),
               std::invalid_argument);
}

TYPED_TEST(SiteDependent, WhatIsRefused) {
  using Spins = typename TypeParam::Spins;
  double const nan = std::numeric_limits<double>::quiet_NaN();
  double const infinity = std::numeric_limits<double>::infinity();
  auto const lattice = Lattice::chain(21);
  auto const ones_but = [&](double last) {
    return numbers_on<Spins>(lattice, [=](auto site) { return site == 20 ? last : 1.0; });
  };
  Spins const axes("axes", lattice);
  for (double const number : {nan, infinity, -infinity}) {
    EXPECT_THROW(SiteDependentExchange(ones_but(number)), std::invalid_argument);
    EXPECT_THROW(SiteDependentUniaxialAnisotropy(ones_but(number), axes), std::invalid_argument);
    EXPECT_THROW(SiteDependentUniaxialAnisotropy(number, axes), std::invalid_argument);
  }
  EXPECT_THROW(SiteDependentExchange(ones_but(-1)), std::invalid_argument);
  for (double const number : {-0.1, nan, infinity})
    EXPECT_THROW(LandauLifshitz(EffectiveField<>(), ones_but(number)), std::invalid_argument);
  EXPECT_NO_THROW(SiteDependentExchange(ones_but(0)));
  EXPECT_THROW(SiteDependentUniaxialAnisotropy(ones_but(1), {0, 0, 0}), std::invalid_argument);
  for (double const length : {0.0, 0.5, nan}) {
    auto numbers = repeated({0, 1, 0}, 21);
    numbers[3 * 20 + 1] = length;
    EXPECT_THROW(SiteDependentUniaxialAnisotropy(1, spins_of<Spins>(lattice, numbers)),
                 std::invalid_argument);
  }
}

}  // namespace
}  // namespace cayspin::test
