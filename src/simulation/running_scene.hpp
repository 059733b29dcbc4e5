// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "follow.hpp"
#include "guard.hpp"
#include "more_of_sample.hpp"
#include "multirate_method.hpp"
#include "rest_search.hpp"
#include "run_noise.hpp"
#include "simulate.hpp"
#include "thermal.hpp"

#include <cayspin/observer/energy_control.hpp>
#include <cayspin/serialize.hpp>

#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation {

/// A scene in memory with its method, its guard, and all that changes its spins between steps:
/// energy control, thermal noise, and a lattice that follows an object.
template <class Real, class Space>
class RunningScene : public Simulation<Real, Space> {
  using Base = Simulation<Real, Space>;

 public:
  using typename Base::Spins;
  using Looks = RunObserver<Space, Spins>;

  /// Result of an observation.
  struct Found {
    Sample sample;
    std::optional<std::string> failure = {};  // from the guard
    // Set only in scenes with until_torque. A run does not end at a saddle of the energy, but its
    // last observation reports it.
    bool at_rest = false, at_saddle = false;
  };

  RunningScene(io::Scene const& scene, Plan const& plan, Times const& times,
               std::vector<double> const& start)
      : Base(scene, plan.lattice, times, start),
        method_(open_method(scene, plan, static_cast<Base*>(this))),
        guard_(scene, epsilon),
        last_change_(plan.features->last_change),
        features_end_(io::depends_on_time(scene.field) ? plan.times.steps
                                                       : std::numeric_limits<std::int64_t>::max()) {
    if (auto const& bound = scene.integrator.until_torque) {
      torque_.emplace(this->generator.precession_alone());
      rest_.emplace(scene, *bound);
    }
    if (scene.integrator.energy_control) control_.emplace(this->spins, this->generator);
    if (is_thermal(scene)) noise_.emplace(scene, this->generator, this->spins);
    if (scene.lattice.follow) follower_.emplace(scene, plan.lattice);
    if (scene.output.regions || scene.output.terms) more_.emplace(scene, plan.lattice);
  }
  RunningScene(RunningScene const&) = delete;  // the method refers to this object
  RunningScene& operator=(RunningScene const&) = delete;

  /// Runs to the end of the times, or until a failure or a stop by `looks`. The cost of the steps
  /// includes the evaluations of energy control and the time of noise.
  Ending advance(Looks& looks) {
    if (!control_ && !noise_ && !follower_) return Base::advance(*method_, looks);
    Between between(*this, looks);
    std::int64_t const evaluations = control_ ? control_->evaluations_done() : 0;
    if (noise_) noise_->take_seconds();
    auto times_left = this->times;  // a copy, because substeps overwrite the times
    auto ending = Base::advance(*method_, between);
    // After a move of the spins, the method restarts as in a new run.
    while (between.moves() && !ending.failure) {
      times_left.first = between.move();
      times_left.continues = false;
      this->times = times_left;
      auto next = Base::advance(*method_, between);
      add(next.summary, ending.summary);
      ending.failure = next.failure;
    }
    if (control_) ending.summary.evaluations += control_->evaluations_done() - evaluations;
    if (noise_) ending.summary.step_seconds += noise_->take_seconds();
    return ending;
  }

  /// Sets the step at which the run will end, in the next call of advance() or in a later one. This
  /// has an effect only if that step is beyond the scene's end.
  void set_run_end(std::int64_t step) { run_end_ = step; }

  Guard const& guard() const { return guard_; }

  /// Returns by how many cells the lattice has moved to follow its object.
  std::int64_t shift() const { return follower_ ? follower_->shift() : 0; }
  void go_on_from(std::int64_t shift) {
    if (follower_) follower_->go_on_from(shift);
  }
  /// Takes over the shift and the state of the noise from `before`. The spins must be those of
  /// `before`, at the same step.
  void go_on_from(RunningScene const& before) {
    go_on_from(before.shift());
    if (noise_ && before.noise_) noise_->go_on_from(*before.noise_);
  }

  /// Returns the numbers of a sample that are not in Scalars, in the order of more_scalars().
  std::vector<double> more(Space const& exec, Step const& step, Spins const& spins) const {
    auto numbers = more_ ? (*more_)(exec, this->generator, step, spins) : std::vector<double>();
    if (follower_) numbers.push_back(static_cast<double>(shift()));
    return numbers;
  }

  /// Samples and checks the spins. Also checks whether they are at equilibrium, if the scene has
  /// until_torque and `for_rest` is true. With `at_end`, reports a saddle even if no search is due.
  Found look(Space const& exec, Step const& step, Spins const& spins, bool for_rest = true,
             bool at_end = false) {
    bool const with_torque = torque_ && for_rest;
    Found found{with_torque ? sample_scene(exec, this->generator, step, spins, *torque_)
                            : sample_scene(exec, this->generator, step, spins)};
    auto const& now = found.sample;
    found.failure = guard_.judge(step, now.energy, now.norm_defect);
    if (with_torque && !found.failure) {
      // Energies before and after a change of the field cannot be compared.
      double const last_change = this->last_change();
      bool const fell =
          last_change > 0 ? step.time >= last_change : now.energy.value < guard_.first_energy();
      auto const rest = rest_->look(
          exec, step, spins, this->generator.landau_lifshitz().field().made_for(FieldFor::energy),
          now.largest_rate, fell, at_end);
      found.at_rest = rest.at_minimum && step.time >= last_change;
      found.at_saddle = rest.at_saddle;
    }
    return found;
  }

  /// Call it after the spins were replaced: forgets the state that belongs to the earlier spins.
  void begin_again(io::Scene const& scene) {
    guard_ = guard_.made_again(scene);
    if (rest_) rest_->begin_again();
    reset_control();
    if (noise_) noise_->reset();
  }

  /// Stores or restores everything that a run needs to continue exactly from a step. `continues`,
  /// which is stored or restored as well: true if the method continues with its memory of earlier
  /// steps.
  void exchange(Checkpoint& checkpoint, bool& continues) {
    this->exec.fence("cayspin::RunningScene: exchange");
    cayspin::detail::ExchangeMemory const visit(checkpoint);
    visit("spins", this->spins);
    visit("continues", continues);
    method_->serialize(checkpoint);
    serialize(guard_, checkpoint, "guard.");
    if (rest_) serialize(*rest_, checkpoint, "rest.");
    if (control_) serialize(*control_, checkpoint, "energy_control.");
    if (follower_) serialize(*follower_, checkpoint, "follow.");
    // Checkpoints of earlier versions lack these numbers, which matter only after a failed step.
    auto const visit_if_there = [&](std::string const& name, std::int64_t& step) {
      try {
        visit(name, step);
      } catch (std::exception const&) {
        if (!checkpoint.restores()) throw;
        step = -1;
      }
    };
    if (control_) visit_if_there("energy_control.corrected", corrected_);
    if (noise_) noise_->visit_memory(visit_if_there);
  }

 private:
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();

  /// Observer that calls the run's observer, and changes the spins before and after that call.
  class Between final : public Looks {
   public:
    Between(RunningScene& scene, Looks& looks) : scene_(scene), looks_(looks) {}

    bool due(Step const& step) const override {
      return scene_.control_ || scene_.noise_ || wants(step);
    }
    Next operator()(Space const& exec, Step const& step, Spins const& spins) override {
      bool const wanted = wants(step);
      auto const look = [&] { return this->look(exec, step, spins); };
      if (auto& noise = scene_.noise_)
        return (*noise)(exec, step, scene_.times.first, spins, wanted, look);
      if (wanted && look() == Next::stop) return Next::stop;
      if (scene_.control_ && !step.last) scene_.correct(exec, step, spins);
      return Next::proceed;
    }

    /// Returns true if the run stopped to move the lattice.
    bool moves() const { return cells_ != 0; }
    /// Moves the lattice, and returns the step after which the run stopped for that.
    std::int64_t move() {
      scene_.move(stopped_, std::exchange(cells_, 0));
      return moved_ = stopped_.number;
    }

   private:
    // After a move the method starts again at the same step, which was observed before the move.
    bool wants(Step const& step) const {
      return step.number != moved_ && (looks_.due(step) || follows(step));
    }
    bool follows(Step const& step) const {
      return scene_.follower_ && !step.last && scene_.follower_->due(step);
    }
    Next look(Space const& exec, Step const& step, Spins const& spins) {
      // Calls the run's observer even if only the follower is due. If a later step fails, an
      // adaptive method keeps the spins of this step, so the observer must know this step.
      if (looks_(exec, step, spins) == Next::stop) return Next::stop;
      if (!follows(step)) return Next::proceed;
      cells_ = scene_.follower_->cells_off(exec, spins);
      stopped_ = step;
      return moves() ? Next::stop : Next::proceed;
    }

    RunningScene& scene_;
    Looks& looks_;
    Step stopped_;
    std::int64_t cells_ = 0, moved_ = -1;
  };

  // Returns the time after which the field is constant, or infinity if that time is unknown because
  // the run goes on past the scene's end.
  double last_change() const {
    return run_end_ > features_end_ ? std::numeric_limits<double>::infinity() : last_change_;
  }

  // Moves the lattice, and tells the guard how that changes the energy, since no step has caused
  // the change.
  void move(Step const& step, std::int64_t cells) {
    auto const energy = [&] {
      return cayspin::energy(this->exec, this->generator, this->spins, step.time).value;
    };
    double const before = energy();
    follower_->move(this->exec, this->spins, cells);
    guard_.add_to_energies(energy() - before);
    if (rest_) rest_->begin_again();
    reset_control();
  }

  void correct(Space const& exec, Step const& step, Spins const& spins) {
    // A step that failed is repeated from spins that are corrected already.
    if (corrected_ == step.number) return;
    (*control_)(exec, step, spins);
    corrected_ = step.number;
  }
  void reset_control() {
    if (control_) control_->reset();
    corrected_ = -1;
  }

  static void add(Summary const& more, Summary& summary) {
    summary.steps += more.steps;
    summary.evaluations += more.evaluations;
    summary.step_seconds += more.step_seconds;
    summary.stopped = more.stopped;
    summary.own_steps += more.own_steps;
    summary.rejected += more.rejected;
  }

  std::unique_ptr<OpenMethod> method_;
  Guard guard_;
  double last_change_;  // time of the last change of the field up to step features_end_
  std::int64_t features_end_, run_end_ = 0;
  std::optional<SceneGenerator<Spins>> torque_;
  std::optional<RestSearch<Real, Space>> rest_;
  std::optional<EnergyControl<Spins, SceneGenerator<Spins>>> control_;
  std::int64_t corrected_ = -1;  // the step after which control_ last corrected the spins
  std::optional<RunNoise<Spins>> noise_;
  std::optional<Follower<Spins>> follower_;
  std::optional<MoreOfSample<Spins>> more_;
};

}  // namespace cayspin::simulation
