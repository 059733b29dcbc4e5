// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Sums of field terms, the precision of their energies, and what terms refuse.
#include "../support/wrong_call.hpp"
#include "terms.hpp"

#include <cayspin/field/field_of_moments.hpp>

#include <limits>
#include <stdexcept>

namespace cayspin::test {
namespace {

template <class Backend>
using Fields = OnBackend<Backend>;
TYPED_TEST_SUITE(Fields, Backends, BackendName);

TYPED_TEST(Fields, ASumHasTheTermsFields) {
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
}

TYPED_TEST(Fields, NoTermsNoField) {
  auto const spins =
      spins_of<typename TypeParam::Spins>(Lattice::chain(5), random_directions(5, 2));
  for (double const h : evaluated(this->exec, EffectiveField<>(), spins)) EXPECT_EQ(h, 0);
  EXPECT_EQ(energy(this->exec, EffectiveField<>(), spins).value, 0);
}

/// A term whose field is the one that steppers use if they need only A x m.
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

// Adds up the energies of half a million sites; a sum in float would have large rounding errors.
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

TYPED_TEST(Fields, WhatTermsRefuse) {
  using Memory = typename TypeParam::MemorySpace;
  using Moments = CellMoments<Memory>;
  double const nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  auto const lattice = Lattice::chain(4);
  EXPECT_THROW(UniaxialAnisotropy(1, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(UniaxialAnisotropy(1, {0, nan, 0}), std::invalid_argument);
  EXPECT_THROW(CubicAnisotropy(1, {0, 0, 0}, {0, 1, 0}), std::invalid_argument);
  EXPECT_THROW(CubicAnisotropy(1, {1, 0, 0}, {0, nan, 0}), std::invalid_argument);
  EXPECT_THROW(CubicAnisotropy(1, {1, 0, 0}, {3e-4, 1, 0}), std::invalid_argument);
  EXPECT_NO_THROW(CubicAnisotropy(1, {2, 0, 0}, {1e-4, 2, 0}));
  EXPECT_THROW(Slonczewski({.damping_like = 1, .polarization = {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(SlabDemag({0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(SlabDemagOnHost({0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(Moments(lattice, {}), std::invalid_argument);
  EXPECT_THROW(Moments(lattice, {1}, {1, 1}), std::invalid_argument);
  for (double const bad : {-1.0, nan, infinity}) {
    EXPECT_THROW(Moments(lattice, {bad}), std::invalid_argument);
    EXPECT_THROW(Moments(lattice, {1}, {bad}), std::invalid_argument);
  }
  EXPECT_THROW(Moments(lattice, {-1}, {-1}), std::invalid_argument);
}

// The second axis is turned to be at right angles to the first.
TEST(CubicAxes, OfFewDigitsAreMadeOrthogonal) {
  Vec3<double> const first{1, 2, 2}, second{2, 1, -2};
  CubicAnisotropy const exact(1.3, first, second);
  for (double const skew : {-9e-5, 3e-7, 9e-5}) {
    CubicAnisotropy const typed(1.3, first, second + skew * first);
    for (Vec3<double> const& m : {Vec3<double>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
      auto const found = typed.parts(m), expected = exact.parts(m);
      EXPECT_NEAR(found.x, expected.x, 4e-15) << skew;
      EXPECT_NEAR(found.y, expected.y, 4e-15) << skew;
      EXPECT_NEAR(found.z, expected.z, 4e-15) << skew;
    }
  }
}

TYPED_TEST(Fields, NumbersThatAreNotFiniteAreRefused) {
  using Spins = typename TypeParam::Spins;
  using Memory = typename TypeParam::MemorySpace;
  Vec3<double> const x{1, 0, 0}, y{0, 1, 0};
  auto const lattice = Lattice::square(4, 3);
  auto const start = [=] {
    return spins_of<Spins>(lattice, random_directions(lattice.sites(), 5));
  };
  auto const spins = start();
  Spins const output("output", lattice);
  double const infinity = std::numeric_limits<double>::infinity();
  for (double const bad : {std::numeric_limits<double>::quiet_NaN(), -infinity}) {
    std::vector<WrongCall> calls{
        {"Exchange: the constant", [&] { Exchange(lattice, bad); }},
        {"InterfacialDmi: the constant", [&] { InterfacialDmi(lattice, bad); }},
        {"BulkDmi: the constant", [&] { BulkDmi(lattice, bad); }},
        {"ZhangLi: the velocity",
         [&] {
           ZhangLi(lattice, Vec3<double>{0, bad, 0});
         }},
        {"ZhangLi: the nonadiabaticity", [&] { ZhangLi(lattice, x, bad); }},
        {"Slonczewski: the damping-like torque",
         [&] { Slonczewski({.damping_like = bad, .polarization = x}); }},
        {"Slonczewski: the field-like torque",
         [&] { Slonczewski({.field_like = bad, .polarization = x}); }},
        {"CubicAnisotropy: the constant", [&] { CubicAnisotropy(bad, x, y); }},
        {"UniaxialAnisotropy: the constant", [&] { UniaxialAnisotropy(bad, x); }},
        {"SlabDemag: the strength", [&] { SlabDemag(x, bad); }},
        {"SlabDemagOnHost: the strength", [&] { SlabDemagOnHost(x, bad); }},
        {"ZeemanOfMoments: the applied field",
         [&] {
           ZeemanOfMoments(Vec3<double>{0, bad, 0}, CellMoments<Memory>(lattice, {1}));
         }},
    };
    for (Zeeman const zeeman : {Zeeman{{bad, 0, 1}}, Zeeman{{0, bad, 1}}, Zeeman{{1, 0, bad}}}) {
      EffectiveField const field(Exchange(lattice, 1), zeeman);
      std::string const applied = "Zeeman: the applied field";
      calls.push_back({applied, [=, this] { energy(this->exec, zeeman, spins); }});
      calls.push_back({applied, [=, this] { energy(this->exec, field, spins); }});
      calls.push_back(
          {applied, [=, this] { evaluate_field(this->exec, field, spins, 0, output); }});
      calls.push_back({applied, [=, this] {
                         auto moved = start();
                         Rkmk4<Spins>(moved).step(this->exec, LandauLifshitz(field, 0.1), moved, 0,
                                                  0.01);
                       }});
    }
    for (auto const& [what, call] : calls)
      EXPECT_EQ(refusal(call), "cayspin::" + what + " must be finite");
  }
}

}  // namespace
}  // namespace cayspin::test
