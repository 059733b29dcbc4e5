// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>
#include <cayspin/detail/device_site.hpp>
#include <cayspin/detail/division_by.hpp>
#include <cayspin/row_layout.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cstdint>
#include <string>

// Steps of small lattices on a device. A launch for each stage would take about as long as the
// stage itself, or longer. So a team of threads takes many steps in one launch, of one replica or
// of several small ones. It waits after each stage, because a stage reads the neighbours that the
// previous stage has moved. The spins of a team stay in the cache of its multiprocessor.
namespace cayspin::inline v0_2::detail {

/// Divides the replicas of a lattice between teams. Each replica belongs to one team.
class ReplicaTeams {
 public:
  /// Replicas share a team if together they have at most this many sites.
  static constexpr std::int64_t most_shared_sites = threads_of_tile;
  /// The spins of a larger replica would not stay in the cache.
  static constexpr std::int64_t most_sites = 4096;
  /// Up to this many sites, a single team is at least as fast as a launch for each stage.
  static constexpr std::int64_t most_sites_of_single_team = 1024;
  /// Larger replicas suit a device that can run at most this many threads for each team: on a
  /// larger device, a launch for each stage is faster.
  static constexpr std::int64_t device_threads_per_team = 8192;

  explicit ReplicaTeams(RowLayout const& layout)
      : nx_(layout.nx),
        ny_(layout.ny),
        nz_(layout.nz),
        planes_(static_cast<std::int32_t>(
            layout.replica_planes *
            (most_shared_sites / std::min(sites_of_replica(layout), most_shared_sites)))),
        by_row_(layout.nx),
        by_plane_(layout.ny) {}

  /// Returns true if teams can take steps of these spins, and are expected to be faster than a
  /// launch for each stage. Teams have 32-bit offsets only, so that there is one kernel to compile.
  template <class Exec>
  static bool suit(Exec const& exec, RowLayout const& layout) {
    if (!DeviceLayout<std::int32_t>::reaches(layout, layout.sites())) return false;
    std::int64_t const sites = sites_of_replica(layout),
                       replicas = layout.nz / layout.replica_planes;
    return sites <= most_sites_of_single_team ||
           (sites <= most_sites && replicas * device_threads_per_team >= exec.concurrency());
  }

  /// Returns how often one launch may repeat a step. A GPU that also draws a screen stops kernels
  /// that run for seconds.
  static std::int64_t most_repeats(RowLayout const& layout) {
    constexpr std::int64_t most = std::int64_t(1) << 30;  // times sites
    return std::clamp<std::int64_t>(most / layout.sites(), 1, 1000);
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
      std::int32_t const row = by_row_.quotient(site), plane = by_plane_.quotient(row);
      body(site - row * nx_, row - plane * ny_, z + plane);
    }
  }

 private:
  static std::int64_t sites_of_replica(RowLayout const& layout) {
    return std::int64_t(layout.nx) * layout.ny * layout.replica_planes;
  }

  std::int32_t nx_, ny_, nz_;
  std::int32_t planes_;  // of a team
  DivisionBy by_row_, by_plane_;
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

  explicit FunctorList(First const& functor, Rest const&... functors)
      : first(functor), rest(functors...) {}
  template <class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void for_each(Visit const& visit) const {
    visit(first);
    rest.for_each(visit);
  }
};

/// Calls functors at all sites, one functor after another, `count` times.
template <class Real, class... Functors>
struct RepeatInTeams {
  FunctorList<Functors...> functors;
  DeviceLayout<std::int32_t> layout;
  ReplicaTeams teams;
  std::int64_t count;

  template <class Team>
  KOKKOS_FUNCTION void operator()(Team const& team) const {
    for (std::int64_t i = 0; i < count; ++i) functors.for_each(AtSitesOfTeam<Team>{*this, team});
  }

 private:
  template <class Team>
  struct AtSitesOfTeam {
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
    DeviceLayout<std::int32_t> const& layout;
    Functor const& functor;
    KOKKOS_FORCEINLINE_FUNCTION void operator()(std::int32_t x, std::int32_t y,
                                                std::int32_t z) const {
      functor(DeviceSite<Real, std::int32_t>(layout, x, y, z));
    }
  };
};

/// Calls functors(site) at all sites, one functor after another, `count` times, in as few launches
/// as ReplicaTeams::most_repeats allows. ReplicaTeams::suit must be true. A functor may read what
/// the functors before it wrote in the same replica.
template <class Real, class Exec, class... Functors>
void repeat_in_teams(Exec const& exec, std::string const& label, std::int64_t count,
                     RowLayout const& layout, Functors const&... functors) {
  using Policy = Kokkos::TeamPolicy<Exec>;
  ReplicaTeams const teams(layout);
  RepeatInTeams<Real, Functors...> repeat{FunctorList<Functors...>(functors...),
                                          DeviceLayout<std::int32_t>(layout), teams, 0};
  int const most_threads =
      Policy(exec, teams.count(), 1).team_size_max(repeat, Kokkos::ParallelForTag());
  constexpr std::int32_t warp = 32;  // threads of one instruction, on most devices
  int const threads = std::min(most_threads, (teams.sites() + warp - 1) / warp * warp);
  for (std::int64_t done = 0; done < count; done += repeat.count) {
    repeat.count = std::min(count - done, ReplicaTeams::most_repeats(layout));
    Kokkos::parallel_for(label, Policy(exec, teams.count(), threads), repeat);
  }
}

}  // namespace cayspin::inline v0_2::detail
