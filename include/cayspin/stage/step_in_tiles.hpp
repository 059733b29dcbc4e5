// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>
#include <cayspin/detail/device_site.hpp>
#include <cayspin/detail/tile_site.hpp>
#include <cayspin/detail/tiles_of_steps.hpp>
#include <cayspin/stage/arrays.hpp>
#include <cayspin/stage/pass.hpp>

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>

// All stages of a Runge-Kutta step in one launch, on a device, for films and chains whose stages
// take less time than their launches. The spins of the stages are in the scratch memory of the
// teams. What a site's later stages need of its earlier ones stays in registers. The results have
// the bits of a pass for each stage.
namespace cayspin::inline v0_2::detail {

/// Results of a site's stages that its thread keeps: increments or, if the method recovers them,
/// the spins of the next stages.
template <class Real, int Stages>
struct KeptOfSite {
  KeptVector<Real> of_stage[std::size_t{Stages}], sum;

  template <int J>
  KOKKOS_FORCEINLINE_FUNCTION KeptVector<Real> const& operator[](
      std::integral_constant<int, J>) const {
    return of_stage[J];
  }
};

/// The fields that a step in tiles reads and writes. A member that is not used is empty, because
/// kernels of at most 512 bytes are launched faster.
template <class Real, bool Carries>
struct FieldsOfSteps {
  struct None {};
  using Carried = std::conditional_t<Carries, ComponentPointers<Real>, None>;
  ComponentPointers<Real> start, end;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS Carried carried[1] = {};
};

/// The arrays of a stage in a tile. The first stage reads the field, the last stage writes to
/// another, and the others read and write scratch memory.
template <class Flow, class Real, class Fields>
struct ArraysInTile {
  using Scratch = TwoOutputs<ScratchOutput<Real>, KeptOutput<Real>>;

  ComponentPointers<Real> start;
  std::conditional_t<Flow::stage == 0, ComponentPointers<Real>, ScratchStencil<Real>> level;
  KeptOfSite<Real, Flow::stages> const& increments;
  KeptVector<Real> const& sum_before;
  KeptOutput<Real> sum, increment;
  std::conditional_t<Flow::last, ComponentPointers<Real>, Scratch> next;
  typename Fields::Carried carried_before[1], carried[1];

  KOKKOS_FORCEINLINE_FUNCTION ArraysInTile(Fields const& fields, ScratchStencil<Real> const& spins,
                                           ScratchOutput<Real> const& to,
                                           KeptOfSite<Real, Flow::stages>& kept)
      : start(fields.start),
        level(level_of(fields, spins)),
        increments(kept),
        sum_before(kept.sum),
        sum{kept.sum},
        increment{kept.of_stage[Flow::stage]},
        next(next_of(fields, to, {kept.of_stage[Flow::stage]})),
        carried_before{fields.carried[0]},
        carried{fields.carried[0]} {}

 private:
  KOKKOS_FORCEINLINE_FUNCTION static auto level_of(Fields const& fields,
                                                   ScratchStencil<Real> const& spins) {
    if constexpr (Flow::stage == 0)
      return fields.start;
    else
      return spins;
  }
  KOKKOS_FORCEINLINE_FUNCTION static auto next_of(Fields const& fields,
                                                  ScratchOutput<Real> const& to,
                                                  KeptOutput<Real> const& kept) {
    if constexpr (Flow::last)
      return fields.end;
    else
      return Scratch{to, kept, Flow::recovers};
  }
};

/// Memory for spins of a tile: those that a stage reads, and those that it writes.
template <class Real>
KOKKOS_FUNCTION std::size_t scratch_bytes_of_steps(TilesOfSteps const& tiles) {
  return 2 * 3 * sizeof(Real) * static_cast<std::size_t>(tiles.threads());
}

/// A team's step of its tile. `Kernels` are all RungeKuttaStages of a step, in their order, with
/// the same generator.
template <class Real, class Kernel, class... Kernels>
struct StepInTiles {
  static constexpr int stages = 1 + static_cast<int>(sizeof...(Kernels));
  static constexpr bool carries =
      (Kernel::Flow::carried > 0) || ((Kernels::Flow::carried > 0) || ...);

  decltype(Kernel::generator) generator;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS decltype(Kernel::isotropy) isotropy;
  Real dt;
  FieldsOfSteps<Real, carries> fields;
  DeviceLayout<std::int32_t> layout;
  TilesOfSteps tiles;

  template <class Team>
  KOKKOS_FUNCTION void operator()(Team const& team) const {
    auto const thread = static_cast<std::int32_t>(team.team_rank());
    auto const bytes = scratch_bytes_of_steps<Real>(tiles);
    Real* const here = static_cast<Real*>(team.team_scratch(0).get_shmem(bytes)) + thread;
    auto const place = tiles.place(static_cast<std::int32_t>(team.league_rank()), thread);
    KeptOfSite<Real, stages> kept;
    run<Kernel>(team, place, here, kept);
    (run<Kernels>(team, place, here, kept), ...);
  }

 private:
  template <class Stage, class Team>
  KOKKOS_FORCEINLINE_FUNCTION void run(Team const& team, TilesOfSteps::Place const& place,
                                       Real* here, KeptOfSite<Real, stages>& kept) const {
    using Flow = typename Stage::Flow;
    if constexpr (Flow::stage > 0) team.team_barrier();
    if (place.stages <= Flow::stage) return;
    std::int32_t const threads = tiles.threads();
    Real* const write = here + (Flow::stage % 2) * 3 * threads;
    Real const* const read = here + ((Flow::stage + 1) % 2) * 3 * threads;
    ArraysInTile<Flow, Real, FieldsOfSteps<Real, carries>> const arrays(
        fields, {{read + place.before, read, read + place.after}, tiles.row(), threads},
        {write, threads}, kept);
    Stage const stage{generator, isotropy, dt};
    stage(TileSite<Real, std::int32_t>{layout, place.x, place.y, place.z}, arrays);
  }
};

/// Returns true if a space has the scratch memory for steps in tiles, and the lattice is a small
/// film or chain.
template <class Exec, class Real>
bool has_steps_in_tiles(RowLayout const& layout, std::int32_t stages) {
  if constexpr (is_host_execution<Exec>)
    return false;
  else
    return TilesOfSteps::suit(layout, stages) &&
           DeviceLayout<std::int32_t>::reaches(layout, layout.sites()) &&
           scratch_bytes_of_steps<Real>(TilesOfSteps(layout, stages)) <=
               static_cast<std::size_t>(Kokkos::TeamPolicy<Exec>::scratch_size_max(0));
}

/// Takes a step in one launch. All stages have the same generator, and the last stage must not
/// write to the spins that the first one reads. Returns false, and does nothing, if teams of the
/// space are too small.
template <class Exec, class First, class... Kernels>
bool run_step_in_tiles(Exec const& exec, std::string const& label, RowLayout const& layout,
                       StageOnSite<First> const& first, StageOnSite<Kernels> const&... others) {
  using Real = typename First::value_type;
  using Step = StepInTiles<Real, First, Kernels...>;
  auto const& last = std::get<sizeof...(Kernels) - 1>(std::tie(others...));
  TilesOfSteps const tiles(layout, Step::stages);
  FieldsOfSteps<Real, Step::carries> fields{first.fields.level, last.fields.next};
  if constexpr (Step::carries) fields.carried[0] = last.fields.carried[0];
  Step const step{first.kernel.generator,
                  first.kernel.isotropy,
                  first.kernel.dt,
                  fields,
                  DeviceLayout<std::int32_t>(layout),
                  tiles};
  Kokkos::TeamPolicy<Exec> policy(exec, tiles.count(), tiles.threads());
  policy.set_scratch_size(0, Kokkos::PerTeam(scratch_bytes_of_steps<Real>(tiles)));
  if (policy.team_size_max(step, Kokkos::ParallelForTag()) < tiles.threads()) return false;
  Kokkos::parallel_for(label, policy, step);
  return true;
}

}  // namespace cayspin::inline v0_2::detail
