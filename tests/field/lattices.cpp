// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A term or generator made for one lattice is refused on the spins of another, wherever a field is
// evaluated.
#include "../support/coefficients.hpp"

#include <cayspin/cayspin.hpp>

#include <stdexcept>
#include <string>

namespace cayspin::test {
namespace {

Lattice const made_for = Lattice::chain(20);
std::vector<Lattice> const others{Lattice::chain(21), Lattice::square(4, 5),
                                  Lattice::chain(20, 0.5),
                                  Lattice::chain(20, 1, Boundary::periodic)};

template <class Backend>
class Lattices : public ::testing::Test {
 protected:
  using Spins = typename Backend::Spins;
  using Scalars = ScalarField<typename Backend::Real, typename Backend::MemorySpace>;
  typename Backend::Exec exec;

  template <class Call>
  static void expect_refused(std::string const& who, Lattice const& lattice, Call const& call) {
    try {
      call();
      FAIL() << who << " on " << lattice.shape[0] << " x " << lattice.shape[1];
    } catch (std::invalid_argument const& error) {
      std::string const said = error.what();
      EXPECT_EQ(said.find("cayspin::" + who + ": made for a lattice of "), 0u) << said;
      auto const& n = lattice.shape;
      std::string const sites = std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x 1";
      bool const same = n == made_for.shape;
      EXPECT_NE(said.find(same ? "other spacings or boundaries" : "are on " + sites),
                std::string::npos)
          << said;
    }
  }

  /// Wherever a generator is evaluated.
  template <class Generator>
  void check_generator(std::string const& who, Generator const& generator) const {
    for (Lattice const& lattice : others) {
      Spins spins("spins", lattice);
      Spins const output("output", lattice);
      Rkmk4 stepper(spins);
      LieEuler<Spins, isotropy::Analytic> with_rates(spins);
      auto const refused = [&](auto const& call) { expect_refused(who, lattice, call); };
      refused([&] { stepper.step(exec, generator, spins, 0, 0.1); });
      if constexpr (requires { stepper.batch(exec, generator, spins, 0, 0.1, 3); })  // on hosts
        refused([&] { stepper.batch(exec, generator, spins, 0, 0.1, 3); });
      refused([&] { integrate(exec, stepper, generator, spins, {0, 0.1, 9}); });
      refused([&] { with_rates.step(exec, generator, spins, 0, 0.1); });
      refused([&] { energy(exec, generator, spins); });
      refused([&] { term_energies(exec, generator, spins); });
      refused([&] { sample(exec, generator, Step{}, spins); });
      refused([&] { sample(exec, Zeeman{{0, 0, 1}}, Step{}, spins, generator); });
      refused([&] { largest_rate(exec, generator, spins); });
      refused([&] { evaluate_generator(exec, generator, spins, 0, output); });
    }
    Spins const spins("spins", made_for), output("output", made_for);
    EXPECT_NO_THROW(evaluate_generator(exec, generator, spins, 0, output));
  }

  template <class Term>
  void check_term(std::string const& who, Term const& term) const {
    check_generator(who, LandauLifshitz(EffectiveField(Zeeman{{0, 0, 1}}, term), 0.1));
    for (Lattice const& lattice : others) {
      Spins const spins("spins", lattice), output("output", lattice);
      expect_refused(who, lattice, [&] { energy(exec, term, spins); });
      expect_refused(who, lattice, [&] { evaluate_field(exec, term, spins, 0, output); });
    }
  }
};
TYPED_TEST_SUITE(Lattices, Backends, BackendName);

TYPED_TEST(Lattices, OfTerms) {
  using Spins = typename TypeParam::Spins;
  using Layers = LayerAveragedSlabDemag<typename TypeParam::MemorySpace>;
  auto const numbers = numbers_on<Spins>(made_for, [](auto) { return 1; });
  this->check_term("Exchange", Exchange(made_for, 1));
  this->check_term("SiteDependentExchange", SiteDependentExchange(numbers));
  this->check_term("SiteDependentUniaxialAnisotropy",
                   SiteDependentUniaxialAnisotropy(numbers, {0, 0, 1}));
  this->check_term("SiteDependentUniaxialAnisotropy",
                   SiteDependentUniaxialAnisotropy(1, Spins("axes", made_for)));
  this->check_term("LayerAveragedSlabDemag", Layers(made_for, 0));
  this->check_term("HostField", HostField(Spins("like", made_for), SlabDemagOnHost({1, 0, 0})));
  this->check_term("FieldWithVacancies", FieldWithVacancies(Zeeman{{0, 0, 1}}, numbers));
}

TYPED_TEST(Lattices, OfTermsAmongVacancies) {
  using Spins = typename TypeParam::Spins;
  for (Lattice const& lattice : others) {
    auto const occupation = numbers_on<Spins>(lattice, [](auto) { return 1; });
    FieldWithVacancies const field(EffectiveField(Exchange(made_for, 1)), occupation);
    Spins const spins("spins", lattice);
    this->expect_refused("Exchange", lattice, [&] { energy(this->exec, field, spins); });
  }
}

TYPED_TEST(Lattices, OfGenerators) {
  using Spins = typename TypeParam::Spins;
  using Tensors = SiteField<typename TypeParam::Real, 3, typename TypeParam::MemorySpace>;
  auto const numbers = numbers_on<Spins>(made_for, [](auto) { return 1; });
  LandauLifshitz const damped(EffectiveField(Zeeman{{0, 0, 1}}), numbers);
  this->check_generator("LandauLifshitz", damped);
  this->check_generator("LandauLifshitz", orthogonal(damped));
  this->check_generator(
      "RigidBodyEnsemble",
      RigidBodyEnsemble<typename TypeParam::Real, typename TypeParam::MemorySpace, 3>(
          Tensors("tensors", made_for)));
}

TYPED_TEST(Lattices, OfObservers) {
  using Spins = typename TypeParam::Spins;
  for (Lattice const& lattice : others) {
    Spins const spins("spins", lattice);
    auto const refused = [&](std::string const& who, auto const& call) {
      this->expect_refused(who, lattice, call);
    };
    LandauLifshitz const generator(EffectiveField(Exchange(made_for, 1)), 0);
    EnergyControl control(generator, Spins("like", made_for));
    refused("EnergyControl", [&] { control(this->exec, Step{}, spins); });
    std::vector<Sample> samples;
    Record record(generator, samples);
    refused("Exchange", [&] { record(this->exec, Step{}, spins); });
    EXPECT_TRUE(samples.empty());
    Spins const output("output", made_for);
    refused("evaluate_field's output", [&] {
      evaluate_field(this->exec, Zeeman{{0, 0, 1}}, spins, 0, output);
    });
    refused("evaluate_generator's output", [&] {
      evaluate_generator(this->exec, RigidBody::principal(1, 2, 3), spins, 0, output);
    });
    refused("magnetization's weights", [&] {
      magnetization(this->exec, spins, numbers_on<Spins>(made_for, [](auto) { return 1; }));
    });
  }
}

}  // namespace
}  // namespace cayspin::test
