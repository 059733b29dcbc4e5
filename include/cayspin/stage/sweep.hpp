// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/row_sweep.hpp>
#include <cayspin/detail/strip_crew.hpp>
#include <cayspin/detail/sweep_plan.hpp>
#include <cayspin/stage/pass.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>

// All stages of a Runge-Kutta step in one pass through the lattice. Each stage is one or two planes
// behind the previous one (in a single plane that is not cut into strips: one row), so that the
// data it reads are still in the cache.
namespace cayspin::inline v0_2 {

/// Order in which the stages of a step traverse the lattice. The results are bitwise identical.
enum class Path {
  pass,  // one kernel per stage
  sweep  // all stages together, on host spaces
};

namespace detail {

/// Memory that a sweep needs in addition to fields. Empty if default-constructed.
template <class Real, class MemorySpace>
class SweepBuffers {
 public:
  SweepBuffers() = default;
  /// `label`: prefix of the labels of the Views.
  SweepBuffers(std::string const& label, SweepPlan const& plan)
      : numbers_(Kokkos::view_alloc(Kokkos::WithoutInitializing, label + "::buffers"), plan.size()),
        progress_(label + "::progress", progress_size(plan)) {
    advise_huge_pages(numbers_.data(), numbers_.size() * sizeof(Real));
    for_each_task(typename MemorySpace::execution_space(), label + "::fill_buffers", plan.tasks(),
                  plan.layout.sites(), FillSweepBuffers<Real>{numbers_.data(), plan});
  }

  std::size_t bytes() const {
    return numbers_.size() * sizeof(Real) + progress_.size() * sizeof(StripProgress);
  }
  static std::size_t bytes(SweepPlan const& plan) {
    return plan.size() * sizeof(Real) + progress_size(plan) * sizeof(StripProgress);
  }

  template <class Loop>
  void set(Loop& loop) const {
    loop.memory = numbers_.data();
    loop.progress = progress_.data();
  }

 private:
  static std::size_t progress_size(SweepPlan const& plan) {
    return plan.strips == 1 ? 0 : static_cast<std::size_t>(plan.parts() * (plan.strips + 1));
  }

  Kokkos::View<Real*, MemorySpace> numbers_;
  Kokkos::View<StripProgress*, MemorySpace> progress_;
};

/// The buffers between the stages of a method, numbered in this order: the spins of stages 1, 2,
/// ..; the increments of stages 0, 1, ..; the weighted sums that stages 0, 1, .. write.
template <class Tableau, class Update>
struct StageBuffers {
  static constexpr int stages = Tableau::stages;
  static constexpr int per_kind = stages - 1;
  static constexpr int count = 3 * per_kind;

  static constexpr int spins(int stage) { return stage - 1; }
  static constexpr int increment(int stage) { return per_kind + stage; }
  static constexpr int sum(int stage) { return 2 * per_kind + stage; }

  static constexpr int producer(int buffer) { return buffer % per_kind; }

  /// Returns the last stage that reads the buffer, or its producer if no stage reads it.
  static constexpr int last_reader(int buffer) {
    int const from = producer(buffer);
    int last = from;
    for (int stage = from + 1; stage < stages; ++stage)
      if (reads(stage, buffer)) last = stage;
    return last;
  }
  /// Returns how many planes of a buffer are in use at a time when each stage is `lag` planes
  /// behind the previous one; 0 if no stage reads the buffer. For spins it is at least lag + 2,
  /// because the next stage reads neighbours.
  static constexpr int planes(int buffer, int lag) {
    int const behind = lag * (last_reader(buffer) - producer(buffer));
    if (behind == 0) return 0;
    return buffer < per_kind ? std::max(lag + 2, behind + 1) : behind + 1;
  }
  /// Returns the stage whose sum a stage continues.
  static constexpr int sum_before(int stage) {
    int from = stage - 1;
    while (from > 0 && !writes_sum<Tableau, Update>(from)) --from;
    return from;
  }

 private:
  static constexpr bool reads(int stage, int buffer) {
    int const from = producer(buffer);
    if (buffer < per_kind)
      return stage == from + 1 || (recovers_increments<Tableau, Update>() && stage + 1 == stages);
    if (buffer < 2 * per_kind) return reads_increment<Tableau, Update>(stage, from);
    return reads_sum<Tableau, Update>(stage) && sum_before(stage) == from &&
           writes_sum<Tableau, Update>(from);
  }
};

/// Decides whether a method sweeps, and with which plan. In passes the method needs `WorkFields`
/// fields.
template <class Spins, class Tableau, class Update, int WorkFields>
struct SweepChoice {
  using Real = typename Spins::value_type;
  static constexpr int stages = Tableau::stages;
  static constexpr bool possible =
      stages > 1 &&
      stages <=
          SweepPlan::most_stages&& is_host_execution<typename Spins::memory_space::execution_space>;

  static bool can_sweep(RowLayout const& layout) {
    bool const wraps_in_replicas =
        layout.has_replicas() && layout.periodic[2] && layout.replica_planes > 1;
    return possible && !wraps_in_replicas &&
           (!layout.periodic[1] || layout.ny == 1 || layout.ny >= stages);
  }
  /// Returns true if a sweep is possible and is the default: there are several rows, the fields do
  /// not all fit into the caches of the cores, and the buffers take no more memory than the fields
  /// that passes would need.
  static bool sweeps_by_itself(RowLayout const& layout, int threads) {
    std::size_t const field = layout.allocation(3) * sizeof(Real);
    return can_sweep(layout) && layout.rows() > 1 &&
           (WorkFields + 1) * field > static_cast<std::size_t>(threads) * core_cache_bytes() &&
           SweepBuffers<Real, typename Spins::memory_space>::bytes(plan(layout, threads)) <=
               WorkFields * field;
  }
  static SweepPlan plan(RowLayout const& layout, int threads) {
    if constexpr (possible) {
      return SweepPlan::of<Real, StageBuffers<Tableau, Update>>(layout, threads,
                                                                core_cache_bytes() / 2);
    } else {
      SweepPlan plan;
      plan.layout = layout;
      return plan;
    }
  }
  static void require(RowLayout const& layout, std::string const& where) {
    if (!can_sweep(layout))
      throw std::invalid_argument(where +
                                  ": a sweep needs two stages, a host space and, "
                                  "along a periodic y, as many rows as stages; it does not take "
                                  "replicas that are periodic along z");
  }
};

template <class Tableau, class Update, class Real, class... Kernels>
struct SweepLoop {
  static constexpr int stages = Tableau::stages;

  std::tuple<Kernels...> kernels;
  SweepPlan plan;
  SiteArray<Real, 3> start;
  OutputArray<Real, 3> next;
  SiteArray<Real, 3> carried[StageArrays<Planes<Real>, stages>::most_carried];
  Real* memory;
  StripProgress* progress;

  void operator()(std::int64_t task) const {
    if (plan.by_rows) {
      RowSweepPart<Real> part(plan, memory, task);
      for (; part.tick < part.ticks; ++part.tick)
        unrolled<stages>([&](auto stage) { run_stage_at<stage()>(part, part.z.begin); });
      if (next.streaming) streaming_fence();
      return;
    }
    std::int64_t const number = task / plan.strips;
    auto const strip = static_cast<std::int32_t>(task % plan.strips);
    std::int64_t const steps = SweepPart<Real>(plan, memory, number, strip).steps();
    auto const run = [&](std::int32_t of_part, std::int64_t step) {
      SweepPart<Real> part(plan, memory, number, of_part);
      std::int32_t const plane = part.begin_step(step);
      unrolled<stages>(
          [&](auto stage) { run_stage_at<stage()>(part, plane - plan.lag * stage()); });
    };
    if (plan.strips == 1)
      for (std::int64_t step = 0; step < steps; ++step) run(strip, step);
    else
      StripCrew{progress + number * (plan.strips + 1), plan.strips, steps, plan.lag - 1}.work(strip,
                                                                                              run);
    if (next.streaming) streaming_fence();
  }

 private:
  /// Locates the arrays of a stage, in fields or in the buffers of a part.
  template <class Part>
  struct PlaneOfStep {
    using Buffers = StageBuffers<Tableau, Update>;
    SweepLoop const& loop;
    Part const& part;
    std::int32_t z, here;

    PlaneRows<Real> start() const { return plane_rows(loop.start, loop.plan.layout, here); }
    template <int Stage>
    typename Planes<Real>::Spins level() const {
      auto const& along_z = part.z.axis;
      return {at<Stage>(along_z.previous(z)), at<Stage>(z), at<Stage>(along_z.next(z))};
    }
    template <int Stage>
    PlaneRows<Real> spins() const {
      return part.rows(Buffers::spins(Stage), z);
    }
    template <int Stage>
    PlaneRows<Real> increment() const {
      return part.rows(Buffers::increment(Stage), z);
    }
    template <int Stage>
    typename Planes<Real>::Output new_increment() const {
      return {increment<Stage>()};
    }
    template <int Stage>
    PlaneRows<Real> sum_before() const {
      return part.rows(Buffers::sum(Buffers::sum_before(Stage)), z);
    }
    template <int Stage>
    typename Planes<Real>::Output sum() const {
      return {part.rows(Buffers::sum(Stage), z)};
    }
    template <int Stage>
    typename Planes<Real>::Output next() const {
      if constexpr (Stage + 1 < stages)
        return {spins<Stage + 1>()};
      else
        return {plane_rows<Real>(loop.next, loop.plan.layout, here), loop.next.streaming};
    }
    PlaneRows<Real> carried_before(std::size_t i) const {
      return plane_rows(loop.carried[i], loop.plan.layout, here);
    }
    typename Planes<Real>::Output carried(std::size_t i) const { return {carried_before(i)}; }

   private:
    template <int Stage>
    PlaneRows<Real> at(std::int32_t plane) const {
      if constexpr (Stage == 0)
        return plane_rows(loop.start, loop.plan.layout, part.z.axis.wrapped(plane));
      else
        return part.rows(Buffers::spins(Stage), plane);
    }
  };

  template <int Stage, class Part>
  void run_stage_at(Part const& part, std::int32_t z) const {
    if (z < part.z.low(Stage) || part.z.high(Stage) <= z) return;
    auto const& kernel = std::get<Stage>(kernels);
    using Kernel = std::remove_cvref_t<decltype(kernel)>;
    std::int32_t const here = part.z.axis.wrapped(z);
    PlanesOf<Kernel> planes;
    find_arrays<typename Kernel::Flow>(PlaneOfStep<Part>{*this, part, z, here}, planes.arrays);
    planes.y = part.y.axis;
    planes.from_memory = Stage == 0;
    run_stage(kernel, planes, plan.layout,
              {here, part.low(Stage), part.high(Stage), 0, pack_count<Real>(plan.layout)});
  }
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
