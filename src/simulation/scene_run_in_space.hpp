// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "interrupt_poll.hpp"
#include "running_scene.hpp"
#include "scene_minimizer.hpp"
#include "scene_modes.hpp"
#include "scene_run.hpp"

#include <cayspin/evaluate.hpp>

#include <limits>

namespace cayspin::simulation {

/// Functor that copies one column of a lattice to a lattice of a single replica.
template <class Real>
struct CopyColumn {
  SiteArray<Real, 3> columns;
  OutputArray<Real, 3> one;
  RowLayout layout_of_columns, layout_of_one;
  std::int64_t column;

  KOKKOS_FUNCTION void operator()(std::int64_t site) const {
    std::ptrdiff_t const from = layout_of_columns.offset(site * layout_of_columns.nx + column);
    std::ptrdiff_t const to = layout_of_one.offset(site);
    for (int c = 0; c < 3; ++c)
      one.data[c * one.stride + to] = columns.data[c * columns.stride + from];
  }
};

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
      : SceneRun(scene, plan, precision, space),
        simulation_(std::make_unique<RunningScene<Real, Space>>(scene, plan, plan.times, start)) {
    threads_ = threads_of(simulation_->exec);
  }

  std::int64_t shift() const override { return simulation_->shift(); }

 private:
  Advanced advance_to(std::int64_t target, Looks const& looks) override {
    leave_lent_memory(true);
    looks_ = looks;
    next_look_ = std::min(next_look_, look_after(looked_));
    interrupt_.emplace(looks.interrupted);
    failure_.reset();
    ended_ = Advanced::whole;
    seen_ = number_;
    simulation_->times = plan().times;
    simulation_->times.steps = target;
    simulation_->times.first = number_;
    simulation_->times.continues = continues_;
    simulation_->set_run_end(std::max(target, looks.run_end));
    // If an exception interrupts a step, the method's memory is not that of a whole step.
    continues_ = false;
    Ending ending;
    try {
      ending = simulation_->advance(*this);
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

  // Implements RunObserver.
  bool due(Step const& step) const override {
    // If an adaptive method fails, it leaves the spins as they were when due() last returned true,
    // at most 1000 steps ago.
    bool const is_adaptive = scene_.integrator.tolerance.has_value();
    if (!is_adaptive) seen_ = step.number;
    // Do not poll after the last step: integrate() ignores a stop there.
    return step.number >= std::min(next_look_, seen_ + most_unseen) ||
           (step.last ? looks_.at_end : (*interrupt_)());
  }
  Next operator()(Space const& exec, Step const& step, Spins const& spins) override {
    seen_ = step.number;
    bool const judges = step.number >= next_look_ || (step.last && looks_.at_end);
    if (judges && judge(exec, step, spins) == Next::stop) return Next::stop;
    if (step.last || !(*interrupt_)()) return Next::proceed;
    ended_ = Advanced::interrupted;
    return Next::stop;
  }

  // Returns the step of the first check after `step`. Periods are counted from the start of the
  // scene, as in Guard::due, not from the last check.
  std::int64_t look_after(std::int64_t step) const {
    return step + looks_.period - (step - scene_.begin.step) % looks_.period;
  }

  Next judge(Space const& exec, Step const& step, Spins const& spins) {
    bool const first = looked_ < 0;
    looked_ = step.number;
    next_look_ = look_after(step.number);
    auto const found = simulation_->look(exec, step, spins, looks_.until_torque);
    failure_ = found.failure;
    if (failure_) return Next::stop;
    if (first || !found.at_rest) return Next::proceed;
    ended_ = Advanced::at_rest;
    return Next::stop;
  }

  LentVectors lend_spins() override {
    if constexpr (on_host) {
      if (!lent_) lent_ = std::make_shared<Spins>(simulation_->spins);
      return {host_vectors(*lent_), lent_};
    } else {
      return lend_copy(simulation_->spins);
    }
  }
  void leave_lent_memory(bool copy_spins) {
    if (lent_.use_count() > 1) {
      Spins const other("spins", plan().lattice);
      if (copy_spins)
        Kokkos::deep_copy(simulation_->exec, other.allocation(), simulation_->spins.allocation());
      simulation_->exec.fence("cayspin::SceneRun: spins moved");
      simulation_->spins = other;
    }
    lent_.reset();
  }

  void rebuild(io::Scene const& scene, Plan const& plan) override {
    auto const numbers = copy_to_host(simulation_->spins);
    std::vector<double> const start(numbers.begin(), numbers.end());
    auto times = plan.times;
    times.first = number_;
    auto changed = std::make_unique<RunningScene<Real, Space>>(scene, plan, times, start);
    changed->go_on_from(*simulation_);
    simulation_ = std::move(changed);
    lent_.reset();
    terms_.reset();
    continues_ = false;
    looked_ = -1;
    next_look_ = number_;
  }

  void replace_spins(std::vector<double> const& start) override {
    leave_lent_memory(false);
    copy_from_host(start, simulation_->spins);
    begin_again();
  }

  void take_column(SceneRun const& columns, std::int64_t column) override {
    leave_lent_memory(false);
    auto const& from = static_cast<SceneRunInSpace const&>(columns).simulation_->spins;
    auto const& to = simulation_->spins;
    CopyColumn<Real> const copy{from.array(), to.output(false), from.layout(), to.layout(), column};
    if constexpr (on_host) {
      for (std::int64_t site = 0; site < to.sites(); ++site) copy(site);
    } else {
      Kokkos::parallel_for("cayspin::SceneRun: column",
                           Kokkos::RangePolicy<Space, Kokkos::IndexType<std::int64_t>>(
                               simulation_->exec, 0, to.sites()),
                           copy);
    }
    number_ = columns.steps();
    begin_again();
  }

  void sample_in(io::Columns const& values, std::size_t column) override {
    simulation_->generator.set_values(scene_.field, values, column);
  }

  Minimum find_rest(io::Field const& field, MinimizeOptions const& options) override {
    leave_lent_memory(true);
    if (!minimizer_) {
      require_memory(scene_, make_plan_to_relax(scene_, precision()));
      minimizer_.emplace(simulation_->spins);
    }
    auto in_field = scene_;
    in_field.field = field;
    auto const sought = field_of<Spins>(in_field, plan().lattice, false).made_for(FieldFor::energy);
    // All checks have passed: up to here an exception leaves the run unchanged.
    begin_again();
    return minimizer_->relax(simulation_->exec, scene_, sought, simulation_->spins, options);
  }

  FoundModes modes_of_field(ModesOptions const& options) override {
    require_memory(scene_, make_plan_of_modes(scene_, precision(), options, false));
    auto const field = field_of<Spins>(scene_, plan().lattice, false).made_for(FieldFor::energy);
    return find_modes<Real, Space>(simulation_->exec, scene_, field, simulation_->spins, options);
  }

  FoundCurvatures curvatures_of_field(ModesOptions const& options) override {
    require_memory(scene_, make_plan_of_modes(scene_, precision(), options, true));
    auto const field = field_of<Spins>(scene_, plan().lattice, false).made_for(FieldFor::energy);
    auto const& exec = simulation_->exec;
    auto const& spins = simulation_->spins;
    auto found = find_curvatures<Real, Space>(exec, scene_, field, spins, options);
    if (!found.values.empty())
      add_errors_of_torque<Real, Space>(exec, scene_, field, spins, options.time, found);
    return found;
  }

  FoundBands bands_of_field(std::vector<std::array<double, 3>> const& wave_vectors,
                            std::function<Next()> const& poll) override {
    auto needed = make_plan_of_modes(scene_, precision(), {}, false);
    needed.memory.work += memory_of_bands(scene_);
    require_memory(scene_, needed);
    auto const field = field_of<Spins>(scene_, plan().lattice, false).made_for(FieldFor::energy);
    return find_bands<Real, Space>(simulation_->exec, scene_, field, simulation_->spins,
                                   wave_vectors, reduced_time(), poll);
  }

  // Call it after the spins were replaced.
  void begin_again() {
    continues_ = false;
    looked_ = -1;
    next_look_ = number_;
    simulation_->begin_again(scene_);
  }

  void exchange(Checkpoint& checkpoint) override {
    simulation_->exchange(checkpoint, continues_);
    if (!checkpoint.restores()) return;
    looked_ = simulation_->guard().last_look();
    next_look_ = looked_ < 0 ? steps() : std::numeric_limits<std::int64_t>::max();
  }

  void go_on_from(std::int64_t shift) override { simulation_->go_on_from(shift); }

  Sample look() override {
    return sample_scene(simulation_->exec, simulation_->generator, now(), simulation_->spins);
  }

  std::optional<std::string> failure_of(Sample const& sample) const override {
    auto guard =
        simulation_->guard();  // a copy: the steps of the run's own checks stay as they are
    return guard.judge(now(), sample.energy, sample.norm_defect);
  }

  std::vector<std::pair<std::string, double>> term_energies() override {
    if (!terms_) terms_.emplace(scene_, plan().lattice);
    auto const found = (*terms_)(simulation_->exec, now(), simulation_->spins);
    std::vector<std::pair<std::string, double>> energies;
    for (std::size_t term = 0; term < found.size(); ++term)
      energies.emplace_back(terms_->names()[term], found[term]);
    return energies;
  }

  std::vector<double> more() override {
    return simulation_->more(simulation_->exec, now(), simulation_->spins);
  }

  LentVectors evaluated_field() override {
    Vectors const field("field", plan().lattice);
    evaluate_field(simulation_->exec,
                   simulation_->generator.landau_lifshitz().field().made_for(FieldFor::itself),
                   simulation_->spins, reduced_time(), field);
    simulation_->exec.fence("cayspin::SceneRun: field evaluated");
    if constexpr (on_host)
      return {host_vectors(field), std::make_shared<Vectors>(field)};
    else
      return lend_copy(field);
  }

  static constexpr bool on_host = cayspin::detail::is_host_execution<Space>;

  // Lends a host copy of vectors that are in the memory of a device.
  template <class Field>
  LentVectors lend_copy(Field const& field) {
    auto const numbers = std::make_shared<std::vector<Real>>(copy_to_host(field));
    auto const& [nx, ny, nz] = scene_.lattice.shape;
    return {
        {numbers->data(), std::is_same_v<Real, double>, {nz, ny, nx}, {3 * nx * ny, 3 * nx, 3, 1}},
        numbers};
  }

  Step now() const { return {number_, reduced_time(), plan().times.dt, false}; }

  std::unique_ptr<RunningScene<Real, Space>> simulation_;
  std::optional<SceneMinimizer<Real, Space>> minimizer_;
  std::optional<TermEnergies<Spins>> terms_;
  std::shared_ptr<Spins> lent_;

  Looks looks_;
  mutable std::optional<InterruptPoll> interrupt_;
  std::optional<std::string> failure_;
  Advanced ended_ = Advanced::whole;
  bool continues_ = false;
  std::int64_t looked_ = -1, next_look_ = 0;  // steps of the guard's checks
  mutable std::int64_t seen_ = 0;             // step whose spins are kept if a later step fails
  static constexpr std::int64_t most_unseen = 1000;
};

}  // namespace cayspin::simulation
