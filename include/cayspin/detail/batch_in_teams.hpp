// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/device_site.hpp>
#include <cayspin/detail/device_tiles.hpp>
#include <cayspin/row_layout.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

// Steps of small lattices on a device. As kernels of their own, the stages would take about as long
// as their launches. So a team of threads takes many steps in one launch: it has a replica, or
// several small ones, and waits after each stage, since a stage reads the neighbours that the stage
// before it has moved. The spins of a team stay in the cache of its multiprocessor.
namespace cayspin::inline v0_2::detail {

/// Divides the replicas of a lattice between teams.
class ReplicaTeams {
 public:
  /// A team has as many replicas as this number of sites holds, and at least one.
  static constexpr std::int32_t usual_sites = threads_of_tile;
  /// Replicas of more sites fit neither into a cache nor on the threads of a team.
  static constexpr std::int64_t most_sites = 4096;
  /// Up to this number of sites, one team is at least as fast as the launches of its stages.
  static constexpr std::int64_t sites_of_lone_team = 1024;
  /// There are enough teams for a device if it can run at most this many threads for each of them.
  static constexpr std::int64_t threads_per_team = 8192;

  explicit ReplicaTeams(RowLayout const& layout)
      : nx_(layout.nx),
        ny_(layout.ny),
        nz_(layout.nz),
        planes_(layout.replica_planes *
                std::max(1, usual_sites / static_cast<std::int32_t>(std::min<std::int64_t>(
                                              sites_of_replica(layout), usual_sites)))),
        by_row_(static_cast<std::uint32_t>(layout.nx)),
        by_plane_(static_cast<std::uint32_t>(layout.ny)) {}

  /// Returns true if teams are expected to take steps faster than one launch for each stage.
  template <class Exec>
  static bool suit(Exec const& exec, RowLayout const& layout) {
    std::int64_t const sites = sites_of_replica(layout),
                       replicas = layout.nz / layout.replica_planes;
    return sites <= sites_of_lone_team ||
           (sites <= most_sites && replicas * threads_per_team >= exec.concurrency());
  }

  std::int32_t count() const { return (nz_ + planes_ - 1) / planes_; }
  /// Returns the largest number of sites of a team.
  std::int32_t sites() const { return nx_ * ny_ * std::min(planes_, nz_); }

  /// Calls body(x, y, z) for the sites of a thread.
  template <class Team, class Body>
  KOKKOS_FORCEINLINE_FUNCTION void for_each(Team const& team, Body const& body) const {
    std::int32_t const z = team.league_rank() * planes_;
    std::int32_t const end = nx_ * ny_ * Kokkos::min(planes_, nz_ - z);
    for (std::int32_t site = team.team_rank(); site < end; site += team.team_size()) {
      auto const row = static_cast<std::int32_t>(by_row_(static_cast<std::uint32_t>(site)));
      auto const plane = static_cast<std::int32_t>(by_plane_(static_cast<std::uint32_t>(row)));
      body(site - row * nx_, row - plane * ny_, z + plane);
    }
  }

 private:
  static std::int64_t sites_of_replica(RowLayout const& layout) {
    return std::int64_t(layout.nx) * layout.ny * layout.replica_planes;
  }

  std::int32_t nx_, ny_, nz_;
  std::int32_t planes_;  // of a team
  QuickDivision by_row_, by_plane_;
};

/// A list of functors. Unlike std::tuple, device code can read it.
template <class... Functors>
struct FunctorList {
  template <class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void for_each(Visit const&) const {}
};
template <class First, class... Rest>
struct FunctorList<First, Rest...> {
  First first;
  FunctorList<Rest...> rest;

  FunctorList(First const& functor, Rest const&... functors) : first(functor), rest(functors...) {}
  template <class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void for_each(Visit const& visit) const {
    visit(first);
    rest.for_each(visit);
  }
};

/// Calls functors at all sites, one functor after another, `count` times.
template <class Real, class Index, class... Functors>
struct RepeatInTeams {
  FunctorList<Functors...> functors;
  DeviceLayout<Index> layout;
  ReplicaTeams teams;
  std::int64_t count;

  template <class Team>
  KOKKOS_FUNCTION void operator()(Team const& team) const {
    for (std::int64_t i = 0; i < count; ++i) functors.for_each(OfTeam<Team>{*this, team});
  }

 private:
  template <class Team>
  struct OfTeam {
    RepeatInTeams const& repeat;
    Team const& team;
    template <class Functor>
    KOKKOS_FORCEINLINE_FUNCTION void operator()(Functor const& functor) const {
      repeat.teams.for_each(team, AtSite<Functor>{repeat.layout, functor});
      team.team_barrier();
    }
  };
  template <class Functor>
  struct AtSite {
    DeviceLayout<Index> const& layout;
    Functor const& functor;
    KOKKOS_FORCEINLINE_FUNCTION void operator()(std::int32_t x, std::int32_t y,
                                                std::int32_t z) const {
      functor(DeviceSite<Real, Index>(layout, x, y, z));
    }
  };
};

/// Calls functors(site) at all sites, one functor after another, `count` times, in one launch. A
/// functor may read what the functors before it wrote in the same replica.
template <class Real, class Exec, class... Functors>
void repeat_in_teams(Exec const& exec, std::string const& label, std::int64_t count,
                     RowLayout const& layout, Functors const&... functors) {
  if (count == 0) return;
  ReplicaTeams const teams(layout);
  auto const run = [&]<class Index>(Index) {
    RepeatInTeams<Real, Index, Functors...> const repeat{
        {functors...}, DeviceLayout<Index>(layout), teams, count};
    using Policy = Kokkos::TeamPolicy<Exec>;
    int const most = Policy(exec, teams.count(), 1).team_size_max(repeat, Kokkos::ParallelForTag());
    constexpr std::int32_t together = 32;  // threads of one instruction, on most devices
    int const threads = std::min(most, (teams.sites() + together - 1) / together * together);
    Kokkos::parallel_for(label, Policy(exec, teams.count(), threads), repeat);
  };
  if (DeviceLayout<std::int32_t>::reaches(layout, layout.sites()))
    run(std::int32_t{});
  else
    run(std::int64_t{});
}

}  // namespace cayspin::inline v0_2::detail
