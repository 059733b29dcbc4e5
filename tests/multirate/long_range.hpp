// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <cayspin/field/slow_field.hpp>
#include <cayspin/stepper/multirate.hpp>

#include <cmath>
#include <cstdint>

namespace cayspin::test {

/// H_i = -strength * sum_j e^(-|i-j|/2) D m_j with D = diag(1, 0.6, 0.2), over sites in memory
/// order. The eigenvalues of this map are between -4.1 * strength and 0.
struct LongRange {
  static constexpr int degree = 2;
  double strength = 0;

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    using Real = typename HostSpins::value_type;
    double const decay = std::exp(-0.5);
    std::int64_t const sites = spins.sites();
    auto const at = [&](std::int64_t i) {
      auto const m = spins.get(i);
      return Vector{double(m.x), 0.6 * double(m.y), 0.2 * double(m.z)};
    };
    // Sums over the sites before a site, and over those after it: each sum follows from that of the
    // neighbouring site.
    std::vector<Vector> before(static_cast<std::size_t>(sites), Vector{0, 0, 0});
    for (std::int64_t i = 1; i < sites; ++i) before[i] = decay * (before[i - 1] + at(i - 1));
    Vector after{0, 0, 0};
    for (std::int64_t i = sites - 1; i >= 0; --i) {
      if (i + 1 < sites) after = decay * (after + at(i + 1));
      Vector const h = -strength * (before[i] + at(i) + after);
      field.set(i, {static_cast<Real>(h.x), static_cast<Real>(h.y), static_cast<Real>(h.z)});
    }
  }
};

template <class Field>
using MultirateLongRange = SlowField<Field, HostField<Field, LongRange>>;

template <class Field>
MultirateLongRange<Field> multirate_long_range(Field const& like, double strength) {
  return {like, HostField<Field, LongRange>(like, LongRange{strength})};
}

/// A uniform field that rotates about z.
struct Turning {
  double amplitude = 0;
  Vector operator()(double t) const {
    return {amplitude * std::cos(2 * t), amplitude * std::sin(2 * t), 0.3};
  }
};

/// Returns a generator with terms of every kind, one of which is expensive.
template <class SlowTerm>
auto with_multirate(Lattice const& lattice, double exchange, SlowTerm const& slow, double damping,
                    double amplitude = 0) {
  return LandauLifshitz{
      EffectiveField{Exchange{lattice, exchange}, UniaxialAnisotropy{0.4, Vector{1, 2, 3}}, slow,
                     TimeDependentZeeman{Turning{amplitude}}},
      damping};
}

template <int Order = 3, class Field, class Inner = Rkmk4<Field>>
auto multirate(Field const& like, MultirateLongRange<Field> const& slow, std::int64_t substeps) {
  return Multirate<Inner, MultirateLongRange<Field>, Order>(like, Inner(like), slow,
                                                            {.substeps = substeps});
}

}  // namespace cayspin::test
