// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/batch.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stepper/runge_kutta_stage.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <array>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace cayspin {

/// An explicit one-step method on a spin field: a tableau, and the geometry by which increments
/// move spins (cayspin::update). Holds all work memory; one fused kernel per stage.
template <class Spins, class Tableau, class Update, class Isotropy>
class RungeKutta {
 public:
  using spins_type = Spins;
  using tableau_type = Tableau;
  using update_type = Update;
  using Real = typename Spins::value_type;
  static constexpr int order = Tableau::order;
  static constexpr int evaluations = Tableau::stages;  // of the generator, per step
  /// Fields of three numbers per site beside the spins.
  static constexpr int work_fields = detail::work_fields<Tableau, Update>();

  /// Allocates work memory for fields shaped like `like`. `name` labels kernels and memory.
  explicit RungeKutta(std::string const& name, Spins const& like, Isotropy isotropy = {})
      : region_("cayspin::" + name), batch_label_(region_ + "::batch"), isotropy_(isotropy) {
    for (int i = 0; i < stages; ++i) labels_[i] = region_ + "::stage_" + std::to_string(i + 1);
    for (int i = 0; i < level_count; ++i)
      levels_[i] = Spins(name + "::level_" + std::to_string(i + 1), like.lattice());
    if constexpr (detail::keeps_sum<Tableau, Update>) {
      sum_ = Spins(name + "::sum", like.lattice());
      Spins const last_increment(name + "::increment", like.lattice());
      for (int i = 0; i + 1 < stages; ++i) increments_[i] = last_increment;
    } else {
      for (int i = 0; i + 1 < stages; ++i)
        if (detail::stores_increment<Tableau, Update>(i))
          increments_[i] = Spins(name + "::increment_" + std::to_string(i + 1), like.lattice());
    }
    using Exec = typename Spins::memory_space::execution_space;
    if constexpr (detail::is_host_execution<Exec>)
      streaming_ = like.bytes() + work_bytes() > detail::last_level_cache_bytes();
  }

  /// Bytes of work memory.
  std::size_t work_bytes() const { return work_fields * levels_[0].bytes(); }

  /// Advances `spins` from t to t + dt under `generator`. A one-stage method exchanges the memory
  /// of `spins` with its own, so take arrays of `spins` anew after a step.
  /// Throws std::invalid_argument when `spins` is not of the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    detail::check_access<Exec, typename Spins::memory_space>();
    Kokkos::Profiling::ScopedRegion const region(region_);
    if (!(spins.lattice() == levels_[0].lattice()))
      throw std::invalid_argument(region_ + "::step: the spins are not of the stepper's lattice");
    stages_from<0>(exec, generator, spins, t, dt);
    if constexpr (stages == 1) swap(spins, levels_[0]);
  }

  /// Can `batch` take these steps? Few spins on a host space, under a generator that is the same at
  /// every step.
  template <class Exec, class Generator>
  bool takes_batches(Exec const& exec, Generator const& generator, Spins const& spins) const {
    return detail::runs_on_calling_thread<Exec>(spins.sites()) &&
           detail::is_stationary(generator, exec, spins);
  }

  /// `count` steps in one launch, to the same bits as one by one.
  template <class Exec, class Generator>
  void batch(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt,
             std::int64_t count) {
    Kokkos::Profiling::ScopedRegion const region(region_);
    auto const prepared = detail::prepare_term(generator, exec, spins, t);
    constexpr int steps = stages == 1 ? 2 : 1;  // of one pass through the kernels
    detail::repeat_on_calling_thread<Real>(batch_label_, spins.layout(), count / steps,
                                           kernels_of_steps(prepared, spins, dt));
    if (count % steps != 0) step(exec, generator, spins, t, dt);
  }

 private:
  static constexpr int stages = Tableau::stages;
  static constexpr int level_count = detail::level_fields<Tableau, Update>();

  template <int Stage>
  Spins const& level(Spins const& spins) const {
    return Stage == 0 ? spins : levels_[(Stage + level_count - 1) % level_count];
  }

  template <int Stage, class Prepared>
  auto kernel(Prepared prepared, Spins const& spins, double dt) const {
    constexpr bool last = Stage == stages - 1;
    constexpr bool in_place = last && stages > 1;
    Spins const& next = in_place ? spins : levels_[Stage % level_count];
    using Kernel = detail::RungeKuttaStage<Tableau, Update, Isotropy, Stage, Prepared, Real>;
    constexpr bool keeps_sum = detail::keeps_sum<Tableau, Update>;
    Kernel kernel{.generator = std::move(prepared),
                  .isotropy = isotropy_,
                  .start = spins.array(),
                  .level = level<Stage>(spins).array(),
                  .increments = {},
                  .sum = {},
                  .increment = {},
                  .next = next.output(streaming_ && !in_place),
                  .dt = static_cast<Real>(dt)};
    constexpr bool recovers = detail::recovers_increments<Tableau, Update>();
    for (int i = 0; i < Stage; ++i)
      kernel.increments[i] = recovers ? levels_[i].array() : increments_[i].array();
    if constexpr (!last)
      kernel.increment = increments_[Stage].output(streaming_ && (Stage == 0 || !keeps_sum));
    if constexpr (keeps_sum) kernel.sum = sum_.output(streaming_);
    return kernel;
  }

  template <int Stage, class Exec, class Generator>
  void stages_from(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                   double dt) {
    auto prepared =
        detail::prepare_term(generator, exec, level<Stage>(spins), t + Tableau::c[Stage] * dt);
    detail::for_each_site<Real>(exec, labels_[Stage], spins.layout(),
                                kernel<Stage>(std::move(prepared), spins, dt));
    if constexpr (Stage + 1 < stages) stages_from<Stage + 1>(exec, generator, spins, t, dt);
  }

  // The kernels of one step; of two where each step exchanges the memory of spins and level.
  template <class Prepared>
  auto kernels_of_steps(Prepared const& prepared, Spins& spins, double dt) {
    if constexpr (stages == 1) {
      auto const first = kernel<0>(prepared, spins, dt);
      swap(spins, levels_[0]);
      auto const second = kernel<0>(prepared, spins, dt);
      swap(spins, levels_[0]);
      return std::tuple(first, second);
    } else {
      return [&]<int... Stage>(std::integer_sequence<int, Stage...>) {
        return std::tuple(kernel<Stage>(prepared, spins, dt)...);
      }
      (std::make_integer_sequence<int, stages>{});
    }
  }

  std::string region_;
  std::string batch_label_;
  std::array<std::string, stages> labels_;
  std::array<Spins, level_count> levels_;
  std::array<Spins, stages> increments_;  // one field in all places where keeps_sum
  Spins sum_;
  Isotropy isotropy_;
  bool streaming_ = false;
};

}  // namespace cayspin
