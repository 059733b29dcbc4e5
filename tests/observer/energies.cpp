// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The energies of single terms on three spins, against numbers computed by hand.
#include "../support/backends.hpp"
#include "../support/coefficients.hpp"

#include <cayspin/cayspin.hpp>

namespace cayspin::test {
namespace {

template <class Backend>
class TermEnergy : public ::testing::Test {
 protected:
  using Spins = typename Backend::Spins;
  Lattice const lattice = Lattice::chain(3, 0.5);
  Spins const spins = spins_of<Spins>(lattice, {1, 0, 0, 0, 0.6, 0.8, 0, 0, -1});
  static constexpr double tolerance = 64 * epsilon<typename Backend::Real>;

  /// Expects `value` as the energy of a term: by itself, in a sum of terms, in a generator, and in
  /// a sample. `magnitude`: the sum over sites of absolute energies.
  template <class Term>
  void expect_energy(char const* name, Term const& term, double value, double magnitude,
                     double t = 0) {
    SCOPED_TRACE(name);
    EffectiveField const field(term);
    LandauLifshitz const generator(field, 0.3);
    expect_energy(energy(exec, term, spins, t), value, magnitude);
    expect_energy(energy(exec, field, spins, t), value, magnitude);
    expect_energy(energy(exec, generator, spins, t), value, magnitude);
    expect_energy(sample(exec, generator, {0, t, 0.1, false}, spins).energy, value, magnitude);
    expect_energy(term_energies(exec, field, spins, t)[0], value, magnitude);
  }

 private:
  void expect_energy(Energy const& found, double value, double magnitude) const {
    EXPECT_NEAR(found.value, value, tolerance * magnitude);
    EXPECT_NEAR(found.magnitude, magnitude, tolerance * magnitude);
  }
  typename Backend::Exec exec;
};
TYPED_TEST_SUITE(TermEnergy, Backends, BackendName);

TYPED_TEST(TermEnergy, IsThatOfThePage) {
  using Fields = typename TypeParam::Spins;
  auto const& lattice = this->lattice;
  // The energies -m.H of the sites are -0.3, -0.72 and 1.2.
  Vec3<double> const applied{0.3, -0.4, 1.2};
  this->expect_energy("Zeeman", Zeeman{applied}, 0.18, 2.22);
  this->expect_energy("TimeDependentZeeman",
                      TimeDependentZeeman([&](double t) { return (1 + t) * applied; }), 0.27, 3.33,
                      0.5);
  // Each of the two bonds has A * |dm|^2 / (2 * 0.25), with |dm|^2 = 2 and 3.6.
  this->expect_energy("Exchange", Exchange(lattice, 0.8), 8.96, 8.96);
  // The bonds have harmonic means: 2 * 0.4 * 1.2 / 1.6 = 0.6 and 2 * 1.2 * 0.3 / 1.5 = 0.48.
  auto const constants = numbers_on<Fields>(lattice, [](std::int64_t site) {
    return site == 0 ? 0.4 : site == 1 ? 1.2 : 0.3;
  });
  this->expect_energy("SiteDependentExchange", SiteDependentExchange(constants),
                      2 * (0.6 * 2 + 0.48 * 3.6), 2 * (0.6 * 2 + 0.48 * 3.6));
  // The bonds have D / 0.5 * (m x m').y, since n x e = y; the y components are -0.8 and 0. Half the
  // energy of a bond belongs to each of its sites.
  this->expect_energy("InterfacialDmi", InterfacialDmi(lattice, 0.7, {0, 0, 1}), -1.12, 1.12);
  // -K / 2 * mz^2
  this->expect_energy("UniaxialAnisotropy", UniaxialAnisotropy(2, {0, 0, 3}), -1.64, 1.64);
  // The sum of -K / 2 * mz^2 over the sites: -1/2 * (0.4 * 0 + 1.2 * 0.64 + 0.3 * 1)
  this->expect_energy("SiteDependentUniaxialAnisotropy",
                      SiteDependentUniaxialAnisotropy(constants, Vec3<double>{0, 0, 1}), -0.534,
                      0.534);
  // The energies 1/2 * (m.n)^2 of the sites, with n = (0, 0.6, 0.8), are 0, 0.5 and 0.32.
  this->expect_energy("SlabDemag", SlabDemag({0, 3, 4}), 0.82, 0.82);
  this->expect_energy("SlabDemag, half", SlabDemag({0, 3, 4}, 0.5), 0.41, 0.41);
}

TYPED_TEST(TermEnergy, OfVacancies) {
  using Fields = typename TypeParam::Spins;
  auto const occupation =
      numbers_on<Fields>(this->lattice, [](std::int64_t site) { return site == 1 ? 0 : 1; });
  this->expect_energy(
      "Zeeman", FieldWithVacancies(EffectiveField(Zeeman{{0.3, -0.4, 1.2}}), occupation), 0.9, 1.5);
  this->expect_energy(
      "Exchange", FieldWithVacancies(EffectiveField(Exchange(this->lattice, 1)), occupation), 0, 0);
}

}  // namespace
}  // namespace cayspin::test
