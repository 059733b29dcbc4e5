// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/batch.hpp>
#include <cayspin/detail/batch_in_teams.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stage/kernel.hpp>
#include <cayspin/stage/memory.hpp>
#include <cayspin/stage/pass.hpp>
#include <cayspin/stepper/staged_stepper.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

/// An explicit one-step method on a spin field: a tableau, and an update that moves spins by
/// increments (cayspin::update). Owns all work memory.
template <class Spins, class Tableau, class Update, class Isotropy>
class RungeKutta : public detail::StagedStepper<Spins, Tableau, Update, Isotropy,
                                                detail::StageMemory<Spins, Tableau, Update>> {
  using Base = detail::StagedStepper<Spins, Tableau, Update, Isotropy,
                                     detail::StageMemory<Spins, Tableau, Update>>;
  // On devices, the kernels of methods with more stages would take long to compile.
  template <class Exec>
  static constexpr bool has_batches = detail::is_host_execution<Exec> || Tableau::stages <= 4;

 public:
  using typename Base::Real;
  using tableau_type = Tableau;
  using update_type = Update;
  using isotropy_type = Isotropy;
  static constexpr int order = Tableau::order;
  static constexpr int evaluations = Tableau::stages;  // generator evaluations per step

  /// Allocates work memory for fields shaped like `like`. `name` labels kernels and memory.
  explicit RungeKutta(std::string const& name, Spins const& like, Isotropy isotropy = {})
      : Base(name, like, isotropy, {name, like.lattice()}) {}

  /// Advances `spins` from t to t + dt under `generator`. A step may swap the memory of `spins`
  /// with that of the stepper, so call spins.array() again after it. Throws std::invalid_argument
  /// when `spins` is not on the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    if (exchanges()) this->require_other_memory(spins, memory_.end());
    if constexpr (Base::Sweeps::possible && detail::is_host_execution<Exec>) {
      if (this->path() == Path::sweep) {
        if (detail::stages_need_only_time<Isotropy>(generator, exec, spins)) {
          sweep(exec, generator, spins, t, dt);
          return update_ghosts(exec, spins);
        }
        this->use(Path::pass);
      }
    }
    stages_from<0>(exec, generator, spins, t, dt);
    if constexpr (stages == 1) swap(spins, memory_.end());
    update_ghosts(exec, spins);
  }

  /// Forgets the rounding error of the last step.
  void reset()
    requires(detail::carried_fields<Update>() > 0)
  {
    memory_.forget(this->label("::reset"));
  }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit)
    requires(detail::carried_fields<Update>() > 0)
  {
    memory_.visit_carried(visit);
  }

  /// Visits the field whose memory a step may swap with that of the spins, for cayspin::integrate.
  template <class Visit>
  void visit_exchanged(Visit const& visit) {
    visit(memory_.end());
  }

  /// Returns true if `batch` can take steps of these spins. The generator must not change between
  /// steps, stages have to run as passes, and the spins must not be on a part of a lattice. On a
  /// host space there have to be few spins. On a device each replica has to have few spins, and the
  /// method at most four stages.
  template <class Exec, class Generator>
  bool takes_batches(Exec const& exec, Generator const& generator, Spins const& spins) const {
    return has_batches<Exec> && this->path() == Path::pass && this->lattice_.part == nullptr &&
           is_small(exec, spins) && detail::is_stationary(generator, exec, spins);
  }

  /// Takes `count` steps in few launches; the result is bitwise identical to that of `count` calls
  /// of `step`. Throws std::invalid_argument like `step`, when `count` is below 1, and when
  /// takes_batches is false.
  template <class Exec, class Generator>
    requires(has_batches<Exec>)
  void batch(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt,
             std::int64_t count) {
    auto const region = this->begin_step(exec, spins, "::batch");
    this->require_steps(count);
    if (exchanges()) this->require_other_memory(spins, memory_.end());
    auto const prepared = detail::prepare_term(generator, exec, spins, t);
    if (!takes_batches(exec, generator, spins))
      throw std::invalid_argument(
          this->label("::batch: these steps have to be taken one by one (takes_batches)"));
    constexpr int steps = stages == 1 ? 2 : 1;  // in one pass through the loops
    auto const loops = loops_of_steps<Exec>(prepared, spins, dt);
    if constexpr (detail::is_host_execution<Exec>)
      detail::repeat_on_calling_thread(batch_label_, count / steps, loops);
    else
      std::apply(
          [&](auto const&... stage) {
            detail::repeat_in_teams<Real>(exec, batch_label_, count / steps, spins.layout(),
                                          stage...);
          },
          loops);
    if (count % steps != 0) step(exec, generator, spins, t, dt);
  }

 protected:
  using Base::stages, Base::labels_, Base::isotropy_, Base::memory_;

  template <int Stage, class Prepared>
  auto kernel(Prepared prepared, double dt) const {
    using Plain = typename detail::PlainUpdate<Update>::type;
    constexpr bool as_plain = Stage + 1 < stages && !detail::recovers_increments<Tableau, Plain>();
    return detail::RungeKuttaStage<Tableau, std::conditional_t<as_plain, Plain, Update>, Isotropy,
                                   Stage, Prepared, Real>{std::move(prepared), isotropy_,
                                                          static_cast<Real>(dt)};
  }
  template <int Stage>
  auto fields(Spins const& spins) const {
    return memory_.template arrays<detail::StageDataFlow<Tableau, Update, Stage>>(spins);
  }

 private:
  template <class Exec>
  void update_ghosts(Exec const& exec, Spins const& spins) const {
    memory_.with_carried([&](auto const&... carried) {
      detail::update_ghosts(exec, this->lattice_, spins, carried...);
    });
  }

  /// Returns true if a step swaps the memory of the spins.
  bool exchanges() const { return stages == 1 || this->path() == Path::sweep; }

  template <int Stage, class Exec, class Generator>
  void stages_from(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                   double dt) {
    auto prepared = detail::prepare_stage<Isotropy>(
        generator, exec, memory_.template level<Stage>(spins), t + Tableau::c[Stage] * dt);
    detail::run_pass(exec, labels_[Stage], spins.layout(), kernel<Stage>(std::move(prepared), dt),
                     fields<Stage>(spins));
    if constexpr (Stage + 1 < stages) stages_from<Stage + 1>(exec, generator, spins, t, dt);
  }

  template <class Exec, class Generator>
  void sweep(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    [&]<int... Stage>(std::integer_sequence<int, Stage...>) {
      auto const kernel_at = [&]<int S>(std::integral_constant<int, S>) {
        return kernel<S>(
            detail::prepare_stage<Isotropy>(generator, exec, spins, t + Tableau::c[S] * dt), dt);
      };
      this->sweep_through(exec, spins,
                          std::tuple{kernel_at(std::integral_constant<int, Stage>{})...});
    }(std::make_integer_sequence<int, stages>{});
    swap(spins, memory_.end());
  }

  template <class Exec>
  static bool is_small(Exec const& exec, Spins const& spins) {
    if constexpr (detail::is_host_execution<Exec>)
      return detail::runs_on_calling_thread<Exec>(spins.sites());
    else
      return detail::ReplicaTeams::suit(exec, spins.layout());
  }

  // Returns the stages of one step, or of two if each step swaps the memory of the spins: on hosts
  // as loops over the sites, on devices as functors of one site.
  template <class Exec, class Prepared>
  auto loops_of_steps(Prepared const& prepared, Spins& spins, double dt) {
    auto const loop = [&]<int Stage>(std::integral_constant<int, Stage>) {
      if constexpr (detail::is_host_execution<Exec>)
        return detail::StageRowLoop(kernel<Stage>(prepared, dt), fields<Stage>(spins),
                                    spins.layout());
      else
        return detail::StageOnSite(kernel<Stage>(prepared, dt), fields<Stage>(spins));
    };
    if constexpr (stages == 1) {
      constexpr std::integral_constant<int, 0> only;
      auto const first = loop(only);
      swap(spins, memory_.end());
      auto const second = loop(only);
      swap(spins, memory_.end());
      return std::tuple(first, second);
    } else {
      return [&]<int... Stage>(std::integer_sequence<int, Stage...>) {
        return std::tuple(loop(std::integral_constant<int, Stage>{})...);
      }(std::make_integer_sequence<int, stages>{});
    }
  }

  std::string batch_label_ = this->label("::batch");
};

}  // namespace cayspin::inline v0_2
