// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Signs on one site, sums, uniform states, precision of the energy, and what terms refuse.
#include "terms.hpp"

#include <limits>
#include <stdexcept>

namespace cayspin::test {
namespace {

template <class Backend>
class Fields : public ::testing::Test {
 protected:
  typename Backend::Exec exec;
};
TYPED_TEST_SUITE(Fields, Backends, BackendName);

TYPED_TEST(Fields, QuickCheckOfSigns) {
  using Real = typename TypeParam::Real;
  auto const lattice = Lattice::chain(1);
  auto const spins = spins_of<typename TypeParam::Spins>(lattice, {0.6, 0, 0.8});
  EffectiveField const field(UniaxialAnisotropy(0.5, {0, 0, 1}), SlabDemag({1, 0, 0}),
                             Zeeman{{0.1, 0.2, 0.3}});
  LandauLifshitz const generator(field, 0.1);
  auto const h = at(evaluated(this->exec, field, spins), 0);
  auto const a = at(evaluated(this->exec, generator, spins), 0);
  auto const rate = cross(a, at(numbers_of(spins), 0));
  auto const expect = [](Vec3<double> const& found, Vec3<double> const& expected) {
    EXPECT_NEAR(found.x, expected.x, 2 * epsilon<Real>);
    EXPECT_NEAR(found.y, expected.y, 2 * epsilon<Real>);
    EXPECT_NEAR(found.z, expected.z, 2 * epsilon<Real>);
  };
  expect(h, {-0.5, 0.2, 0.7});
  expect(a, {-0.516, 0.118, 0.712});
  expect(rate, {0.0944, 0.84, -0.0708});
  // -K m_z^2/2 + m_x^2/2 - m.H
  EXPECT_NEAR(energy(this->exec, field, spins).value, -0.16 + 0.18 - 0.3, 4 * epsilon<Real>);
  EXPECT_NEAR(energy(this->exec, field, spins).magnitude, 0.16 + 0.18 + 0.3, 4 * epsilon<Real>);
}

TYPED_TEST(Fields, ASumHasTheTermsFieldsAndEnergies) {
  using Real = typename TypeParam::Real;
  auto const lattice = Lattice::cubic(11, 2, 3, 0.5);
  auto const spins =
      spins_of<typename TypeParam::Spins>(lattice, random_directions(lattice.sites(), 21));
  Exchange const exchange(lattice, 1.3);
  UniaxialAnisotropy const anisotropy(1.7, {1, -2, 2});
  Zeeman const zeeman{{0.3, -0.4, 0.5}};
  EffectiveField const all(exchange, anisotropy, zeeman);
  auto const sum = evaluated(this->exec, all, spins);
  auto const first = evaluated(this->exec, exchange, spins);
  auto const second = evaluated(this->exec, anisotropy, spins);
  auto const third = evaluated(this->exec, zeeman, spins);
  for (std::size_t i = 0; i < sum.size(); ++i)
    EXPECT_NEAR(sum[i], first[i] + second[i] + third[i], 32 * epsilon<Real>);
  double magnitude = 0, value = 0;
  for (Energy const part :
       {energy(this->exec, exchange, spins), energy(this->exec, anisotropy, spins),
        energy(this->exec, zeeman, spins)})
    magnitude += part.magnitude, value += part.value;
  Energy const total = energy(this->exec, all, spins);
  EXPECT_NEAR(total.value, value, 16 * epsilon<double> * magnitude);
  EXPECT_NEAR(total.magnitude, magnitude, 16 * epsilon<double> * magnitude);
}

TYPED_TEST(Fields, NoTermsNoField) {
  auto const spins =
      spins_of<typename TypeParam::Spins>(Lattice::chain(5), random_directions(5, 2));
  for (double const h : evaluated(this->exec, EffectiveField<>(), spins)) EXPECT_EQ(h, 0);
  EXPECT_EQ(energy(this->exec, EffectiveField<>(), spins).value, 0);
}

// Exactly: a uniform state must stay at rest, for any numbers and spacings.
TYPED_TEST(Fields, UniformStatesHaveNoExchange) {
  for (Boundary const boundary : {Boundary::open, Boundary::periodic})
    for (unsigned seed = 0; seed < 5; ++seed) {
      auto lattice = Lattice::cubic(9, 2, 3, 0.3, boundary);
      auto const m = random_directions(1, seed);
      std::vector<double> numbers;
      for (std::int64_t site = 0; site < lattice.sites(); ++site)
        numbers.insert(numbers.end(), m.begin(), m.end());
      auto const spins = spins_of<typename TypeParam::Spins>(lattice, numbers);
      for (double const h : evaluated(this->exec, Exchange(lattice, 1.7), spins)) EXPECT_EQ(h, 0);
      EXPECT_EQ(energy(this->exec, Exchange(lattice, 1.7), spins).value, 0);
    }
}

/// What steppers that need A x m alone ask a field for.
template <class Prepared>
struct TurningField {
  Prepared field_of;

  template <class Stencil>
  KOKKOS_FUNCTION Vec3<typename Stencil::value_type> field(Stencil const& stencil) const {
    return detail::turning_field(field_of, stencil);
  }
};

TYPED_TEST(Fields, WhatTurnsSpinsDiffersByAMultipleOfThem) {
  using Spins = typename TypeParam::Spins;
  auto stretched = Lattice::cubic(19, 4, 3, 0.5, Boundary::periodic);
  stretched.spacing[1] = 0.7;
  for (auto const& lattice : {Lattice::cubic(19, 4, 3), stretched, Lattice::square(19, 5),
                              Lattice::chain(19, 1, Boundary::periodic)}) {
    EffectiveField const field(Exchange(lattice, 1.3), UniaxialAnisotropy(0.5, {1, 0, 0}),
                               UniaxialAnisotropy(0.4, {0, 1, 0}), SlabDemag({0, 0, 1}, 0.6),
                               UniaxialAnisotropy(0.3, {1, 2, 3}), Zeeman{{0.1, 0.2, 0.3}},
                               CubicAnisotropy(0.7, {1, 2, 2}, {2, 1, -2}));
    auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 7));
    auto const prepared = detail::prepare_term(field, this->exec, spins, 0);
    auto const h = evaluated(this->exec, field, spins);
    auto const turning = evaluated(
        this->exec, TurningField<std::remove_const_t<decltype(prepared)>>{prepared}, spins);
    auto const m = numbers_of(spins);
    for (std::int64_t site = 0; site < lattice.sites(); ++site) {
      auto const apart = cross(at(turning, site) - at(h, site), at(m, site));
      EXPECT_LT(std::sqrt(dot(apart, apart)), 100 * epsilon<typename TypeParam::Real>) << site;
    }
  }
}

// Half a million equal shares: a sum in float would stop growing at the fifth digit.
TYPED_TEST(Fields, EnergiesAreSummedInDouble) {
  using Real = typename TypeParam::Real;
  auto const lattice = Lattice::square(8200, 64);
  auto const spins = typename TypeParam::Spins("spins", lattice);
  double const expected = -0.1 * static_cast<double>(lattice.sites());
  EXPECT_NEAR(energy(this->exec, Zeeman{{0, 0, 0.1}}, spins).value, expected,
              1e-12 * std::abs(expected));
  auto const directions = random_directions(lattice.sites(), 4);
  copy_from_host(directions, spins);
  long double sum = 0;
  for (std::size_t i = 0; i < directions.size(); i += 3)
    sum -= 0.7L * static_cast<Real>(directions[i]) + 0.1L * static_cast<Real>(directions[i + 2]);
  EXPECT_NEAR(energy(this->exec, Zeeman{{0.7, 0, 0.1}}, spins).value, static_cast<double>(sum),
              1e-14 * static_cast<double>(lattice.sites()));
}

TYPED_TEST(Fields, HostAndDeviceFormsOfTheSlabAgree) {
  using Real = typename TypeParam::Real;
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::cubic(21, 3, 2);
  auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 5));
  auto const expect_equal = [&](auto const& device, SlabDemagOnHost const& host) {
    HostField<Spins, SlabDemagOnHost> const on_host(lattice, host);
    auto const a = evaluated(this->exec, device, spins), b = evaluated(this->exec, on_host, spins);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 4 * epsilon<Real>);
    double const energy_there = energy(this->exec, on_host, spins).value;
    EXPECT_NEAR(energy(this->exec, device, spins).value, energy_there,
                4 * epsilon<Real> * static_cast<double>(lattice.sites()));
  };
  expect_equal(SlabDemag({1, 1, 0}, 0.8), SlabDemagOnHost({1, 1, 0}, 0.8));
  using Layers = LayerAveragedSlabDemag<typename TypeParam::MemorySpace>;
  expect_equal(Layers(lattice, 0, 0.8), SlabDemagOnHost({1, 0, 0}, 0.8, true));
  expect_equal(Layers(lattice, 1, 0.8), SlabDemagOnHost({0, 2, 0}, 0.8, true));
  expect_equal(Layers(lattice, 2, 0.8), SlabDemagOnHost({0, 0, 1}, 0.8, true));
}

TYPED_TEST(Fields, WhatTermsRefuse) {
  using Spins = typename TypeParam::Spins;
  using Layers = LayerAveragedSlabDemag<typename TypeParam::MemorySpace>;
  double const nan = std::numeric_limits<double>::quiet_NaN();
  auto const lattice = Lattice::chain(4);
  EXPECT_THROW(UniaxialAnisotropy(1, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(UniaxialAnisotropy(1, {0, nan, 0}), std::invalid_argument);
  EXPECT_THROW(CubicAnisotropy(1, {0, 0, 0}, {0, 1, 0}), std::invalid_argument);
  EXPECT_THROW(CubicAnisotropy(1, {1, 0, 0}, {0, nan, 0}), std::invalid_argument);
  EXPECT_THROW(CubicAnisotropy(1, {1, 0, 0}, {3e-9, 1, 0}), std::invalid_argument);
  EXPECT_NO_THROW(CubicAnisotropy(1, {2, 0, 0}, {1e-9, 2, 0}));
  EXPECT_THROW(Slonczewski(1, 0, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(SlabDemag({0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(SlabDemagOnHost({0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(SlabDemagOnHost({1, 1, 0}, 1, true), std::invalid_argument);
  EXPECT_THROW(Layers(lattice, 3), std::invalid_argument);
  EXPECT_THROW(Layers(lattice, -1), std::invalid_argument);
  Spins const other("other", Lattice::chain(5));
  EXPECT_THROW(energy(this->exec, Layers(lattice, 0), other), std::invalid_argument);
  HostField<Spins, SlabDemagOnHost> const on_host(lattice, SlabDemagOnHost({1, 0, 0}));
  EXPECT_THROW(energy(this->exec, on_host, other), std::invalid_argument);
}

TYPED_TEST(Fields, NumbersThatAreNotFiniteAreRefused) {
  using Spins = typename TypeParam::Spins;
  using Layers = LayerAveragedSlabDemag<typename TypeParam::MemorySpace>;
  auto const lattice = Lattice::square(4, 3);
  auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 5));
  Spins const output("output", lattice);
  auto const refuses = [](char const* sentence, auto const& work) {
    try {
      work();
      ADD_FAILURE() << "no \"" << sentence << "\"";
    } catch (std::invalid_argument const& error) {
      EXPECT_STREQ(error.what(), sentence);
    }
  };
  for (double const bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    refuses("cayspin::Exchange: the constant must be finite", [&] { Exchange(lattice, bad); });
    refuses("cayspin::InterfacialDmi: the constant must be finite",
            [&] { InterfacialDmi(lattice, bad); });
    refuses("cayspin::BulkDmi: the constant must be finite", [&] { BulkDmi(lattice, bad); });
    refuses("cayspin::Biquadratic: the constant must be finite",
            [&] { Biquadratic(lattice, bad); });
    refuses("cayspin::ZhangLi: the velocity must be finite", [&] {
      ZhangLi(lattice, {0, bad, 0});
    });
    refuses("cayspin::ZhangLi: the nonadiabaticity must be finite", [&] {
      ZhangLi(lattice, {1, 0, 0}, bad);
    });
    refuses("cayspin::Slonczewski: the damping-like torque must be finite", [&] {
      Slonczewski(bad, 0, {0, 0, 1});
    });
    refuses("cayspin::Slonczewski: the field-like torque must be finite", [&] {
      Slonczewski(0, bad, {0, 0, 1});
    });
    refuses("cayspin::CubicAnisotropy: the constant must be finite", [&] {
      CubicAnisotropy(bad, {1, 0, 0}, {0, 1, 0});
    });
    refuses("cayspin::UniaxialAnisotropy: the constant must be finite", [&] {
      UniaxialAnisotropy(bad, {0, 0, 1});
    });
    refuses("cayspin::SlabDemag: the strength must be finite", [&] { SlabDemag({0, 0, 1}, bad); });
    refuses("cayspin::SlabDemagOnHost: the strength must be finite", [&] {
      SlabDemagOnHost({0, 0, 1}, bad);
    });
    refuses("cayspin::LayerAveragedSlabDemag: the strength must be finite",
            [&] { Layers(lattice, 1, bad); });
    for (Zeeman const zeeman : {Zeeman{{bad, 0, 1}}, Zeeman{{0, bad, 1}}, Zeeman{{1, 0, bad}}}) {
      EffectiveField const field(Exchange(lattice, 1), zeeman);
      char const* const sentence = "cayspin::Zeeman: the applied field must be finite";
      refuses(sentence, [&] { energy(this->exec, zeeman, spins); });
      refuses(sentence, [&] { energy(this->exec, field, spins); });
      refuses(sentence, [&] { evaluate_field(this->exec, field, spins, 0, output); });
      refuses(sentence, [&] {
        auto moved = spins_of<Spins>(lattice, random_directions(lattice.sites(), 5));
        Rkmk4<Spins>(moved).step(this->exec, LandauLifshitz(field, 0.1), moved, 0, 0.01);
      });
    }
  }
}

}  // namespace
}  // namespace cayspin::test
