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

/// Every field that is not of this lattice: another shape, as many sites in another shape, other
/// boundaries and spacings, and none at all.
template <class Field>
std::vector<std::pair<std::string, Field>> fields_of_others(Lattice const& lattice) {
  auto const on = [](Lattice const& other) { return Field("other", other); };
  auto wider = lattice, turned = lattice, closed = lattice, coarser = lattice;
  wider.shape[0] += 1;
  std::swap(turned.shape[0], turned.shape[1]);
  closed.boundary[1] = Boundary::periodic;
  coarser.spacing[2] = 2;
  std::vector<std::pair<std::string, Field>> fields{{"of another shape", on(wider)},
                                                    {"of other boundaries", on(closed)},
                                                    {"of other spacings", on(coarser)},
                                                    {"default-constructed", Field()},
                                                    {"moved from", moved_from<Field>(lattice)}};
  if (turned != lattice) fields.emplace_back("of as many sites in another shape", on(turned));
  return fields;
}

/// A default-constructed Lattice is a single site, so that this is the lattice of an empty field
/// which nobody tells apart.
inline std::vector<Lattice> const own_lattices{Lattice::square(6, 4), Lattice()};

/// Conservative, and couples sites.
inline auto generator_on(Lattice const& lattice) {
  return LandauLifshitz(EffectiveField(Exchange(lattice, 1), Zeeman{{0.3, 0, 1}}), 0);
}
using Generator = decltype(generator_on(Lattice()));

}  // namespace cayspin::test
