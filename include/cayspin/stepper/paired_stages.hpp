// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stage/pair.hpp>
#include <cayspin/stage/step_in_tiles.hpp>
#include <cayspin/stepper/runge_kutta.hpp>

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

/// A chain of two or four stages, for example PairedStages<Rkmk4<Spins>>, that takes two stages at
/// a time in one pass over the lattice if the spins are on a device: the spins between the two stay
/// in the scratch memory of the device's teams. A step then moves less memory, and the result is
/// bitwise identical. Small films and chains take all stages of a step in one launch. With one
/// stage, as in LieEuler, it takes two steps at a time, where integrate() takes batches. On host
/// spaces, for which RungeKutta has sweeps, on other narrow lattices and on parts, and for
/// generators that need all spins of a stage beforehand, it takes the steps of Stepper.
template <class Stepper>
  requires requires {
    typename Stepper::tableau_type;
    typename Stepper::update_type;
  }
class PairedStages
    : public RungeKutta<typename Stepper::spins_type, typename Stepper::tableau_type,
                        typename Stepper::update_type, typename Stepper::isotropy_type> {
  using Spins = typename Stepper::spins_type;
  using Tableau = typename Stepper::tableau_type;
  using Update = typename Stepper::update_type;
  using Base = RungeKutta<Spins, Tableau, Update, typename Stepper::isotropy_type>;
  static_assert((Tableau::stages == 1 || Tableau::stages == 2 || Tableau::stages == 4) &&
                    detail::is_chain<Tableau>(),
                "PairedStages belongs to chains of one, two or four stages, such as LieEuler, "
                "LieHeun and Rkmk4.");
  template <class Exec>
  static constexpr bool pairs_stages = !detail::is_host_execution<Exec> && Tableau::stages > 1;
  template <class Exec>
  static constexpr bool pairs_steps = !detail::is_host_execution<Exec> && Tableau::stages == 1 &&
                                      detail::carried_fields<Update>() == 0;

 public:
  using typename Base::Real;

  explicit PairedStages(Spins const& like, typename Stepper::isotropy_type isotropy = {})
      : Base("PairedStages", like, isotropy) {}

  /// Like RungeKutta::step.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    if constexpr (pairs_stages<Exec>) {
      using Isotropy = typename Stepper::isotropy_type;
      auto const& layout = spins.layout();
      bool const in_tiles = detail::has_steps_in_tiles<Exec, Real>(layout, Tableau::stages) &&
                            detail::is_stationary(generator, exec, spins);
      bool const in_pairs = detail::has_pairs<Exec, Real>(layout) &&
                            detail::stages_need_only_time<Isotropy>(generator, exec, spins);
      if (in_tiles || in_pairs) {
        auto const region = this->begin_step(exec, spins);
        this->require_other_memory(spins, memory_.end());
        if ((in_tiles && step_in_tiles(exec, generator, spins, t, dt)) ||
            (in_pairs && pairs_from<0>(exec, generator, spins, t, dt)))
          return swap(spins, memory_.end());
      }
    }
    Base::step(exec, generator, spins, t, dt);
  }

  /// Like RungeKutta::takes_batches. A method of one stage also takes them on a large lattice.
  template <class Exec, class Generator>
  bool takes_batches(Exec const& exec, Generator const& generator, Spins const& spins) const {
    return Base::takes_batches(exec, generator, spins) || takes_pairs(exec, generator, spins);
  }

  /// Like RungeKutta::batch.
  template <class Exec, class Generator>
  void batch(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt,
             std::int64_t count) {
    if constexpr (pairs_steps<Exec>) {
      if (!Base::takes_batches(exec, generator, spins) && takes_pairs(exec, generator, spins)) {
        auto const region = this->begin_step(exec, spins, "::batch");
        this->require_steps(count);
        this->require_other_memory(spins, memory_.end());
        for (; count > 1; count -= 2) {
          auto const each = stage<0>(exec, generator, spins, t, dt);
          if (!detail::run_pair(exec, this->labels_[0], spins.layout(), each, each)) break;
          swap(spins, memory_.end());
        }
        for (; count > 0; --count) Base::step(exec, generator, spins, t, dt);
        return;
      }
    }
    Base::batch(exec, generator, spins, t, dt, count);
  }

 private:
  using Base::memory_;

  template <class Exec, class Generator>
  bool takes_pairs(Exec const& exec, Generator const& generator, Spins const& spins) const {
    if constexpr (pairs_steps<Exec>)
      return detail::has_pairs<Exec, Real>(spins.layout()) &&
             detail::is_stationary(generator, exec, spins);
    else
      return false;
  }

  template <int Stage, class Exec, class Generator>
  auto stage(Exec const& exec, Generator const& generator, Spins const& spins, double t,
             double dt) {
    auto fields = this->template fields<Stage>(spins);
    if constexpr (Stage + 1 == Tableau::stages) fields.next = memory_.end().output(false);
    return detail::StageOnSite(
        this->template kernel<Stage>(detail::prepare_stage<typename Stepper::isotropy_type>(
                                         generator, exec, spins, t + Tableau::c[Stage] * dt),
                                     dt),
        fields);
  }

  template <class Exec, class Generator>
  bool step_in_tiles(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                     double dt) {
    return [&]<int... Stage>(std::integer_sequence<int, Stage...>) {
      return detail::run_step_in_tiles(exec, all_label_, spins.layout(),
                                       stage<Stage>(exec, generator, spins, t, dt)...);
    }(std::make_integer_sequence<int, Tableau::stages>{});
  }

  template <int Stage, class Exec, class Generator>
  bool pairs_from(Exec const& exec, Generator const& generator, Spins const& spins, double t,
                  double dt) {
    if constexpr (Stage < Tableau::stages) {
      bool const ran = detail::run_pair(exec, this->labels_[Stage + 1], spins.layout(),
                                        stage<Stage>(exec, generator, spins, t, dt),
                                        stage<Stage + 1>(exec, generator, spins, t, dt));
      return ran && pairs_from<Stage + 2>(exec, generator, spins, t, dt);
    }
    return true;
  }

  std::string all_label_ = this->label("::all_stages");
};

}  // namespace cayspin::inline v0_2
