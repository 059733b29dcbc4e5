// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/wrong_call.hpp"

#include <cayspin/cayspin.hpp>

#include <string>
#include <utility>
#include <vector>

namespace cayspin::test {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Spins = SpinField<double, Kokkos::HostSpace>;
using Scalars = ScalarField<double, Kokkos::HostSpace>;

template <class Field>
Field moved_from(Lattice const& lattice) {
  Field field("moved", lattice);
  Field const other = std::move(field);
  return field;
}

/// Returns lattices that differ from this one: in the number of sites, in the shape with equally
/// many sites, in boundaries, and in spacings.
inline std::vector<std::pair<std::string, Lattice>> lattices_of_others(Lattice const& own) {
  auto wider = own, turned = own, closed = own, coarser = own;
  wider.shape[0] += 1;
  std::swap(turned.shape[0], turned.shape[1]);
  closed.boundary[1] = Boundary::periodic;
  coarser.spacing[2] = 2;
  std::vector<std::pair<std::string, Lattice>> lattices{
      {"of another shape", wider}, {"of other boundaries", closed}, {"of other spacings", coarser}};
  if (turned != own) lattices.emplace_back("of as many sites in another shape", turned);
  return lattices;
}

/// Returns fields on lattices_of_others(own), and empty ones: default-constructed and moved from.
template <class Field>
std::vector<std::pair<std::string, Field>> fields_of_others(Lattice const& own) {
  std::vector<std::pair<std::string, Field>> fields{{"default-constructed", Field()},
                                                    {"moved from", moved_from<Field>(own)}};
  for (auto const& [kind, lattice] : lattices_of_others(own))
    fields.emplace_back(kind, Field("other", lattice));
  return fields;
}

/// A rectangle, and the default-constructed Lattice: a single site, unlike the lattice of an empty
/// field, which has none.
inline std::vector<Lattice> const own_lattices{Lattice::square(6, 4), Lattice()};

/// Expects each call to be refused, because `who` was made for another lattice than the spins.
inline void expect_made_for_another(std::string const& who, Lattice const& made_for,
                                    Lattice const& of_spins, std::vector<WrongCall> const& calls) {
  auto const sites = [](Lattice const& lattice) {
    auto const& n = lattice.shape;
    return std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]);
  };
  auto const sentence = "cayspin::" + who + ": made for a lattice of " +
                        (made_for.shape == of_spins.shape
                             ? "other spacings or boundaries than that of the spins"
                             : sites(made_for) + " sites, and the spins are on " + sites(of_spins));
  for (auto const& [name, call] : calls) EXPECT_EQ(refusal(call), sentence) << name;
}

/// Returns a conservative generator that couples sites.
inline auto generator_on(Lattice const& lattice) {
  return LandauLifshitz(EffectiveField(Exchange(lattice, 1), Zeeman{{0.3, 0, 1}}), 0);
}
using Generator = decltype(generator_on(Lattice()));

}  // namespace cayspin::test
