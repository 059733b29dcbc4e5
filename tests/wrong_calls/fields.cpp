// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Everything but steppers that takes a field made elsewhere: copies, sums, terms, observers.
#include "wrong_calls.hpp"

#include <limits>

namespace cayspin::test {
namespace {

using Vectors = SiteField<double, 3, Kokkos::HostSpace>;
using Tensors = SiteField<double, 6, Kokkos::HostSpace>;

struct NoField {
  static constexpr int degree = 2;
  void operator()(Spins const&, Spins const&, double) const {}
};

/// Spins with a term or generator of another lattice, or the other way round.
template <class Source>
std::vector<WrongCall> sums_of(std::string const& what, Source const& source, Spins const& spins) {
  return {{what + ", energy", [=] { energy(Exec(), source, spins); }},
          {what + ", term_energies", [=] { term_energies(Exec(), source, spins); }},
          {what + ", sample", [=] { sample(Exec(), source, {}, spins); }},
          {what + ", Record", [=] {
             std::vector<Sample> samples;
             Record(source, samples)(Exec(), Step{}, spins);
           }}};
}
template <class Generator>
std::vector<WrongCall> all_of(std::string const& what, Generator const& generator,
                              Spins const& spins) {
  auto calls = sums_of(what, generator, spins);
  calls.push_back({what + ", largest_rate", [=] { largest_rate(Exec(), generator, spins); }});
  calls.push_back(
      {what + ", rate of a sample", [=] { sample(Exec(), Zeeman(), {}, spins, generator); }});
  calls.push_back({what + ", evaluate_generator", [=] {
                     Spins output = spins;
                     if (spins.sites() != 0) output = Spins("output", spins.lattice());
                     evaluate_generator(Exec(), generator, spins, 0, output);
                   }});
  return calls;
}
template <class Term>
std::vector<WrongCall> all_of_term(std::string const& what, Term const& term, Spins const& spins) {
  auto calls = sums_of(what, term, spins);
  calls.push_back({what + ", evaluate_field", [=] {
                     Spins output = spins;
                     if (spins.sites() != 0) output = Spins("output", spins.lattice());
                     evaluate_field(Exec(), term, spins, 0, output);
                   }});
  return calls;
}

TEST(WrongCallsOfSums, SpinsOfOthers) {
  for (auto const& own : own_lattices)
    for (auto const& [kind, spins] : fields_of_others<Spins>(own)) {
      expect_refused(all_of("spins " + kind, generator_on(own), spins));
      expect_refused(all_of_term("Exchange, spins " + kind, Exchange(own, 1), spins));
      expect_refused(all_of_term("InterfacialDmi, spins " + kind, InterfacialDmi(own, 1), spins));
      expect_refused(all_of_term("BulkDmi, spins " + kind, BulkDmi(own, 1), spins));
      expect_refused(all_of_term("Biquadratic, spins " + kind, Biquadratic(own, 1), spins));
      expect_refused(all_of_term("ZhangLi, spins " + kind, ZhangLi(own, {1, 1, 1}), spins));
      expect_refused(all_of_term("LayerAveragedSlabDemag, spins " + kind,
                                 LayerAveragedSlabDemag<Kokkos::HostSpace>(own, 1), spins));
      expect_refused(
          all_of_term("HostField, spins " + kind, HostField(Spins("like", own), NoField()), spins));
    }
}

TEST(WrongCallsOfSums, NoSpinsAtAll) {
  for (auto const& [kind, spins] : {std::pair("default-constructed", Spins()),
                                    std::pair("moved from", moved_from<Spins>(Lattice::chain(9)))})
    expect_refused({
        {std::string(kind) + ", norm_defect", [&] { norm_defect(Exec(), spins); }},
        {std::string(kind) + ", magnetization", [&] { magnetization(Exec(), spins); }},
        {std::string(kind) + ", magnetization, weighted",
         [&] { magnetization(Exec(), spins, Scalars()); }},
        {std::string(kind) + ", require_unit_spins", [&] { require_unit_spins(Exec(), spins); }},
        {std::string(kind) + ", normalize", [&] { normalize(Exec(), spins); }},
        {std::string(kind) + ", Normalize", [&] { Normalize()(Exec(), Step{}, spins); }},
        {std::string(kind) + ", energy", [&] { energy(Exec(), Zeeman(), spins); }},
        {std::string(kind) + ", sample", [&] { sample(Exec(), Zeeman(), {}, spins); }},
        {std::string(kind) + ", evaluate_field",
         [&] { evaluate_field(Exec(), Zeeman(), spins, 0, spins); }},
    });
}

TEST(WrongCallsOfSums, OutputsAndWeightsOfOthers) {
  for (auto const& own : own_lattices) {
    Spins const spins("spins", own), same = spins;
    auto const generator = generator_on(own);
    for (auto const& [kind, output] : fields_of_others<Vectors>(own))
      expect_refused(
          {{"output " + kind, [&] { evaluate_field(Exec(), Zeeman(), spins, 0, output); }},
           {"output of a generator " + kind,
            [&] { evaluate_generator(Exec(), generator, spins, 0, output); }}});
    for (auto const& [kind, weights] : fields_of_others<Scalars>(own))
      expect_refused({{"weights " + kind, [&] { magnetization(Exec(), spins, weights); }}});
    expect_refused(
        {{"the spins as output", [&] { evaluate_field(Exec(), Zeeman(), spins, 0, same); }},
         {"the spins as output of a generator",
          [&] { evaluate_generator(Exec(), generator, spins, 0, same); }}});
  }
}

TEST(WrongCallsOfTerms, CoefficientsOfOthers) {
  for (auto const& own : own_lattices) {
    Spins const spins("spins", own);
    for (auto const& [kind, numbers] : fields_of_others<Scalars>(own)) {
      std::string const of = ", numbers " + kind;
      auto const use = [&](auto const& make) {
        return [&] { energy(Exec(), make(numbers), spins); };
      };
      expect_refused({
          {"SiteDependentExchange" + of,
           use([](auto const& n) { return SiteDependentExchange(n); })},
          {"SiteDependentUniaxialAnisotropy" + of, use([](auto const& n) {
             return SiteDependentUniaxialAnisotropy(n, Vec3<double>{0, 0, 1});
           })},
          {"FieldWithVacancies" + of,
           use([](auto const& n) { return FieldWithVacancies(EffectiveField(Zeeman()), n); })},
          {"LandauLifshitz" + of,
           use([](auto const& n) { return LandauLifshitz(EffectiveField(Zeeman()), n); })},
          {"a part of a sum" + of,
           use([](auto const& n) { return EffectiveField(Zeeman(), SiteDependentExchange(n)); })},
          {"orthogonal" + of, use([](auto const& n) {
             return orthogonal(LandauLifshitz(EffectiveField(Zeeman()), n));
           })},
      });
    }
    Scalars const occupation("occupation", own, 1);
    for (auto const& [kind, other] : fields_of_others<Spins>(own)) {
      if (other.sites() == 0) continue;
      FieldWithVacancies const field(EffectiveField(Exchange(other.lattice(), 1)), occupation);
      expect_refused({{"vacancies around a term " + kind, [&] { energy(Exec(), field, spins); }}});
    }
    for (auto const& [kind, axes] : fields_of_others<Spins>(own))
      expect_refused({{"axes " + kind, [&] {
                         energy(Exec(), SiteDependentUniaxialAnisotropy(1, Vectors(axes)), spins);
                       }}});
    for (auto const& [kind, tensors] : fields_of_others<Tensors>(own))
      expect_refused({{"RigidBodyEnsemble " + kind,
                       [&] { energy(Exec(), RigidBodyEnsemble(tensors), spins); }},
                      {"step of RigidBodyEnsemble " + kind, [&] {
                         auto moving = spins;
                         LieEuler(moving).step(Exec(), RigidBodyEnsemble(tensors), moving, 0, 0.1);
                       }}});
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
      {"HostField", [] { HostField(Spins(), NoField()); }},
      {"EnergyControl", [] { EnergyControl(generator_on(Lattice()), Spins()); }},
  });
}

TEST(WrongCallsOfTerms, SolversOnTheHost) {
  for (auto const& own : own_lattices)
    for (auto const& [kind, other] : fields_of_others<Spins>(own))
      for (bool const layers : {false, true}) {
        SlabDemagOnHost const solver({0, 1, 0}, 1, layers);
        Spins const spins("spins", own);
        expect_refused({{"field " + kind, [&] { solver(spins, other, 0); }},
                        {"spins " + kind, [&] { solver(other, spins, 0); }}});
      }
}

TEST(WrongCallsOfObservers, SpinsOfOthers) {
  for (auto const& own : own_lattices)
    for (auto const& [kind, spins] : fields_of_others<Spins>(own)) {
      EnergyControl control(generator_on(own), Spins("like", own));
      expect_refused({{"EnergyControl, spins " + kind, [&] {
                         control(Exec(), Step{0, 0, 0.1, false}, spins);
                       }}});
      if (spins.sites() == 0) continue;
      EnergyControl other(generator_on(spins.lattice()), Spins("like", own));
      expect_refused({{"EnergyControl, generator " + kind, [&] {
                         other(Exec(), Step{0, 0, 0.1, false}, Spins("spins", own));
                       }}});
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

// Every layout of a View is right, whatever its strides.
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

TEST(WrongCallsOfLattices, NoneThatCannotBe) {
  double const none = std::numeric_limits<double>::quiet_NaN();
  for (auto const& [name, lattice] :
       {std::pair("no sites along x", Lattice::chain(0)),
        std::pair("no sites along z", Lattice::cubic(2, 2, 0)),
        std::pair("negative extent", Lattice::square(3, -1)),
        std::pair("two negative extents", Lattice::square(-3, -1)),
        std::pair("too many sites", Lattice::cubic(1 << 28, 1 << 28, 1 << 28)),
        std::pair("no spacing", Lattice::chain(3, 0)),
        std::pair("a spacing that is no number", Lattice::chain(3, none))})
    expect_refused({
        {std::string(name) + ", SpinField", [&] { Spins("spins", lattice); }},
        {std::string(name) + ", ScalarField", [&] { Scalars("numbers", lattice); }},
        {std::string(name) + ", Exchange", [&] { Exchange(lattice, 1); }},
        {std::string(name) + ", InterfacialDmi", [&] { InterfacialDmi(lattice, 1); }},
        {std::string(name) + ", BulkDmi", [&] { BulkDmi(lattice, 1); }},
        {std::string(name) + ", Biquadratic", [&] { Biquadratic(lattice, 1); }},
        {std::string(name) + ", ZhangLi",
         [&] {
           ZhangLi(lattice, {1, 0, 0});
         }},
        {std::string(name) + ", LayerAveragedSlabDemag",
         [&] { LayerAveragedSlabDemag<Kokkos::HostSpace>(lattice, 0); }},
        {std::string(name) + ", HostField", [&] { HostField<Spins, NoField>(lattice, NoField()); }},
    });
}

// What is moved away leaves an empty field.
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
