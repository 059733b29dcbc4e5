// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/solver/alternating_signs.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// What a minimiser wants to know of a field of which it knows nothing: how strong the exchange is
// along each axis, how strong the rest is, and which spins it leaves alone.
namespace cayspin::inline v0_1::detail {

/// The same direction everywhere, or reversed from site to site.
template <class Real>
struct AlternateSpins {
  AlternatingSigns signs;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    // In no plane of symmetry.
    Vec3<Value> const m{Value(Real(0.26726124)), Value(Real(0.53452248)), Value(Real(0.80178373))};
    site.store(signs.template at<Value>(site) * m, output);
  }
};

/// Components of random sign, and of sizes that differ by up to `scatter`: a direction in no
/// symmetry, another for each `stream`.
template <class Real>
struct RandomSigns {
  std::int64_t nx, ny, stream;
  Real scatter;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    constexpr int lanes = lanes_of<Value>;
    Real signs[3][std::size_t{lanes}];
    auto const first =
        static_cast<std::uint64_t>((std::int64_t(site.z()) * ny + site.y()) * nx + site.x()) +
        (static_cast<std::uint64_t>(stream) << 40U);
    for (int lane = 0; lane < lanes; ++lane) {
      std::uint64_t const bits = mixed(first + static_cast<std::uint64_t>(lane));
      for (int c = 0; c < 3; ++c)
        signs[c][lane] = Real((bits >> (20 + c)) & 1U ? 0.57735027 : -0.57735027) *
                         (1 + scatter * Real(0x1p-16) * Real(bits >> (16 * c) & 0xffffU));
    }
    Vec3<Value> const v{load<Value>(signs[0]), load<Value>(signs[1]), load<Value>(signs[2])};
    site.store(v, output);
  }

 private:
  // The finaliser of MurmurHash3.
  KOKKOS_FORCEINLINE_FUNCTION static std::uint64_t mixed(std::uint64_t n) {
    n = (n + 1) * 0x9E3779B97F4A7C15U;
    n = (n ^ (n >> 33U)) * 0xFF51AFD7ED558CCDU;
    n = (n ^ (n >> 33U)) * 0xC4CEB9FE1A85EC53U;
    return n ^ (n >> 33U);
  }
};

/// m.H and |H|^2; keeps 1 where H is not zero, and finds where it never was.
template <class Field, class Real>
struct FieldAlongSpins {
  Field field;
  SiteArray<Real, 3> spins;
  SiteArray<Real, 1> moves;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, spins);
    check_field<Field, Stencil<Site, Real>>();
    Vec3<Value> const h = field.field(stencil);
    values[0] = dot(stencil.center(), h);
    values[1] = dot(h, h);
    Value const before = site.load(moves);
    Value const now = select<Value>(values[1] == Value(0.0), before, Value(1.0));
    values[2] = Value(1.0) - now;
    store_narrowed(now, moves.data + site.offset());
  }
};

/// What is found.
struct FieldStrengths {
  /// Mean J of a bond along each axis: H = J (m' - m). Those below zero are left out where an odd
  /// ring keeps spins from alternating: they lie in no pattern that is known beforehand.
  std::array<double, 3> couplings{};
  double rest = 0;  ///< the root mean square of |H| of spins that are parallel
  int evaluations = 0;

  /// About the largest |H|.
  double strongest() const {
    double sum = rest;
    for (double const coupling : couplings) sum += 4 * std::abs(coupling);
    return sum;
  }
};

/// Evaluates the field for parallel spins and for spins that alternate along each axis. `spins` is
/// overwritten. `moves` becomes 1 where there was a field, and stays where there was none.
template <class Exec, class Field, class Spins>
FieldStrengths probe(
    Exec const& exec, Field const& field, double time, Spins const& spins,
    ScalarField<typename Spins::value_type, typename Spins::memory_space> const& moves) {
  using Real = typename Spins::value_type;
  auto const& lattice = spins.lattice();
  FieldStrengths found;
  auto const look = [&](auto const& pattern) {
    for_each_site<Real>(exec, "cayspin::minimize::pattern", spins.layout(), pattern);
    auto prepared = prepare_term(field, exec, spins, time);
    ++found.evaluations;
    return reduce_sites<SumsThenMaxima<2>, 3>(
        exec, "cayspin::minimize::probe", spins.layout(),
        FieldAlongSpins<decltype(prepared), Real>{std::move(prepared), spins.array(),
                                                  moves.array()});
  };
  auto const look_at = [&](AlternatingSigns const& signs) {
    return look(AlternateSpins<Real>{signs, spins.output(false)});
  };
  auto const parallel = look_at({});
  double rests = parallel[2];
  bool is_frustrated = false;
  found.rest = std::sqrt(parallel[1] / static_cast<double>(lattice.sites()));
  for (int axis = 0; axis < 3; ++axis) {
    if (!lattice.has_neighbors(axis)) continue;
    auto const i = static_cast<std::size_t>(axis);
    // Each bond between opposite spins takes 4 J from the sum of m.H.
    double const bonds = opposed_bonds(lattice, axis);
    auto const opposed = look_at(AlternatingSigns::along_axis(axis));
    rests = opposed[2];
    double const coupling = (parallel[0] - opposed[0]) / (4 * bonds);
    bool const is_noise = !(4 * bonds * std::abs(coupling) > 1e-5 * std::abs(parallel[0]));
    found.couplings[i] = is_noise || !std::isfinite(coupling) ? 0 : coupling;
    bool const is_odd_ring = lattice.boundary[i] == Boundary::periodic && lattice.shape[i] % 2 == 1;
    is_frustrated = is_frustrated || (is_odd_ring && found.couplings[i] < 0);
  }
  if (is_frustrated)
    for (double& coupling : found.couplings) coupling = std::max(0.0, coupling);
  if (rests > 0)
    look(RandomSigns<Real>{lattice.shape[0], lattice.shape[1], 0, 0, spins.output(false)});
  return found;
}

}  // namespace cayspin::inline v0_1::detail
