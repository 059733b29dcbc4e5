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

// Measures an unknown field for a minimiser: the strength of exchange along each axis, the strength
// of the rest, and which spins see no field.
namespace cayspin::inline v0_2::detail {

/// Functor that sets all spins to one of three directions at right angles, reversed on sites where
/// `signs` are negative.
template <class Real>
struct AlternateSpins {
  AlternatingSigns signs;
  Vec3<Real> direction;
  OutputArray<Real, 3> output;

  /// `which`: 0 to 2. The first direction is in no plane of symmetry.
  AlternateSpins(AlternatingSigns const& signs_of_sites, int which, OutputArray<Real, 3> const& to)
      : signs(signs_of_sites), output(to) {
    constexpr Real directions[3][3] = {{Real(0.26726124), Real(0.53452248), Real(0.80178373)},
                                       {Real(0.87287156), Real(0.21821789), Real(-0.43643578)},
                                       {Real(-0.40824829), Real(0.81649658), Real(-0.40824829)}};
    auto const& [x, y, z] = directions[which];
    direction = {x, y, z};
  }

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const m{Value(direction.x), Value(direction.y), Value(direction.z)};
    site.store(signs.template at<Value>(site) * m, output);
  }
};

/// Functor that sets vectors without symmetry: their components have random signs, and sizes that
/// differ by up to a factor of 1 + scatter. Each `stream` gives different vectors.
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
  // The finaliser of MurmurHash3, after a multiplication.
  KOKKOS_FORCEINLINE_FUNCTION static std::uint64_t mixed(std::uint64_t n) {
    n = (n + 1) * 0x9E3779B97F4A7C15U;
    n = (n ^ (n >> 33U)) * 0xFF51AFD7ED558CCDU;
    n = (n ^ (n >> 33U)) * 0xC4CEB9FE1A85EC53U;
    return n ^ (n >> 33U);
  }
};

/// Functor that copies the pattern on sites that hold a spin, and sets the zero vector on vacant
/// ones.
template <class Real>
struct WithoutVacancies {
  SiteArray<Real, 3> spins, pattern;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const m = site.load(spins), p = site.load(pattern);
    site.store(select<Value>(dot(m, m) == Value(0), m, p), output);
  }
};

/// Functor that computes sums over the occupied sites of a pattern, whose vacant sites hold the
/// zero vector. Sets is_mobile to 1 on occupied sites where H is not 0, and finds whether any
/// occupied site has seen no field yet.
template <class Field, class Real>
struct FieldAlongSpins {
  enum { along, along_square, square, sites, opposed_neighbors, rests, values };
  using Combine = SumsThenMaxima<rests>;

  Field field;
  SiteArray<Real, 3> spins;
  SiteArray<Real, 1> is_mobile;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* found) const {
    Stencil<Site, Real> const stencil(site, spins);
    check_field<Field, Stencil<Site, Real>>();
    Vec3<Value> const h = field.field(stencil);
    auto const& m = stencil.center();
    Value const none(0.0), one(1.0);
    Value const occupied = select<Value>(dot(m, m) == none, none, one);
    found[along] = dot(m, h);
    found[along_square] = found[along] * found[along];
    found[square] = occupied * dot(h, h);
    found[sites] = occupied;
    found[opposed_neighbors] = opposed<0>(stencil) + opposed<1>(stencil) + opposed<2>(stencil);
    Value const before = site.load(is_mobile);
    Value const now = select<Value>(found[square] == none, before, one);
    found[rests] = occupied - now;
    store_narrowed(now, is_mobile.data + site.offset());
  }

 private:
  template <int Axis, class AnyStencil>
  KOKKOS_FORCEINLINE_FUNCTION static auto opposed(AnyStencil const& stencil) {
    using Value = typename AnyStencil::value_type;
    Value const none(0.0), half(0.5);
    auto const& m = stencil.center();
    return Value(select<Value>(dot(m, stencil.template previous<Axis>()) < none, half, none) +
                 select<Value>(dot(m, stencil.template next<Axis>()) < none, half, none));
  }
};

/// Measured strengths of a field.
struct FieldStrengths {
  /// Mean J of a bond along each axis: H = J * (m' - m). All negative J are replaced by 0 if any
  /// periodic axis has an odd number of sites and a negative J. Spins cannot alternate there, and
  /// the pattern of their order is not known beforehand.
  std::array<double, 3> couplings{};
  double rest = 0;  ///< root mean square of |H| without exchange, for parallel spins
  int evaluations = 0;

  /// Returns an estimate of the largest |H|.
  double strongest() const {
    double sum = rest;
    for (double const coupling : couplings) sum += 4 * std::abs(coupling);
    return sum;
  }
};

/// Returns the mean |H|^2 of parallel spins without exchange. `square`, `along_square`, `along`:
/// sums of |H|^2, (m.H)^2 and m.H over `sites` sites. Couplings H = J * m' give parallel spins a
/// field along m, which turns no spin; couplings H = J * (m' - m) give no field. So if H looks like
/// a field of the former kind, that field is subtracted. `isotropic`: the sum of m.H that couplings
/// of the former kind would give.
inline double rest_of_parallel(double square, double along_square, double along, double isotropic,
                               double sites) {
  bool const is_along = square - along_square < 0.1 * square;
  if (!is_along || !(std::abs(along - isotropic) < 0.5 * std::abs(isotropic)))
    return square / sites;
  double const j = isotropic / sites;
  return std::max(0.0, square - 2 * j * along + j * j * sites) / sites;
}

/// Evaluates the field for parallel spins and for spins that alternate along each axis in turn, on
/// occupied sites: where `spins` is not the zero vector. Overwrites `pattern`. If some spins have
/// seen no field so far, also evaluates the field for random spins. Sets `is_mobile`, which must be
/// 0 before, to 1 where a spin sees a field. Waits.
template <class Exec, class Field, class Spins>
FieldStrengths probe(
    Exec const& exec, Field const& field, double time, Spins const& spins, Spins const& pattern,
    ScalarField<typename Spins::value_type, typename Spins::memory_space> const& is_mobile) {
  using Real = typename Spins::value_type;
  auto const& lattice = spins.lattice();
  FieldStrengths found;
  auto const sample = [&](auto const& make_pattern) {
    for_each_site<Real>(exec, "cayspin::minimize::pattern", spins.layout(), make_pattern);
    for_each_site<Real>(
        exec, "cayspin::minimize::without_vacancies", spins.layout(),
        WithoutVacancies<Real>{spins.array(), pattern.array(), pattern.output(false)});
    auto prepared = prepare_term(field, exec, pattern, time);
    ++found.evaluations;
    using Sample = FieldAlongSpins<decltype(prepared), Real>;
    return reduce_sites<typename Sample::Combine, Sample::values>(
        exec, "cayspin::minimize::probe", spins.layout(),
        Sample{std::move(prepared), pattern.array(), is_mobile.array()});
  };
  using Sample = FieldAlongSpins<decltype(prepare_term(field, exec, pattern, time)), Real>;
  auto const sample_at = [&](AlternatingSigns const& signs, int direction = 0) {
    return sample(AlternateSpins<Real>(signs, direction, pattern.output(false)));
  };
  auto const parallel = sample_at({});
  double rests = parallel[Sample::rests];
  bool is_frustrated = false;
  double isotropic = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!lattice.has_neighbors(axis)) continue;
    auto const i = static_cast<std::size_t>(axis);
    auto const opposed = sample_at(AlternatingSigns::along_axis(axis));
    rests = opposed[Sample::rests];
    // Each bond between opposite spins lowers the sum of m.H by 4 * J.
    double const bonds = opposed[Sample::opposed_neighbors];
    double const difference = parallel[Sample::along] - opposed[Sample::along];
    double const coupling = difference / (4 * bonds);
    bool const is_noise = !(std::abs(difference) > 1e-5 * std::abs(parallel[Sample::along]));
    found.couplings[i] = is_noise || !std::isfinite(coupling) ? 0 : coupling;
    isotropic += 2 * bonds * found.couplings[i];
    bool const is_odd_ring = lattice.boundary[i] == Boundary::periodic && lattice.shape[i] % 2 == 1;
    is_frustrated = is_frustrated || (is_odd_ring && found.couplings[i] < 0);
  }
  auto const rest_of = [&](auto const& of_parallel) {
    return rest_of_parallel(of_parallel[Sample::square], of_parallel[Sample::along_square],
                            of_parallel[Sample::along], isotropic,
                            std::max(1.0, of_parallel[Sample::sites]));
  };
  found.rest = std::sqrt(rest_of(parallel));
  // An anisotropy has no field where the first direction is normal to its axis. Without exchange,
  // there is nothing to compare the field with.
  bool const is_alone = std::ranges::all_of(found.couplings, [](double J) { return J == 0; });
  if (is_alone || found.rest <= 1e-4 * found.strongest()) {
    double mean = found.rest * found.rest / 3;
    for (int const direction : {1, 2}) {
      auto const other = sample_at({}, direction);
      rests = other[Sample::rests];
      mean += rest_of(other) / 3;
    }
    found.rest = std::sqrt(mean);
  }
  if (is_frustrated)
    for (double& coupling : found.couplings) coupling = std::max(0.0, coupling);
  if (rests > 0)
    sample(RandomSigns<Real>{lattice.shape[0], lattice.shape[1], 0, 0, pattern.output(false)});
  return found;
}

}  // namespace cayspin::inline v0_2::detail
