// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The field in two parts: what comes from other spins, and what does not.
#include "../support/coefficients.hpp"
#include "../support/evaluate.hpp"
#include "rotating_slab.hpp"

#include <cayspin/field/field_of_moments.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double t = 0.3;
Lattice const block{
    {11, 4, 3}, {1, 1.1, 0.9}, {Boundary::periodic, Boundary::open, Boundary::open}};

template <class Number>
auto numbers(Number const& number) {
  return numbers_on<Spins>(block, number);
}

/// The neighbour field; or by how much A x m, with A made of both parts, is off.
template <class Generator, class Local>
struct Parts {
  Generator generator;
  Local local;
  bool difference;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto field(Stencil const& stencil) const {
    using Site = std::remove_cvref_t<decltype(stencil.site())>;
    detail::SpinAlone<Site> const spin(stencil.site(), stencil.center());
    auto const h = detail::neighbor_field_of(generator, stencil);
    if (!difference) return h;
    auto const a = detail::generator_at(local, spin, h);
    return cross(generator(stencil) - a, stencil.center());
  }
};

template <class Generator>
void expect_parts(char const* what, Generator const& generator, bool has_neighbors = true) {
  Space const exec;
  Spins const spins = random_spins(block, 7);
  auto const prepared = detail::prepare_term(generator, exec, spins, t);
  auto const local = detail::prepare_local(generator, exec, spins, t);
  double largest = 0;
  for (double const off : evaluated(exec, Parts{prepared, local, true}, spins))
    largest = std::max(largest, std::abs(off));
  EXPECT_LT(largest, 2e-15) << what;

  // A spin's own direction is in no part of its neighbour field.
  Parts const neighbor_field{prepared, local, false};
  auto const before = evaluated(exec, neighbor_field, spins);
  EXPECT_EQ(before != std::vector<double>(before.size(), 0), has_neighbors) << what;
  for (std::int64_t const site : {0, 5, 10, 60, 131}) {
    auto turned = copy_to_host(spins);
    for (int c = 0; c < 3; ++c) turned[3 * site + c] = c == 1;
    Spins other("other", block);
    copy_from_host(turned, other);
    auto const after = evaluated(exec, neighbor_field, other);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(after[3 * site + c], before[3 * site + c]) << what;
  }
}

TEST(LocalPart, AndNeighborFieldMakeUpTheWhole) {
  auto const constants = numbers([](auto site) { return 0.3 + 0.1 * (site % 5); });
  auto const occupation = numbers([](auto site) { return site % 6 == 1 ? 0 : 1; });
  SiteDependentUniaxialAnisotropy const axes(0.7, random_spins(block, 2));
  TimeDependentZeeman const applied(Rotating{0.6, {0.1, 0.2, 0.3}});
  EffectiveField const uniform(Exchange(block, 0.7), UniaxialAnisotropy(0.8, {1, 2, 3}),
                               SlabDemag({1, 0, 0}, 0.5), applied);
  expect_parts("every term", LandauLifshitz(uniform, 0.3));
  expect_parts("orthogonal, overdamped", orthogonal(LandauLifshitz(uniform, 0.3, false)));
  EffectiveField const sites(axes, SiteDependentExchange(constants), Zeeman{{0, 1, 0}});
  expect_parts("coefficients of each site", LandauLifshitz(sites, constants));
  expect_parts("vacancies", LandauLifshitz(FieldWithVacancies(sites, occupation), 0.3));
  FieldOfMoments const of_moments(sites, CellMoments<Spins::memory_space>(block, {2}));
  expect_parts("moments", LandauLifshitz(of_moments, 0.3));
  expect_parts("local", LandauLifshitz(EffectiveField(axes, applied), 0.3), false);
  expect_parts("exchange alone", LandauLifshitz(Exchange(block, 0.7), 0.3));
  expect_parts("rigid bodies", orthogonal(RigidBody::principal(1, 2, 3)), false);
}

/// Counts its calls, and returns H = m / 2.
struct Solver {
  static constexpr int degree = 2;
  int* calls;
  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double) const {
    ++*calls;
    for (std::int64_t site = 0; site < spins.sites(); ++site)
      field.set(site, 0.5 * spins.get(site));
  }
};

// A term that says nothing is extrapolated, and not asked for its local part.
TEST(LocalPart, OfANonlocalFieldIsNone) {
  int calls = 0;
  LandauLifshitz const generator(
      EffectiveField(HostField<Spins, Solver>(block, Solver{&calls}), Exchange(block, 0.7),
                     UniaxialAnisotropy(0.8, {1, 2, 3})),
      0.1);
  LandauLifshitz const without(
      EffectiveField(Exchange(block, 0.7), UniaxialAnisotropy(0.8, {1, 2, 3})), 0.1);
  Spins const start = random_spins(block, 3);
  Spins spins = copy_of(start);
  FieldExtrapolation3 stepper(spins);
  advance(stepper, generator, spins, 0.01, 10);
  EXPECT_EQ(calls, 2 * 5 + 8);
  // A field along the spins moves nothing, but for what it is off when predicted.
  double const apart =
      largest_distance(spins, run<FieldExtrapolation3<Spins>>(without, start, 0.01, 10));
  EXPECT_GT(apart, 1e-12);
  EXPECT_LT(apart, 1e-5);
}

}  // namespace
