// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/sweep_plan.hpp>
#include <cayspin/stage/pass.hpp>

#include <algorithm>
#include <cstdint>
#include <tuple>

// All stages of a Runge-Kutta step in one journey through the lattice: each stage works one plane
// and one row behind the stage before it, on numbers that are still in the cache.
namespace cayspin::detail {

/// The buffers between the stages of a method, by number: spins of stage 1, 2, .., increments of
/// stage 0, 1, .., weighted sums from stage 0, 1, ..
template <class Tableau, class Update>
struct StageBuffers {
  static constexpr int stages = Tableau::stages;
  static constexpr int per_kind = stages - 1;
  static constexpr int count = 3 * per_kind;

  static constexpr int spins(int stage) { return stage - 1; }
  static constexpr int increment(int stage) { return per_kind + stage; }
  static constexpr int sum(int stage) { return 2 * per_kind + stage; }

  static constexpr int producer(int buffer) { return buffer % per_kind; }

  /// The stage behind which the buffer's numbers are no longer needed; the producer, if never.
  static constexpr int last_reader(int buffer) {
    int const from = producer(buffer);
    int last = from;
    for (int stage = from + 1; stage < stages; ++stage)
      if (reads(stage, buffer)) last = stage;
    return last;
  }
  /// Planes that are alive at a time: neighbours are read in three.
  static constexpr int planes(int buffer) {
    int const lag = last_reader(buffer) - producer(buffer);
    if (lag == 0) return 0;
    return buffer < per_kind ? std::max(3, lag + 1) : lag + 1;
  }
  /// The stage whose sum a stage continues.
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

template <class Tableau, class Update, class Real, class... Kernels>
struct SweepLoop {
  using Buffers = StageBuffers<Tableau, Update>;
  static constexpr int stages = Tableau::stages;

  std::tuple<Kernels...> kernels;
  SweepPlan plan;
  SiteArray<Real, 3> start;
  OutputArray<Real, 3> next;
  SiteArray<Real, 3> residual;
  Real* memory;

  void operator()(std::int64_t task) const {
    SweepPart<Real> part(plan, memory, task);
    for (part.block = 0; part.block < part.blocks; ++part.block)
      for (std::int32_t tick = part.z.low(0); tick < part.z.end + stages - 1; ++tick)
        unrolled<stages>([&](auto stage) { run<stage()>(part, tick - stage()); });
    if (next.streaming) streaming_fence();
  }

 private:
  template <int Stage>
  void run(SweepPart<Real> const& part, std::int32_t z) const {
    if (z < part.z.low(Stage) || part.z.high(Stage) <= z) return;
    auto const& kernel = std::get<Stage>(kernels);
    using Kernel = std::remove_cvref_t<decltype(kernel)>;
    std::int32_t const here = part.z.axis.wrapped(z);
    StagePlanes<Kernel> planes;
    planes.y = part.y.axis;
    planes.start = plane_rows(start, plan.layout, here);
    planes.level[0] = spins<Stage>(part, part.z.axis.previous(z));
    planes.level[1] = spins<Stage>(part, z);
    planes.level[2] = spins<Stage>(part, part.z.axis.next(z));
    planes.level_from_memory = Stage == 0;
    unrolled<stages - 1>([&](auto j) {
      if constexpr (Kernel::reads_increment(j()))
        planes.increments[j()] =
            part.rows(Kernel::recovers ? Buffers::spins(j() + 1) : Buffers::increment(j()), z);
    });
    if constexpr (Kernel::reads_sum)
      planes.sum_before = part.rows(Buffers::sum(Buffers::sum_before(Stage)), z);
    if constexpr (Kernel::writes_sum) planes.sum = part.rows(Buffers::sum(Stage), z);
    if constexpr (Kernel::stores_increment)
      planes.increment = part.rows(Buffers::increment(Stage), z);
    if constexpr (Kernel::compensates) planes.residual = plane_rows(residual, plan.layout, here);
    if constexpr (Stage + 1 < stages) {
      planes.next = part.rows(Buffers::spins(Stage + 1), z);
    } else {
      planes.next = plane_rows<Real>(next, plan.layout, here);
      planes.next_streams = next.streaming;
    }
    run_stage(kernel, planes, plan.layout,
              {here, part.low(Stage), part.high(Stage), 0, pack_count<Real>(plan.layout)});
  }

  template <int Stage>
  PlaneRows<Real> spins(SweepPart<Real> const& part, std::int32_t z) const {
    if constexpr (Stage == 0)
      return plane_rows(start, plan.layout, part.z.axis.wrapped(z));
    else
      return part.rows(Buffers::spins(Stage), z);
  }
};

}  // namespace cayspin::detail
