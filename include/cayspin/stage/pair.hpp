// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/tile_site.hpp>
#include <cayspin/detail/tiles_of_teams.hpp>
#include <cayspin/stage/arrays.hpp>
#include <cayspin/stage/pass.hpp>

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

// Two stages of a Runge-Kutta step, or two steps of one stage, in one pass over the lattice, on a
// device. The threads of a team walk along z. In each plane they compute the first stage, also at
// the border of their tile, and write its spins to scratch memory; one plane behind, they compute
// the second stage from there. What a site's second stage needs of its first stage stays in
// registers. The results have the bits of two passes.
namespace cayspin::inline v0_2::detail {

/// The arrays of the first stage of a pair.
template <class Flow, class Real>
struct ArraysOfFirst : DeviceArrays<Flow, Real> {
  using Fields = DeviceArrays<Flow, Real>;
  TwoOutputs<ScratchOutput<Real>, ComponentPointers<Real> const&> next;
  TwoOutputs<KeptOutput<Real>, decltype(Fields::increment) const&> increment;
};

/// The arrays of the second stage of a pair.
template <class Flow, class Real>
struct ArraysOfSecond : DeviceArrays<Flow, Real> {
  using Fields = DeviceArrays<Flow, Real>;
  struct Increments {
    typename Fields::Increments const& of_fields;
    KeptVector<Real> const& kept;
    template <int J>
    KOKKOS_FORCEINLINE_FUNCTION auto const& operator[](std::integral_constant<int, J> j) const {
      if constexpr (J + 1 == Flow::stage && !Flow::recovers)
        return kept;
      else
        return of_fields[j];
    }
  };
  ScratchStencil<Real> level;
  Increments increments;
};

/// Planes of spins in the scratch memory of a team: three that are read, and one that is written.
inline constexpr std::int32_t scratch_planes = 4;
template <class Real>
inline constexpr std::size_t scratch_bytes_of_pairs =
    sizeof(Real) * scratch_planes * 3 * TilesOfTeams::threads;

/// Loop of a team over its tile. `First` and `Second` are two consecutive RungeKuttaStages.
template <class Index, class First, class Second>
struct StagePairOnTiles {
  using Real = typename First::value_type;
  using Tiles = TilesOfTeams;

  StageOnSite<First> first;
  StageOnSite<Second> second;
  DeviceLayout<Index> layout;
  Tiles tiles;

  template <class Team>
  KOKKOS_FUNCTION void operator()(Team const& team) const {
    auto const thread = static_cast<std::int32_t>(team.team_rank());
    constexpr std::size_t bytes = scratch_bytes_of_pairs<Real>;
    Real* const here = static_cast<Real*>(team.team_scratch(0).get_shmem(bytes)) + thread;
    auto const column = tiles.column(static_cast<std::int32_t>(team.league_rank()), thread);
    KeptVector<Real> before, now;
    for (std::int32_t z = column.begin - 1; z <= column.end; ++z) {
      before = now;
      std::int32_t const wrapped = tiles.plane(z);
      if (column.there && wrapped >= 0)
        run_first({layout, column.x, column.y, column.first + wrapped},
                  column.own && z >= column.begin && z < column.end, slot(here, z), now);
      team.team_barrier();
      if (column.own && z > column.begin)
        run_second(
            {layout, column.x, column.y, column.first + z - 1},
            {{slot(here, z - 2), slot(here, z - 1), slot(here, z)}, Tiles::width, Tiles::threads},
            before);
    }
  }

 private:
  using Site = TileSite<Real, Index>;

  KOKKOS_FORCEINLINE_FUNCTION static Real* slot(Real* here, std::int32_t z) {
    return here + (z + scratch_planes) % scratch_planes * (3 * Tiles::threads);
  }

  KOKKOS_FORCEINLINE_FUNCTION void run_first(Site const& site, bool own, Real* to,
                                             KeptVector<Real>& kept) const {
    using Flow = typename First::Flow;
    auto const& fields = first.fields;
    // True if a later pair needs what the second stage finds in scratch memory and registers.
    constexpr bool is_read_later = Flow::last_reader > Flow::stage + 1;
    ArraysOfFirst<Flow, Real> const arrays{
        fields,
        {{to, Tiles::threads}, fields.next, is_read_later && Flow::recovers && own},
        {{kept}, fields.increment, is_read_later && !Flow::recovers && own}};
    first.kernel(site, arrays);
  }

  KOKKOS_FORCEINLINE_FUNCTION void run_second(Site const& site, ScratchStencil<Real> const& spins,
                                              KeptVector<Real> const& kept) const {
    using Flow = typename Second::Flow;
    auto const& fields = second.fields;
    ArraysOfSecond<Flow, Real> const arrays{fields, spins, {fields.increments, kept}};
    second.kernel(site, arrays);
  }
};

/// Returns true if a space has the scratch memory for pairs, and the lattice is wide enough to fill
/// tiles.
template <class Exec, class Real>
bool has_pairs(RowLayout const& layout) {
  using Tiles = TilesOfTeams;
  if constexpr (is_host_execution<Exec>)
    return false;
  else
    return layout.part == nullptr && layout.nx >= Tiles::width - 2 &&
           layout.ny >= Tiles::height - 2 &&
           scratch_bytes_of_pairs<Real> <=
               static_cast<std::size_t>(Kokkos::TeamPolicy<Exec>::scratch_size_max(0));
}

/// Runs two stages in one pass. Returns false, and does nothing, if teams of the space are too
/// small.
template <class Exec, class First, class Second>
bool run_pair(Exec const& exec, std::string const& label, RowLayout const& layout,
              StageOnSite<First> const& first, StageOnSite<Second> const& second) {
  TilesOfTeams const tiles(layout);
  auto const run = [&]<class Index>(Index) {
    using Pair = StagePairOnTiles<Index, First, Second>;
    Pair const pair{first, second, DeviceLayout<Index>(layout), tiles};
    Kokkos::TeamPolicy<Exec> policy(exec, static_cast<int>(tiles.count()), TilesOfTeams::threads);
    policy.set_scratch_size(0, Kokkos::PerTeam(scratch_bytes_of_pairs<typename Pair::Real>));
    if (policy.team_size_max(pair, Kokkos::ParallelForTag()) < TilesOfTeams::threads) return false;
    Kokkos::parallel_for(label, policy, pair);
    return true;
  };
  if (DeviceLayout<std::int32_t>::reaches(layout, tiles.count())) return run(std::int32_t{});
  return run(std::int64_t{});
}

}  // namespace cayspin::inline v0_2::detail
