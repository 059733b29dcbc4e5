// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "interrupt_poll.hpp"
#include "running_scene.hpp"
#include "scene_minimizer.hpp"
#include "scene_run.hpp"

#include <cayspin/evaluate.hpp>

#include <limits>

namespace cayspin::simulation {

/// A scene with each term of its field alone, under the names of their keys.
std::vector<std::pair<std::string, io::Scene>> single_terms(io::Scene const& scene);

/// A SceneRun in one precision and execution space.
template <class Real, class Space>
class SceneRunInSpace final
    : public SceneRun,
      private RunObserver<Space, SpinField<Real, typename Space::memory_space>> {
  using Spins = SpinField<Real, typename Space::memory_space>;
  using Vectors = SiteField<Real, 3, typename Space::memory_space>;

 public:
  SceneRunInSpace(io::Scene const& scene, Plan const& plan, Precision precision,
                  std::string const& space, std::vector<double> const& start)
      : SceneRun(scene, plan, precision, space), simulation_(scene, plan, plan.times, start) {
    threads_ = threads_of(simulation_.exec);
  }

 private:
  Advanced advance_to(std::int64_t target, Looks const& looks) override {
    leave_lent_memory(true);
    looks_ = looks;
    next_look_ = std::min(next_look_, looked_ + looks.period);
    interrupt_.emplace(looks.interrupted);
    failure_.reset();
    ended_ = Advanced::whole;
    seen_ = number_;
    simulation_.times = {0, plan_.times.dt, target, number_, continues_};
    // What throws may have left the method's memory within a step.
    continues_ = false;
    Ending ending;
    try {
      ending = simulation_.advance(*this);
    } catch (...) {
      number_ = seen_;
      throw;
    }
    if (ending.failure) {
      number_ = seen_;
      throw NumbersFailed(scene_.path.string() + ": " + *ending.failure);
    }
    number_ += ending.summary.steps;
    evaluations_ += ending.summary.evaluations;
    own_steps_ += ending.summary.own_steps;
    rejected_ += ending.summary.rejected;
    step_seconds_ += ending.summary.step_seconds;
    if (failure_) throw NumbersFailed(scene_.path.string() + ": " + *failure_);
    continues_ = true;
    return ended_;
  }

  // RunObserver
  bool due(Step const& step) const override {
    // An adaptive method leaves the spins as they were last due, at most 1000 steps ago.
    bool const is_adaptive = scene_.integrator.tolerance.has_value();
    if (!is_adaptive) seen_ = step.number;
    // After the last step there is nothing to end: a yes would be lost.
    return step.number >= std::min(next_look_, seen_ + most_unseen) ||
           (!step.last && (*interrupt_)());
  }
  Next operator()(Space const& exec, Step const& step, Spins const& spins) override {
    seen_ = step.number;
    if (step.number >= next_look_ && judge(exec, step, spins) == Next::stop) return Next::stop;
    if (step.last || !(*interrupt_)()) return Next::proceed;
    ended_ = Advanced::interrupted;
    return Next::stop;
  }

  Next judge(Space const& exec, Step const& step, Spins const& spins) {
    bool const first = looked_ < 0;
    looked_ = step.number;
    next_look_ = step.number + looks_.period;
    auto const found = simulation_.look(exec, step, spins, looks_.until_torque);
    failure_ = found.failure;
    if (failure_) return Next::stop;
    if (first || !found.at_rest) return Next::proceed;
    ended_ = Advanced::at_rest;
    return Next::stop;
  }

  LentVectors lend_spins() override {
    if constexpr (on_host) {
      if (!lent_) lent_ = std::make_shared<Spins>(simulation_.spins);
      return {host_vectors(*lent_), lent_};
    } else {
      return lend_copy(simulation_.spins);
    }
  }
  void leave_lent_memory(bool copy_spins) {
    if (lent_.use_count() > 1) {
      Spins const other("spins", plan_.lattice);
      if (copy_spins)
        Kokkos::deep_copy(simulation_.exec, other.allocation(), simulation_.spins.allocation());
      simulation_.exec.fence("cayspin::SceneRun: spins moved");
      simulation_.spins = other;
    }
    lent_.reset();
  }

  void replace_spins(std::vector<double> const& start) override {
    leave_lent_memory(false);
    copy_from_host(start, simulation_.spins);
    begin_again();
  }

  Minimum find_rest(io::Field const& field, MinimizeOptions const& options) override {
    leave_lent_memory(true);
    if (!minimizer_) {
      require_memory(scene_, make_plan_to_relax(scene_, precision()));
      minimizer_.emplace(simulation_.spins);
    }
    auto in_field = scene_;
    in_field.field = field;
    auto const sought = field_of<Spins>(in_field, plan_.lattice, false).made_for(FieldFor::energy);
    // What could be refused has been: until here a run goes on as it was.
    begin_again();
    return minimizer_->minimize(simulation_.exec, scene_, sought, simulation_.spins, options);
  }

  // With other spins.
  void begin_again() {
    continues_ = false;
    looked_ = -1;
    next_look_ = number_;
    simulation_.begin_again(scene_);
  }

  void exchange(Checkpoint& checkpoint) override {
    simulation_.exchange(checkpoint, continues_);
    if (!checkpoint.restores()) return;
    looked_ = simulation_.guard().last_look();
    next_look_ = looked_ < 0 ? steps() : std::numeric_limits<std::int64_t>::max();
  }

  Sample look() override {
    return sample_scene(simulation_.exec, simulation_.generator, now(), simulation_.spins);
  }

  std::vector<std::pair<std::string, double>> term_energies() override {
    std::vector<std::pair<std::string, double>> energies;
    if (scene_.system.kind == io::SystemKind::rigid_body) {
      energies.emplace_back("rotation", look().energy.value);
      return energies;
    }
    if (terms_.empty())
      for (auto const& [name, alone] : single_terms(scene_)) {
        terms_.emplace_back(name, SceneGenerator<Spins>(alone, plan_.lattice));
      }
    for (auto const& [name, generator] : terms_)
      energies.emplace_back(
          name,
          cayspin::sample(simulation_.exec, generator, now(), simulation_.spins).energy.value);
    return energies;
  }

  LentVectors evaluated_field() override {
    Vectors const field("field", plan_.lattice);
    evaluate_field(simulation_.exec,
                   simulation_.generator.landau_lifshitz().field().made_for(FieldFor::itself),
                   simulation_.spins, reduced_time(), field);
    simulation_.exec.fence("cayspin::SceneRun: field evaluated");
    if constexpr (on_host)
      return {host_vectors(field), std::make_shared<Vectors>(field)};
    else
      return lend_copy(field);
  }

  static constexpr bool on_host = cayspin::detail::is_host_execution<Space>;

  // Of vectors on a device.
  template <class Field>
  LentVectors lend_copy(Field const& field) {
    auto const numbers = std::make_shared<std::vector<Real>>(copy_to_host(field));
    auto const& [nx, ny, nz] = scene_.lattice.shape;
    return {
        {numbers->data(), std::is_same_v<Real, double>, {nz, ny, nx}, {3 * nx * ny, 3 * nx, 3, 1}},
        numbers};
  }

  Step now() const { return {number_, reduced_time(), plan_.times.dt, false}; }

  RunningScene<Real, Space> simulation_;
  std::optional<SceneMinimizer<Real, Space>> minimizer_;
  std::vector<std::pair<std::string, SceneGenerator<Spins>>> terms_;
  std::shared_ptr<Spins> lent_;

  Looks looks_;
  mutable std::optional<InterruptPoll> interrupt_;
  std::optional<std::string> failure_;
  Advanced ended_ = Advanced::whole;
  bool continues_ = false;
  std::int64_t looked_ = -1, next_look_ = 0;  // steps of the guard's looks
  mutable std::int64_t seen_ = 0;             // the step whose state the spins have, if one fails
  static constexpr std::int64_t most_unseen = 1000;
};

}  // namespace cayspin::simulation
