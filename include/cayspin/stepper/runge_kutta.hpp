// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/batch.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stage/pass.hpp>
#include <cayspin/stage/kernel.hpp>
#include <cayspin/stage/sweep.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace cayspin {

/// How the stages of a step go through the lattice. Results have the same bits.
enum class Path {
  pass,  // one kernel per stage
  sweep  // all stages together, on host spaces
};

/// An explicit one-step method on a spin field: a tableau, and the geometry by which increments
/// move spins (cayspin::update). Holds all work memory. Large fields on a host are swept through
/// once per step, unless the generator has to see a stage's spins before it (a nonlocal field).
/// Otherwise there is one fused kernel per stage.
template <class Spins, class Tableau, class Update, class Isotropy>
class RungeKutta {
 public:
  using spins_type = Spins;
  using tableau_type = Tableau;
  using update_type = Update;
  using isotropy_type = Isotropy;
  using Real = typename Spins::value_type;
  static constexpr int order = Tableau::order;
  static constexpr int evaluations = Tableau::stages;  // of the generator, per step
  /// Fields of three numbers per site beside the spins, where stages go one by one.
  static constexpr int work_fields = detail::work_fields<Tableau, Update>();

  /// Allocates work memory for fields shaped like `like`. `name` labels kernels and memory.
  explicit RungeKutta(std::string const& name, Spins const& like, Isotropy isotropy = {})
      : name_(name),
        region_("cayspin::" + name),
        batch_label_(region_ + "::batch"),
        sweep_label_(region_ + "::sweep"),
        isotropy_(isotropy),
        lattice_(like.lattice()),
        plan_(sweep_plan(like.layout(), DefaultExec().concurrency())) {
    for (int i = 0; i < stages; ++i) labels_[i] = region_ + "::stage_" + std::to_string(i + 1);
    take(sweeps_by_itself(like.layout(), DefaultExec().concurrency()) ? Path::sweep : Path::pass);
  }

  /// Takes a path other than the one that suits the lattice, and that path's memory.
  /// Throws std::invalid_argument where the fields cannot be swept.
  void take(Path path) {
    if (path == Path::sweep && !can_sweep(plan_.layout))
      throw std::invalid_argument(region_ +
                                  "::take: a sweep needs two stages, a host space and, "
                                  "along a periodic y, as many rows as stages");
    path_ = path;
    release();
    if (path == Path::sweep)
      allocate_sweep();
    else
      allocate_pass();
  }
  Path path() const { return path_; }

  /// Bytes of work memory.
  std::size_t work_bytes() const {
    std::size_t bytes = sum_.bytes() + residual_.bytes() + buffers_.size() * sizeof(Real);
    for (auto const& level : levels_) bytes += level.bytes();
    constexpr int distinct = detail::keeps_sum<Tableau, Update> ? 1 : stages;
    for (int i = 0; i < distinct; ++i) bytes += increments_[i].bytes();
    return bytes;
  }
  /// The same, foretold, for so many threads, and for generators that are made ready knowing the
  /// time alone or not.
  static std::size_t work_bytes(Lattice const& lattice, bool by_time_alone, int threads) {
    auto const layout = detail::RowLayout::of<Real>(lattice);
    std::size_t const field = layout.allocation(3) * sizeof(Real);
    if (!by_time_alone || !sweeps_by_itself(layout, threads)) return work_fields * field;
    std::size_t const fields = 1 + detail::is_compensated<Update>;
    return fields * field + sweep_plan(layout, threads).size() * sizeof(Real);
  }

  /// Advances `spins` from t to t + dt under `generator`. A step may exchange the memory of
  /// `spins` with its own, so take arrays of `spins` anew after it.
  /// Throws std::invalid_argument when `spins` is not of the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    detail::check_access<Exec, typename Spins::memory_space>();
    Kokkos::Profiling::ScopedRegion const region(region_);
    if (!(spins.lattice() == lattice_))
      throw std::invalid_argument(region_ + "::step: the spins are not of the stepper's lattice");
    if constexpr (has_sweep && detail::is_host_execution<Exec>) {
      if (path_ == Path::sweep) {
        if (detail::needs_time_alone(generator, exec, spins))
          return sweep(exec, generator, spins, t, dt);
        take(Path::pass);
      }
    }
    stages_from<0>(exec, generator, spins, t, dt);
    if constexpr (stages == 1) swap(spins, levels_[0]);
  }

  /// Forgets what rounding left over of the spins of the step before.
  void reset() requires(detail::is_compensated<Update>) {
    DefaultExec const exec;
    Kokkos::deep_copy(exec, residual_.allocation(), Real(0));
    exec.fence(region_ + "::reset");
  }

  /// Can `batch` take these steps? Few spins on a host space, under a generator that is the same at
  /// every step.
  template <class Exec, class Generator>
  bool takes_batches(Exec const& exec, Generator const& generator, Spins const& spins) const {
    return path_ == Path::pass && detail::runs_on_calling_thread<Exec>(spins.sites()) &&
           detail::is_stationary(generator, exec, spins);
  }

  /// `count` steps in one launch, to the same bits as one by one.
  template <class Exec, class Generator>
  void batch(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt,
             std::int64_t count) {
    Kokkos::Profiling::ScopedRegion const region(region_);
    auto const prepared = detail::prepare_term(generator, exec, spins, t);
    constexpr int steps = stages == 1 ? 2 : 1;  // of one pass through the kernels
    detail::repeat_on_calling_thread(batch_label_, count / steps,
                                     loops_of_steps(prepared, spins, dt));
    if (count % steps != 0) step(exec, generator, spins, t, dt);
  }

 private:
  static constexpr int stages = Tableau::stages;
  static constexpr int level_count = detail::level_fields<Tableau, Update>();
  using Fields = detail::StageFields<Real, stages>;
  using DefaultExec = typename Spins::memory_space::execution_space;
  using Residual = SiteField<Real, 3, typename Spins::memory_space>;
  using Buffers = Kokkos::View<Real*, typename Spins::memory_space>;

  static constexpr bool has_sweep =
      stages > 1 &&
      stages <= detail::SweepPlan::most_stages&& detail::is_host_execution<DefaultExec>;

  static bool can_sweep(detail::RowLayout const& layout) {
    return has_sweep && (!layout.periodic[1] || layout.ny == 1 || layout.ny >= stages);
  }
  // Not while all fields stay in the caches of the cores.
  static bool sweeps_by_itself(detail::RowLayout const& layout, int threads) {
    return can_sweep(layout) && layout.rows() > 1 &&
           (work_fields + 1) * layout.allocation(3) * sizeof(Real) >
               static_cast<std::size_t>(threads) * detail::core_cache_bytes();
  }
  static detail::SweepPlan sweep_plan(detail::RowLayout const& layout, int threads) {
    if constexpr (has_sweep) {
      return detail::SweepPlan::of<Real, detail::StageBuffers<Tableau, Update>>(
          layout, threads, detail::core_cache_bytes() / 2);
    } else {
      detail::SweepPlan plan;
      plan.layout = layout;
      return plan;
    }
  }

  void release() {
    residual_ = {};
    levels_ = {};
    increments_ = {};
    sum_ = Spins();
    buffers_ = {};
  }
  void allocate_pass() {
    for (int i = 0; i < level_count; ++i)
      levels_[i] = Spins(name_ + "::level_" + std::to_string(i + 1), lattice_);
    if constexpr (detail::keeps_sum<Tableau, Update>) {
      sum_ = Spins(name_ + "::sum", lattice_);
      Spins const last_increment(name_ + "::increment", lattice_);
      for (int i = 0; i + 1 < stages; ++i) increments_[i] = last_increment;
    } else {
      for (int i = 0; i + 1 < stages; ++i)
        if (detail::stores_increment<Tableau, Update>(i))
          increments_[i] = Spins(name_ + "::increment_" + std::to_string(i + 1), lattice_);
    }
    settle();
  }
  void allocate_sweep() {
    if constexpr (has_sweep) {
      levels_[0] = Spins(name_ + "::next", lattice_);
      buffers_ = Buffers(
          Kokkos::view_alloc(Kokkos::WithoutInitializing, "cayspin::" + name_ + "::buffers"),
          plan_.size());
      detail::advise_huge_pages(buffers_.data(), buffers_.size() * sizeof(Real));
      detail::for_each_task(DefaultExec(), region_ + "::fill_buffers", plan_.parts(),
                            lattice_.sites(),
                            detail::FillSweepBuffers<Real>{buffers_.data(), plan_});
      settle();
    }
  }
  // Stores go around the caches where the fields are larger than those. A sweep comes back to what
  // it has written a whole step later, when of a cache that is shared not much is left.
  void settle() {
    if constexpr (detail::is_compensated<Update>)
      residual_ = Residual(name_ + "::residual", lattice_);
    if constexpr (detail::is_host_execution<DefaultExec>) {
      std::size_t const cache = detail::last_level_cache_bytes();
      streaming_ = levels_[0].bytes() + work_bytes() >
                   (path_ == Path::sweep ? std::min(cache, detail::usual_cache_bytes) : cache);
    }
  }

  template <int Stage>
  Spins const& level(Spins const& spins) const {
    return Stage == 0 ? spins : levels_[(Stage + level_count - 1) % level_count];
  }

  template <int Stage, class Prepared>
  auto kernel(Prepared prepared, double dt) const {
    using Plain = typename detail::PlainUpdate<Update>::type;
    constexpr bool as_plain = Stage + 1 < stages && !detail::recovers_increments<Tableau, Plain>();
    return detail::RungeKuttaStage<Tableau, std::conditional_t<as_plain, Plain, Update>, Isotropy,
                                   Stage, Prepared, Real>{std::move(prepared), isotropy_,
                                                          static_cast<Real>(dt)};
  }

  template <int Stage>
  Fields fields(Spins const& spins) const {
    constexpr bool last = Stage == stages - 1;
    constexpr bool in_place = last && stages > 1;
    constexpr bool keeps_sum = detail::keeps_sum<Tableau, Update>;
    constexpr bool recovers = detail::recovers_increments<Tableau, Update>();
    Spins const& next = in_place ? spins : levels_[Stage % level_count];
    Fields fields;
    fields.start = spins.array();
    fields.level = level<Stage>(spins).array();
    for (int i = 0; i < Stage; ++i)
      fields.increments[i] = recovers ? levels_[i].array() : increments_[i].array();
    if constexpr (!last)
      fields.increment = increments_[Stage].output(streaming_ && (Stage == 0 || !keeps_sum));
    if constexpr (keeps_sum) fields.sum = sum_.output(streaming_);
    fields.next = next.output(streaming_ && !in_place);
    if constexpr (last && detail::is_compensated<Update>) fields.residual = residual_.array();
    return fields;
  }

  template <int Stage, class Exec, class Generator>
  void stages_from(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                   double dt) {
    auto prepared =
        detail::prepare_term(generator, exec, level<Stage>(spins), t + Tableau::c[Stage] * dt);
    detail::run_pass(exec, labels_[Stage], spins.layout(), kernel<Stage>(std::move(prepared), dt),
                     fields<Stage>(spins));
    if constexpr (Stage + 1 < stages) stages_from<Stage + 1>(exec, generator, spins, t, dt);
  }

  template <class Exec, class Generator>
  void sweep(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    [&]<int... Stage>(std::integer_sequence<int, Stage...>) {
      auto const kernel_at = [&]<int S>(std::integral_constant<int, S>) {
        return kernel<S>(detail::prepare_term(generator, exec, spins, t + Tableau::c[S] * dt), dt);
      };
      std::tuple const kernels{kernel_at(std::integral_constant<int, Stage>{})...};
      detail::SweepLoop<Tableau, Update, Real,
                        std::tuple_element_t<Stage, decltype(kernels)>...> const loop{
          kernels,           plan_,          spins.array(), levels_[0].output(streaming_),
          residual_.array(), buffers_.data()};
      detail::for_each_task(exec, sweep_label_, plan_.parts(), spins.sites(), loop);
    }
    (std::make_integer_sequence<int, stages>{});
    swap(spins, levels_[0]);
  }

  // The kernels of one step; of two where each step exchanges the memory of spins and level.
  template <class Prepared>
  auto loops_of_steps(Prepared const& prepared, Spins& spins, double dt) {
    auto const loop = [&]<int Stage>(std::integral_constant<int, Stage>) {
      return detail::StageRowLoop(kernel<Stage>(prepared, dt), fields<Stage>(spins),
                                  spins.layout());
    };
    if constexpr (stages == 1) {
      constexpr std::integral_constant<int, 0> only;
      auto const first = loop(only);
      swap(spins, levels_[0]);
      auto const second = loop(only);
      swap(spins, levels_[0]);
      return std::tuple(first, second);
    } else {
      return [&]<int... Stage>(std::integer_sequence<int, Stage...>) {
        return std::tuple(loop(std::integral_constant<int, Stage>{})...);
      }
      (std::make_integer_sequence<int, stages>{});
    }
  }

  std::string name_, region_, batch_label_, sweep_label_;
  std::array<std::string, stages> labels_;
  Isotropy isotropy_;
  Lattice lattice_;
  detail::SweepPlan plan_;
  Path path_ = Path::pass;
  std::array<Spins, level_count> levels_;  // the first one only, in a sweep
  std::array<Spins, stages> increments_;   // one field in all places where keeps_sum
  Spins sum_;
  Residual residual_;
  Buffers buffers_;
  bool streaming_ = false;
};

}  // namespace cayspin
