// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "dear_method.hpp"
#include "guard.hpp"
#include "rest_search.hpp"
#include "run_noise.hpp"
#include "simulate.hpp"
#include "thermal.hpp"

#include <cayspin/exchange_memory.hpp>
#include <cayspin/observer/energy_control.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation {

/// A scene in memory with its method, the guard of its numbers, and what changes its spins between
/// steps: the control of its energy, or the noise of its temperature.
template <class Real, class Space>
class RunningScene : public Simulation<Real, Space> {
  using Base = Simulation<Real, Space>;

 public:
  using typename Base::Spins;
  using Looks = RunObserver<Space, Spins>;

  /// What a look came to.
  struct Found {
    Sample sample;
    std::optional<std::string> failure = {};  // of the guard
    // By the scene's until_torque. At a saddle of the energy a run goes on; its last look tells.
    bool at_rest = false, at_saddle = false;
  };

  RunningScene(io::Scene const& scene, Plan const& plan, Times const& times,
               std::vector<double> const& start)
      : Base(scene, plan.lattice, times, start),
        method_(open_method(scene, plan, static_cast<Base*>(this))),
        guard_(scene, epsilon),
        last_change_(plan.features->last_change) {
    if (auto const& bound = scene.integrator.until_torque) {
      torque_.emplace(this->generator.precession_alone());
      rest_.emplace(scene, *bound);
    }
    if (scene.integrator.energy_control) control_.emplace(this->spins, this->generator);
    if (is_thermal(scene)) noise_.emplace(scene, this->generator, this->spins);
  }
  RunningScene(RunningScene const&) = delete;  // the method works on this one
  RunningScene& operator=(RunningScene const&) = delete;

  /// Runs to the end of the times, or as far as the numbers or the looks let it. Costs of control
  /// and noise count with those of the steps.
  Ending advance(Looks& looks) {
    if (!control_ && !noise_) return Base::advance(*method_, looks);
    Between between(*this, looks);
    std::int64_t const evaluations = control_ ? control_->evaluations_done() : 0;
    if (noise_) noise_->take_seconds();
    auto ending = Base::advance(*method_, between);
    if (control_) ending.summary.evaluations += control_->evaluations_done() - evaluations;
    if (noise_) ending.summary.step_seconds += noise_->take_seconds();
    return ending;
  }

  Guard const& guard() const { return guard_; }

  /// Samples and judges the spins. Rest is looked for where the scene has until_torque, and
  /// `for_rest` is not false; `at_end` asks for saddles, too.
  Found look(Space const& exec, Step const& step, Spins const& spins, bool for_rest = true,
             bool at_end = false) {
    bool const with_torque = torque_ && for_rest;
    Found found{with_torque ? sample_scene(exec, this->generator, step, spins, *torque_)
                            : sample_scene(exec, this->generator, step, spins)};
    auto const& now = found.sample;
    found.failure = guard_.judge(step, now.energy, now.norm_defect);
    if (with_torque && !found.failure) {
      auto const rest = rest_->look(
          exec, step, spins, this->generator.landau_lifshitz().field().made_for(FieldFor::energy),
          now.largest_rate, now.energy.value < guard_.first_energy(), at_end);
      found.at_rest = rest.at_minimum && step.time >= last_change_;
      found.at_saddle = rest.at_saddle;
    }
    return found;
  }

  /// For after the spins were replaced: forgets what was known of the earlier ones.
  void begin_again(io::Scene const& scene) {
    guard_ = Guard(scene, epsilon);
    if (rest_) rest_->begin_again();
    if (control_) control_->reset();
    if (noise_) noise_->reset();
  }

  /// Stores or restores all that a run needs to go on from a step with the same bits. `continues`:
  /// does the method go on with what it remembers?
  void exchange(Checkpoint& checkpoint, bool& continues) {
    this->exec.fence("cayspin::RunningScene: exchange");
    cayspin::detail::ExchangeMemory const visit(checkpoint);
    visit("spins", this->spins);
    visit("continues", continues);
    method_->exchange_memory(checkpoint);
    exchange_memory(guard_, checkpoint, "guard.");
    if (rest_) exchange_memory(*rest_, checkpoint, "rest.");
    if (control_) exchange_memory(*control_, checkpoint, "energy_control.");
    if (noise_ && checkpoint.restores()) noise_->reset();
  }

 private:
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();

  /// The looks, and after or around them what changes the spins.
  class Between final : public Looks {
   public:
    Between(RunningScene& scene, Looks& looks) : scene_(scene), looks_(looks) {}

    bool due(Step const&) const override { return true; }
    Next operator()(Space const& exec, Step const& step, Spins const& spins) override {
      bool const wanted = looks_.due(step);
      if (auto& noise = scene_.noise_)
        return (*noise)(exec, step, scene_.times.first, spins, wanted,
                        [&] { return looks_(exec, step, spins); });
      if (wanted && looks_(exec, step, spins) == Next::stop) return Next::stop;
      if (!step.last) (*scene_.control_)(exec, step, spins);
      return Next::proceed;
    }

   private:
    RunningScene& scene_;
    Looks& looks_;
  };

  std::unique_ptr<OpenMethod> method_;
  Guard guard_;
  double last_change_;  // of what depends on t
  std::optional<SceneGenerator<Spins>> torque_;
  std::optional<RestSearch<Real, Space>> rest_;
  std::optional<EnergyControl<Spins, SceneGenerator<Spins>>> control_;
  std::optional<RunNoise<Spins>> noise_;
};

}  // namespace cayspin::simulation
