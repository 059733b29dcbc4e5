// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "thermal.hpp"

#include <cayspin/observer/record.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace cayspin::simulation {

/// Returns true if each spin that moves is damped.
bool all_are_damped(io::Scene const& scene);

inline bool energy_must_fall(io::Scene const& scene, bool all_damped) {
  return scene.system.kind == io::SystemKind::llg && all_damped && !is_thermal(scene) &&
         !io::has_torque(scene.field) && !io::depends_on_time(scene.field) &&
         !scene.field.own.nonlocal &&  // which may depend on time
         scene.integrator.energy_guard && scene.integrator.method->keeps_length;
}

/// Check of the state of a run. All numbers must be finite. If the method conserves the lengths of
/// spins, these must be 1 within 64 * epsilon at step 0. Later they must be 1 within
/// 64 * epsilon * max(step, 1e6), and always within 0.01. An energy that can only fall must not
/// rise from one check to the next by more than 64 * epsilon * Energy::magnitude. In this bound,
/// the tolerance of an adaptive method, which is an angle, replaces 64 * epsilon if it is larger.
class Guard {
 public:
  /// `epsilon`: the machine epsilon of the run's precision. A check is due after every step for up
  /// to 4096 sites, and after every tenth step for more.
  Guard(io::Scene const& scene, double epsilon) : Guard(scene, epsilon, all_are_damped(scene)) {}

  /// Returns a guard for `scene` that has seen no state. The damping of `scene` must be that of
  /// this guard's scene.
  Guard made_again(io::Scene const& scene) const { return Guard(scene, epsilon_, all_damped_); }

  static constexpr std::int64_t period_of(std::int64_t sites) { return sites <= 4096 ? 1 : 10; }

  bool due(Step const& step) const { return (step.number - begin_) % period_ == 0; }

  /// Returns what is wrong with a state, if anything: one line that starts with the step and the
  /// time.
  std::optional<std::string> judge(Step const& step, Energy const& energy, double norm_defect);

  /// Adds `change` to the energies of earlier checks. Call it after spins were replaced, with the
  /// resulting change of the energy, which no step has caused.
  void add_to_energies(double change) {
    if (first_) first_->energy += change;
    if (last_) last_->energy += change;
  }

  /// Returns the step of the last check; -1 before the first one.
  std::int64_t last_look() const { return last_ ? last_->step : -1; }
  double first_energy() const { return first_->energy; }

  /// For cayspin::serialize.
  template <class Visit>
  void visit_memory(Visit const& visit) {
    bool looked = first_.has_value();
    visit("looked", looked);
    Look first = first_.value_or(Look{}), last = last_.value_or(Look{});
    first_.reset();
    last_.reset();
    if (!looked) return;
    visit("first_step", first.step);
    visit("first_energy", first.energy);
    visit("last_step", last.step);
    visit("last_energy", last.energy);
    first_ = first;
    last_ = last;
  }

 private:
  // The dampings of sites may be in a file. made_again() does not read them again.
  Guard(io::Scene const& scene, double epsilon, bool all_damped)
      : all_damped_(all_damped),
        energy_must_fall_(energy_must_fall(scene, all_damped)),
        keeps_norm_(scene.integrator.method->keeps_length),
        epsilon_(epsilon),
        most_rise_(std::max(64 * epsilon, scene.integrator.tolerance.value_or(0))),
        units_(scene.units),
        begin_(scene.begin.step),
        period_(period_of(io::sites(scene))) {}

  struct Look {
    std::int64_t step;
    double energy;
  };
  bool all_damped_, energy_must_fall_, keeps_norm_;
  double epsilon_, most_rise_;
  io::Units units_;
  std::int64_t begin_, period_;
  std::optional<Look> first_, last_;
};

}  // namespace cayspin::simulation
