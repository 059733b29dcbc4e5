// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Functions other than those of steppers, called with fields that do not fit: copies, sums, terms
// and observers.
#include "wrong_calls.hpp"

#include <cmath>
#include <functional>

namespace cayspin::test {
namespace {

using Vectors = SiteField<double, 3, Kokkos::HostSpace>;
using Tensors = SiteField<double, 6, Kokkos::HostSpace>;

struct NoField {
  static constexpr int degree = 2;
  void operator()(Spins const&, Spins const&, double) const {}
};

std::vector<Coupling> const one_bond{Coupling::of({0, 0}, {1, 0, 0}, 1)};

/// Returns a call of each function that computes the energy of a term or generator.
template <class Source>
std::vector<WrongCall> sums_of(Source const& source, Spins const& spins) {
  return {{"energy", [=] { energy(Exec(), source, spins); }},
          {"term_energies", [=] { term_energies(Exec(), source, spins); }},
          {"sample", [=] { sample(Exec(), source, {}, spins); }},
          {"Record", [=] {
             std::vector<Sample> samples;
             Record(source, samples)(Exec(), Step{}, spins);
             EXPECT_TRUE(samples.empty());
           }}};
}
template <class Generator>
std::vector<WrongCall> calls_of_generator(Generator const& generator, Spins const& spins) {
  auto calls = sums_of(generator, spins);
  calls.push_back({"largest_rate", [=] { largest_rate(Exec(), generator, spins); }});
  calls.push_back({"rate of a sample", [=] { sample(Exec(), Zeeman(), {}, spins, generator); }});
  if (spins.sites() != 0)
    calls.push_back({"evaluate_generator", [=] {
                       Spins const output("output", spins.lattice());
                       evaluate_generator(Exec(), generator, spins, 0, output);
                     }});
  return calls;
}
template <class Term>
std::vector<WrongCall> calls_of_term(Term const& term, Spins const& spins) {
  auto calls = sums_of(term, spins);
  if (spins.sites() != 0)
    calls.push_back({"evaluate_field", [=] {
                       Spins const output("output", spins.lattice());
                       evaluate_field(Exec(), term, spins, 0, output);
                     }});
  return calls;
}

TEST(WrongCallsOfSums, SpinsOfOthers) {
  for (auto const& own : own_lattices)
    for (auto const& [kind, spins] : fields_of_others<Spins>(own)) {
      SCOPED_TRACE("spins " + kind);
      Scalars const numbers("numbers", own, 1);
      auto const refuses = [&](std::string const& who, auto const& term) {
        expect_made_for_another(who, own, spins.lattice(), calls_of_term(term, spins));
      };
      auto const generator_refuses = [&](std::string const& who, auto const& generator) {
        expect_made_for_another(who, own, spins.lattice(), calls_of_generator(generator, spins));
      };
      refuses("Exchange", Exchange(own, 1));
      refuses("InterfacialDmi", InterfacialDmi(own, 1));
      refuses("BulkDmi", BulkDmi(own, 1));
      refuses("PairCouplings", PairCouplings<Kokkos::HostSpace>(own, one_bond));
      refuses("ZhangLi", ZhangLi(own, {1, 1, 1}));
      refuses("HostField", HostField(Spins("like", own), NoField()));
      refuses("SiteDependentExchange", EffectiveField(Zeeman(), SiteDependentExchange(numbers)));
      refuses("SiteDependentUniaxialAnisotropy",
              SiteDependentUniaxialAnisotropy(numbers, Vec3<double>{0, 0, 1}));
      refuses("SiteDependentUniaxialAnisotropy",
              SiteDependentUniaxialAnisotropy(1, Vectors(Spins("axes", own))));
      refuses("FieldWithVacancies", FieldWithVacancies(EffectiveField(Zeeman()), numbers));
      CellMoments<Kokkos::HostSpace> const moments(own, {1});
      refuses("FieldOfMoments", FieldOfMoments(EffectiveField(Zeeman()), moments));
      refuses("ZeemanOfMoments", ZeemanOfMoments({0, 0, 1}, moments));
      generator_refuses("Exchange", generator_on(own));
      LandauLifshitz const damped(EffectiveField{Zeeman()}, numbers);
      generator_refuses("LandauLifshitz", damped);
      generator_refuses("LandauLifshitz", orthogonal(damped));
      generator_refuses("RigidBodyEnsemble", RigidBodyEnsemble(Tensors("tensors", own)));

      EnergyControl control(Spins("like", own), generator_on(own));
      expect_made_for_another("EnergyControl", own, spins.lattice(),
                              {{"EnergyControl", [&] {
                                  control(Exec(), Step{0, 0, 0.1, false}, spins);
                                }}});
    }
}

TEST(WrongCallsOfSums, TermsOfOthersInsideOwnOnes) {
  for (auto const& own : own_lattices)
    for (auto const& [kind, other] : lattices_of_others(own)) {
      SCOPED_TRACE(kind);
      Spins const spins("spins", own);
      FieldWithVacancies const field(EffectiveField(Exchange(other, 1)),
                                     Scalars("occupation", own, 1));
      expect_made_for_another("Exchange", other, own, calls_of_term(field, spins));
      EnergyControl control(Spins("like", own), generator_on(other));
      expect_made_for_another("Exchange", other, own,
                              {{"EnergyControl", [&] {
                                  control(Exec(), Step{0, 0, 0.1, false}, spins);
                                }}});
    }
}

TEST(WrongCallsOfSums, NoSpinsAtAll) {
  for (auto const& spins : {Spins(), moved_from<Spins>(Lattice::chain(9))})
    expect_refused({
        {"norm_defect", [&] { norm_defect(Exec(), spins); }},
        {"magnetization", [&] { magnetization(Exec(), spins); }},
        {"magnetization, weighted", [&] { magnetization(Exec(), spins, Scalars()); }},
        {"require_unit_spins", [&] { require_unit_spins(Exec(), spins); }},
        {"normalize", [&] { normalize(Exec(), spins); }},
        {"Normalize", [&] { Normalize()(Exec(), Step{}, spins); }},
        {"energy", [&] { energy(Exec(), Zeeman(), spins); }},
        {"sample", [&] { sample(Exec(), Zeeman(), {}, spins); }},
        {"evaluate_field", [&] { evaluate_field(Exec(), Zeeman(), spins, 0, spins); }},
        {"evaluate_generator",
         [&] { evaluate_generator(Exec(), generator_on(Lattice()), spins, 0, spins); }},
    });
}

TEST(WrongCallsOfSums, OutputsAndWeightsOfOthers) {
  for (auto const& own : own_lattices) {
    Spins const spins("spins", own), same = spins;
    auto const generator = generator_on(own);
    for (auto const& [kind, output] : fields_of_others<Vectors>(own)) {
      SCOPED_TRACE("output " + kind);
      expect_made_for_another(
          "evaluate_field's output", output.lattice(), own,
          {{"of a field", [&] { evaluate_field(Exec(), Zeeman(), spins, 0, output); }}});
      expect_made_for_another(
          "evaluate_generator's output", output.lattice(), own,
          {{"of a generator", [&] { evaluate_generator(Exec(), generator, spins, 0, output); }}});
    }
    for (auto const& [kind, weights] : fields_of_others<Scalars>(own)) {
      SCOPED_TRACE("weights " + kind);
      expect_made_for_another("magnetization's weights", weights.lattice(), own,
                              {{"magnetization", [&] { magnetization(Exec(), spins, weights); }}});
    }
    expect_refused(
        {{"the spins as output", [&] { evaluate_field(Exec(), Zeeman(), spins, 0, same); }},
         {"the spins as output of a generator",
          [&] { evaluate_generator(Exec(), generator, spins, 0, same); }}});
  }
}

TEST(WrongCallsOfTerms, MadeOfNothing) {
  auto const moved = moved_from<Scalars>(Lattice::chain(3));
  for (auto const& none : {Scalars(), moved})
    expect_refused({
        {"SiteDependentExchange", [&] { SiteDependentExchange{none}; }},
        {"FieldWithVacancies", [&] { FieldWithVacancies(EffectiveField(Zeeman()), none); }},
        {"LandauLifshitz", [&] { LandauLifshitz(EffectiveField(Zeeman()), none); }},
        {"SiteDependentUniaxialAnisotropy",
         [&] {
           SiteDependentUniaxialAnisotropy(none, Vec3<double>{0, 0, 1});
         }},
    });
  expect_refused({
      {"axes", [] { SiteDependentUniaxialAnisotropy(1, Vectors()); }},
      {"axes that moved",
       [] { SiteDependentUniaxialAnisotropy(1, moved_from<Vectors>(Lattice::chain(3))); }},
      {"HostField", [] { HostField(Spins(), NoField()); }},
      {"EnergyControl", [] { EnergyControl(Spins(), generator_on(Lattice())); }},
  });
  for (auto const& [call, sentence] : std::vector<std::pair<std::function<void()>, std::string>>{
           {[] { LandauLifshitz(EffectiveField(Zeeman()), Scalars()); },
            "LandauLifshitz: the damping"},
           {[] { SiteDependentExchange{Scalars()}; }, "SiteDependentExchange: the constants"},
           {[] { FieldWithVacancies(EffectiveField(Zeeman()), Scalars()); },
            "FieldWithVacancies: the occupation"},
           {[] { SiteDependentUniaxialAnisotropy(1, Vectors()); },
            "SiteDependentUniaxialAnisotropy: the axis"},
           {[] { RigidBodyEnsemble{Tensors()}; }, "RigidBodyEnsemble: the inverse inertia"}})
    EXPECT_EQ(refusal(call), "cayspin::" + sentence + ": the field has no sites");
  for (auto const& none : {Tensors(), moved_from<Tensors>(Lattice::chain(3))}) {
    Spins spins("spins", Lattice::chain(3));
    expect_refused({{"RigidBodyEnsemble", [&] { energy(Exec(), RigidBodyEnsemble(none), spins); }},
                    {"step of RigidBodyEnsemble", [&] {
                       LieEuler(spins).step(Exec(), RigidBodyEnsemble(none), spins, 0, 0.1);
                     }}});
  }
}

TEST(WrongCallsOfTerms, NormalsWithoutDirection) {
  auto const lattice = Lattice::square(3, 3);
  for (double const wrong : {0.0, std::nan(""), HUGE_VAL})
    EXPECT_EQ(refusal([&] {
                InterfacialDmi(lattice, 1, {wrong, 0, 0});
              }),
              "cayspin::InterfacialDmi: the normal must be finite and not zero");
}

TEST(WrongCallsOfNoise, SpinsAndFactorsOfOthers) {
  for (auto const& none : {Spins(), moved_from<Spins>(Lattice::chain(3))})
    expect_refused({{"no sites", [&] { ThermalNoise(none, 0.1, {.temperature = 1}); }}});
  for (auto const& own : own_lattices)
    for (auto const& [kind, factors] : fields_of_others<Scalars>(own)) {
      SCOPED_TRACE("factors " + kind);
      Spins const spins("spins", own);
      expect_made_for_another("ThermalNoise's factors", factors.lattice(), own,
                              {{"ThermalNoise", [&] {
                                  ThermalNoise<Spins>(spins, 0.1, {.temperature = 1}, factors);
                                }}});
    }
}

TEST(WrongCallsOfTerms, SolversOnTheHost) {
  for (auto const& own : own_lattices)
    for (auto const& [kind, other] : fields_of_others<Spins>(own)) {
      SlabDemagOnHost const solver({0, 1, 0});
      Spins const spins("spins", own);
      expect_refused({{"field " + kind, [&] { solver(spins, other, 0); }},
                      {"spins " + kind, [&] { solver(other, spins, 0); }}});
    }
}

TEST(WrongCallsOfCopies, ViewsOfOtherExtents) {
  using View = Kokkos::View<double**, Kokkos::HostSpace>;
  using Borrowed =
      Kokkos::View<double* [3], Kokkos::LayoutRight, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>;
  using Strided = Kokkos::View<double**, Kokkos::LayoutStride, Kokkos::HostSpace>;
  Spins const spins("spins", Lattice::chain(5));
  std::vector<double> numbers(15);
  auto const both = [&](std::string const& name, auto const& view) -> std::vector<WrongCall> {
    return {{name + " to the field", [&, view] { copy(Exec(), view, spins); }},
            {name + " from the field", [&, view] { copy(Exec(), spins, view); }}};
  };
  expect_refused(both("a longer View", View("longer", 6, 3)));
  EXPECT_EQ(refusal(both("", View("longer", 6, 3))[0].call),
            "cayspin::copy: the View is 6 x 3, the field 5 x 3");
  expect_refused(both("a shorter View", View("shorter", 4, 3)));
  expect_refused(both("a wider View", View("wider", 5, 4)));
  expect_refused(both("a turned View", View("turned", 3, 5)));
  expect_refused(both("an empty View", View()));
  expect_refused(both("memory that is too short", Borrowed(numbers.data(), 4)));
  expect_refused(both("no memory", Borrowed(nullptr, 5)));
  expect_refused(
      both("a shorter strided View", Strided(numbers.data(), Kokkos::LayoutStride(4, 3, 3, 1))));
  expect_refused({
      {"too few numbers", [&] { copy_from_host(std::vector<double>(14), spins); }},
      {"too many numbers", [&] { copy_from_host(std::vector<float>(16), spins); }},
      {"no numbers", [&] { copy_from_host(std::vector<double>(), spins); }},
  });
}

TEST(WrongCallsOfCopies, NoField) {
  using View = Kokkos::View<double**, Kokkos::HostSpace>;
  auto const moved = moved_from<Spins>(Lattice::chain(2));
  for (auto const& none : {Spins(), moved})
    expect_refused({
        {"to the host", [&] { copy_to_host(none); }},
        {"from no numbers", [&] { copy_from_host(std::vector<double>(), none); }},
        {"from six numbers", [&] { copy_from_host(std::vector<double>(6), none); }},
        {"from no sites", [&] { copy(Exec(), View("none", 0, 3), none); }},
        {"to no sites", [&] { copy(Exec(), none, View("none", 0, 3)); }},
        {"from two sites", [&] { copy(Exec(), View("two", 2, 3), none); }},
        {"to two sites", [&] { copy(Exec(), none, View("two", 2, 3)); }},
    });
}

// Views may have any layout and any strides.
TEST(Copies, OfStridedViews) {
  Lattice const lattice = Lattice::square(4, 3);
  std::vector<double> numbers(12 * 8, -1);
  Kokkos::View<double**, Kokkos::LayoutStride, Kokkos::HostSpace> const view(
      numbers.data(), Kokkos::LayoutStride(12, 8, 3, 2));
  for (int site = 0; site < 12; ++site)
    for (int c = 0; c < 3; ++c) view(site, c) = 10 * site + c;
  Spins const spins("spins", lattice), back("back", lattice);
  copy(Exec(), view, spins);
  Exec().fence();
  for (int site = 0; site < 12; ++site) EXPECT_EQ(spins.get(site).y, 10 * site + 1);
  Kokkos::deep_copy(view, 0);
  copy(Exec(), spins, view);
  Exec().fence();
  for (int site = 0; site < 12; ++site)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(view(site, c), 10 * site + c);
  EXPECT_EQ(numbers[1], -1);
  EXPECT_EQ(numbers[7], -1);
}

// tests/lattice/validate.cpp has the invalid lattices.
TEST(WrongCallsOfLattices, NoneThatCannotBe) {
  auto const lattice = Lattice::square(-3, -1);
  expect_refused({
      {"SpinField", [&] { Spins("spins", lattice); }},
      {"ScalarField", [&] { Scalars("numbers", lattice); }},
      {"Exchange", [&] { Exchange(lattice, 1); }},
      {"InterfacialDmi", [&] { InterfacialDmi(lattice, 1); }},
      {"BulkDmi", [&] { BulkDmi(lattice, 1); }},
      {"PairCouplings", [&] { PairCouplings<Kokkos::HostSpace>(lattice, one_bond); }},
      {"ZhangLi",
       [&] {
         ZhangLi(lattice, Vec3<double>{1, 0, 0});
       }},
      {"HostField", [&] { HostField<Spins, NoField>(lattice, NoField()); }},
  });
}

// Moving leaves an empty field.
TEST(Fields, MovedAwayFrom) {
  Spins from("from", Lattice::chain(3));
  double const* const memory = from.allocation().data();
  Spins to = std::move(from);
  EXPECT_EQ(to.allocation().data(), memory);
  EXPECT_EQ(to.sites(), 3);
  EXPECT_EQ(from.sites(), 0);
  EXPECT_EQ(from.allocation().data(), nullptr);
  EXPECT_NE(from.lattice(), to.lattice());
  from = std::move(to);
  EXPECT_EQ(from.allocation().data(), memory);
  EXPECT_EQ(from.lattice(), Lattice::chain(3));
  EXPECT_EQ(to.sites(), 0);
  Spins& same = from;
  from = std::move(same);
  EXPECT_EQ(from.allocation().data(), memory);
}

}  // namespace
}  // namespace cayspin::test
