// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "follow.hpp"

#include "ranks.hpp"
#include "space.hpp"

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/observer/topological_charge.hpp>
#include <cayspin/stencil.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace cayspin::simulation {

/// Functor that sums a component over all spins, over those at the first position along the axis
/// and over those at the last one, and counts the spins.
template <class Real>
struct WallOfSites {
  cayspin::SiteArray<Real, 3> spins;
  cayspin::SiteArray<Real, 1> places;
  Vec3<double> component;
  double end;  // last position

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    using cayspin::detail::select;
    Vec3<Value> const m = site.load(spins);
    Value const place = site.load(places), none(0.0), one(1.0);
    values[0] = dot(as_value<Value>(component), m);
    values[1] = select<Value>(place == Value(-end), values[0], none);
    values[2] = select<Value>(place == Value(end), values[0], none);
    values[3] = select<Value>(dot(m, m) == none, none, one);
  }
};

/// Functor that sums half the solid angle of each site, and that half times the site's position.
template <class Real>
struct PlaceOfCharge {
  cayspin::detail::SolidAngleOfSites<Real> angle;
  cayspin::SiteArray<Real, 1> places;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    angle(site, values);
    values[1] = values[0] * Value(site.load(places));
  }
};

/// Functor that gives each site the spin of the next or previous site along an axis. A site at an
/// open end keeps its own spin.
template <class Real>
struct TakeNeighbor {
  cayspin::SiteArray<Real, 3> spins;
  cayspin::OutputArray<Real, 3> moved;
  int axis;
  bool next;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    Stencil<Site, Real> const stencil(site, spins);
    if (axis == 0)
      site.store(along<0>(stencil), moved);
    else if (axis == 1)
      site.store(along<1>(stencil), moved);
    else
      site.store(along<2>(stencil), moved);
  }

 private:
  template <int Axis, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto along(Stencil const& stencil) const {
    auto const own = stencil.center();
    return next ? stencil.template next<Axis>(own) : stencil.template previous<Axis>(own);
  }
};

namespace {

// There is a wall if the means of the component at the two ends of the lattice differ by at least
// this much.
constexpr double least_step = 0.2;
constexpr double least_charge = 0.25;

std::vector<double> places(Lattice const& lattice, int axis) {
  auto const box = own_sites(lattice);
  auto const& [nx, ny, nz] = box.extent;
  auto const along = static_cast<std::size_t>(axis);
  double const middle = 0.5 * static_cast<double>(whole(lattice).shape[along] - 1);
  std::vector<double> places;
  places.reserve(static_cast<std::size_t>(nx * ny * nz));
  for (std::int64_t k = 0; k < nz; ++k)
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i)
        places.push_back(static_cast<double>(box.begin[along] + std::array{i, j, k}[along]) -
                         middle);
  return places;
}

}  // namespace

template <class Spins>
Follower<Spins>::Follower(io::Scene const& scene, Lattice const& lattice)
    : follow_(*scene.lattice.follow),
      extent_(whole(lattice).shape[static_cast<std::size_t>(follow_.axis)]),
      // With an adaptive method, the scene's steps may be far apart: check after every step.
      period_(scene.integrator.tolerance ? 1 : Guard::period_of(io::sites(scene))),
      moved_("Follower::moved", lattice),
      places_("Follower::places", lattice) {
  copy_from_host(places(lattice, follow_.axis), places_);
}

template <class Spins>
template <class Exec>
std::int64_t Follower<Spins>::cells_off(Exec const& exec, Spins const& spins) const {
  using cayspin::detail::reduce_sites, cayspin::detail::Sum;
  double cells = 0;
  if (follow_.quantity == io::Followed::charge) {
    PlaceOfCharge<Real> const look{{spins.array()}, places_.array()};
    auto const [angle, moment] =
        reduce_sites<Sum, 2>(exec, "cayspin::Follower", spins.layout(), look);
    if (std::abs(angle) >= 2 * std::numbers::pi * least_charge) cells = moment / angle;
  } else {
    auto const is = [&](io::Followed quantity) { return follow_.quantity == quantity ? 1.0 : 0.0; };
    WallOfSites<Real> const look{spins.array(),
                                 places_.array(),
                                 {is(io::Followed::mx), is(io::Followed::my), is(io::Followed::mz)},
                                 0.5 * static_cast<double>(extent_ - 1)};
    auto const [all, first, last, count] =
        reduce_sites<Sum, 4>(exec, "cayspin::Follower", spins.layout(), look);
    // A shift by one cell changes the sum by the difference between the sums at the two ends.
    double const step = first - last;
    if (std::abs(step) >= least_step * count / static_cast<double>(extent_))
      cells = (all - follow_.value * count) / step;
  }
  double const most = 0.5 * static_cast<double>(extent_);
  return std::isfinite(cells) ? static_cast<std::int64_t>(std::clamp(cells, -most, most)) : 0;
}

template <class Spins>
template <class Exec>
void Follower<Spins>::move(Exec const& exec, Spins const& spins, std::int64_t cells) {
  TakeNeighbor<Real> const take{spins.array(), moved_.output(false), follow_.axis, cells > 0};
  for (std::int64_t cell = 0; cell < std::abs(cells); ++cell) {
    cayspin::detail::for_each_site<Real>(exec, "cayspin::Follower", spins.layout(), take,
                                         spins.layout().own);
    cayspin::detail::update_ghosts(exec, spins.lattice(), moved_);
    Kokkos::deep_copy(exec, spins.allocation(), moved_.allocation());
  }
  exec.fence("cayspin::Follower: moved");
  shift_ += cells;
}

#define CAYSPIN_INSTANTIATE(Space, Real)                                           \
  template class Follower<SpinField<Real, Space::memory_space>>;                   \
  template std::int64_t Follower<SpinField<Real, Space::memory_space>>::cells_off( \
      Space const&, SpinField<Real, Space::memory_space> const&) const;            \
  template void Follower<SpinField<Real, Space::memory_space>>::move(              \
      Space const&, SpinField<Real, Space::memory_space> const&, std::int64_t);
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
