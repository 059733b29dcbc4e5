// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Vacant sites: no field, no energy, no motion; for their neighbours they are an open end.
#include "../support/biquadratic_bonds.hpp"
#include "../support/coefficients.hpp"
#include "gradient.hpp"

#include <cayspin/field/field_of_moments.hpp>

#include <cayspin_paper/analytic_sigma.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace cayspin::test {
namespace {

Vec3<double> turning_field(double t) { return {0.7 * std::cos(t), 0.7 * std::sin(t), 0.9}; }

auto every_term(Lattice const& lattice) {
  return EffectiveField(Exchange(lattice, 0.8), UniaxialAnisotropy(0.7, {1, 2, -2}),
                        TimeDependentZeeman(turning_field));
}

/// Returns a field with terms that isotropy::Analytic cannot differentiate.
auto bonds_and_torques(Lattice const& lattice) {
  return EffectiveField(
      BiquadraticBonds{0.6}, BulkDmi(lattice, 0.4), ZhangLi(lattice, {0.5, -0.3, 0.2}, 0.3),
      CubicAnisotropy(0.7, {1, 2, 2}, {2, 1, -2}),
      Slonczewski({.damping_like = 0.2, .field_like = 0.1, .polarization = {1, 0, 1}}));
}

/// A box of occupied sites, surrounded by vacant sites. All other sites are occupied.
struct Box {
  Lattice lattice;
  std::array<std::int64_t, 3> begin, shape;

  std::array<std::int64_t, 3> index(std::int64_t site) const {
    auto const& n = lattice.shape;
    return {site % n[0], site / n[0] % n[1], site / (n[0] * n[1])};
  }
  bool holds(std::int64_t site, std::int64_t margin = 0) const {
    auto const i = index(site);
    for (int axis = 0; axis < 3; ++axis)
      if (i[axis] < begin[axis] - margin || i[axis] >= begin[axis] + shape[axis] + margin)
        return false;
    return true;
  }
  bool is_vacant(std::int64_t site) const { return holds(site, 1) && !holds(site); }

  /// Returns the part of an array (sites, 3) on the lattice that belongs to the box.
  std::vector<double> part(std::vector<double> const& numbers) const {
    std::vector<double> found;
    for (std::int64_t site = 0; site < lattice.sites(); ++site)
      if (holds(site))
        for (int c = 0; c < 3; ++c) found.push_back(numbers[3 * site + c]);
    return found;
  }
};

Box const box{{{15, 7, 6}, {0.5, 0.8, 1.25}, {Boundary::periodic, Boundary::open, Boundary::open}},
              {3, 2, 1},
              {9, 3, 2}};

template <class Backend>
class Vacancies : public GradientTest<Backend> {
 protected:
  using Spins = typename Backend::Spins;
  typename Backend::Exec exec;

  auto occupation() const {
    return numbers_on<Spins>(box.lattice, [](auto site) { return box.is_vacant(site) ? 0 : 1; });
  }

  template <class Stepper, class Field>
  std::vector<double> after_ten_steps(Field const& field, Lattice const& lattice,
                                      std::vector<double> const& m) const {
    auto spins = spins_of<Spins>(lattice, m);
    Stepper stepper(spins);
    integrate(exec, stepper, LandauLifshitz(field, 0.1), spins, {0, 0.05, 10});
    return numbers_of(spins);
  }

  template <class Stepper, class Make>
  void expect_cut_off(Make const& field_on) const {
    auto const m = random_directions(box.lattice.sites(), 61);
    auto alone = box.lattice;
    alone.shape = box.shape;
    alone.boundary.fill(Boundary::open);
    FieldWithVacancies const field(field_on(box.lattice), occupation());
    auto const found = after_ten_steps<Stepper>(field, box.lattice, m);
    auto const start = numbers_of(spins_of<Spins>(box.lattice, m));
    EXPECT_EQ(box.part(found), after_ten_steps<Stepper>(field_on(alone), alone, box.part(m)));
    for (std::int64_t site = 0; site < box.lattice.sites(); ++site)
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(found[3 * site + c] == start[3 * site + c], box.is_vacant(site)) << site;
    EXPECT_LT(norm_defect(exec, spins_of<Spins>(box.lattice, found)),
              32 * epsilon<typename Backend::Real>);
  }
};
TYPED_TEST_SUITE(Vacancies, Backends, BackendName);

// The spins in the box move bitwise as they would in a lattice that consists of the box only.
TYPED_TEST(Vacancies, CutAClusterOff) {
  using Spins = typename TypeParam::Spins;
  this->template expect_cut_off<Rkmk4<Spins>>(every_term);
  this->template expect_cut_off<Rkmk4<Spins>>(bonds_and_torques);
}

TYPED_TEST(Vacancies, CutAClusterOffForTheDerivativeOfTheField) {
  using Spins = typename TypeParam::Spins;
  this->template expect_cut_off<LieEuler<Spins, isotropy::Analytic>>(every_term);
}

TYPED_TEST(Vacancies, HaveNoFieldAndNoEnergy) {
  using Spins = typename TypeParam::Spins;
  for (auto const& lattice : lattices) {
    auto const occupation = numbers_on<Spins>(
        lattice, [](auto site) { return site % 4 == 1 || site % 7 == 0 ? 0 : 1; });
    auto const constants = random_numbers_on<Spins>(lattice, 0.1, 2, 5);
    auto const n = numbers_of(occupation), a = numbers_of(constants);
    auto const bonds_by_hand = exchange_by_hand(lattice, [=](Bond const& bond) {
      double const from = a[bond.from], to = a[bond.to];
      return n[bond.from] * n[bond.to] * (0.8 + 2 * from * to / (from + to));
    });
    EffectiveField const field(Exchange(lattice, 0.8), SiteDependentExchange(constants),
                               UniaxialAnisotropy(0.7, {0, 0, 1}), Zeeman{{0.3, -0.4, 0.5}});
    Vec3<double> const applied{0.3, -0.4, 0.5};
    this->check("vacancies", lattice, FieldWithVacancies(field, occupation),
                {[=](auto const& m, std::int64_t site) {
                   auto const spin = at(m, site);
                   return bonds_by_hand.field(m, site) +
                          n[site] * (Vec3<double>{0, 0, 0.7 * spin.z} + applied);
                 },
                 [=](auto const& m) {
                   double sum = bonds_by_hand.energy(m);
                   for (std::size_t site = 0; site < n.size(); ++site) {
                     auto const spin = at(m, static_cast<std::int64_t>(site));
                     sum -= n[site] * (0.35 * spin.z * spin.z + dot(spin, applied));
                   }
                   return sum;
                 }},
                0, epsilon<typename TypeParam::Real>);
  }
}

TYPED_TEST(Vacancies, WithoutAnyNothingChanges) {
  using Spins = typename TypeParam::Spins;
  auto const m = random_directions(box.lattice.sites(), 62);
  auto const spins = spins_of<Spins>(box.lattice, m);
  auto const field = every_term(box.lattice);
  FieldWithVacancies const same(field, numbers_on<Spins>(box.lattice, [](auto) { return 1; }));
  EXPECT_EQ(evaluated(this->exec, same, spins), evaluated(this->exec, field, spins));
  EXPECT_EQ(energy(this->exec, same, spins).value, energy(this->exec, field, spins).value);
  EXPECT_EQ(energy(this->exec, same, spins).magnitude, energy(this->exec, field, spins).magnitude);
}

// Two sublattices are coupled along x and to each other; one has a moment of 0.
TYPED_TEST(Vacancies, AMomentOfZeroIsNoSpin) {
  using Spins = typename TypeParam::Spins;
  using Memory = typename TypeParam::MemorySpace;
  using Real = typename TypeParam::Real;
  auto lattice = Lattice::cubic(19, 2, 4);
  lattice.cell_sites = 2;
  Vec3<double> const applied{0.3, -0.2, 0.5};
  CellMoments<Memory> const moments(lattice, {2, 0}, {1.5, 0.9});
  FieldOfMoments const field(
      EffectiveField(PairCouplings<Memory>(lattice, {Coupling::of({0, 0}, {1, 0, 0}, 0.7),
                                                     Coupling::of({1, 1}, {1, 0, 0}, 0.4),
                                                     Coupling::of({0, 1}, {0, 0, 0}, 1.3)}),
                     ZeemanOfMoments(applied, moments)),
      moments);
  auto m = random_directions(lattice.sites(), 64);
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    if (site / 38 % 2 == 1) std::fill_n(m.begin() + 3 * site, 3, 0.0);
  auto const spins = spins_of<Spins>(lattice, m);
  auto const h = evaluated(this->exec, field, spins);
  m = numbers_of(spins);
  for (std::int64_t site = 0; site < lattice.sites(); ++site) {
    SCOPED_TRACE(site);
    Vec3<double> expected{0, 0, 0};
    if (site / 38 % 2 == 0) {
      if (site % 19 > 0) expected = expected + 0.7 * at(m, site - 1);
      if (site % 19 < 18) expected = expected + 0.7 * at(m, site + 1);
      expected = (1.5 / 2) * (expected + 2.0 * applied);
    }
    expect_near(at(h, site), expected, 16 * epsilon<Real>);
  }
  EXPECT_THROW(CellMoments<Memory>(lattice, {1, -0.5}), std::invalid_argument);
  EXPECT_THROW(CellMoments<Memory>(lattice, {2, 0}, {1, 0}), std::invalid_argument);
}

TYPED_TEST(Vacancies, MagnetizationOfOccupiedSites) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::cubic(9, 3, 2);
  auto const m = numbers_of(spins_of<Spins>(lattice, random_directions(lattice.sites(), 63)));
  auto const weights = random_numbers_on<Spins>(lattice, 0, 1, 4, 3);
  auto const w = numbers_of(weights);
  Vec3<double> sum{0, 0, 0};
  double total = 0;
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    sum = sum + w[site] * at(m, site), total += w[site];
  auto const found = magnetization(this->exec, spins_of<Spins>(lattice, m), weights);
  expect_near(found, (1 / total) * sum, 64 * epsilon<double>);
}

TYPED_TEST(Vacancies, WhatIsRefused) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::chain(21);
  auto const ones_but = [&](double last) {
    return numbers_on<Spins>(lattice, [=](auto site) { return site == 20 ? last : 1.0; });
  };
  EffectiveField<> const field;
  for (double const number : {0.5, -1.0, 2.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(FieldWithVacancies(field, ones_but(number)), std::invalid_argument);
  EXPECT_THROW(magnetization(this->exec, Spins("spins", lattice), ones_but(-20)),
               std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
