// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "found_modes.hpp"
#include "io/own_field.hpp"
#include "io/scene.hpp"
#include "plan.hpp"

#include <cayspin/checkpoint.hpp>
#include <cayspin/minimizer/minimum.hpp>
#include <cayspin/observer/record.hpp>

#include <atomic>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation {

struct RunSettings {
  Precision precision = Precision::double_precision;
  std::optional<std::string> space = {};  // default: Kokkos' default
  std::optional<int> threads = {};        // of host spaces; only the first run of a process sets it
  std::optional<std::filesystem::path> restart = {};  // a checkpoint or trajectory to continue from
};

/// Vectors of all sites in host memory, which stays unchanged as long as `owner` exists.
struct LentVectors {
  io::HostVectors vectors;
  std::shared_ptr<void const> owner;
};

/// When a run checks its state, and why it may end early.
struct Looks {
  std::int64_t period = 100;               // steps between checks by the guard
  bool until_torque = false;               // may end early by the scene's until_torque
  std::function<bool()> interrupted = {};  // called between steps, about twenty times a second
  bool at_end = false;                     // the guard also checks the last of the steps
  std::int64_t run_end = 0;                // last step of later calls, if there will be any
};

enum class Advanced { whole, interrupted, at_rest };

/// Options of a search for an equilibrium.
struct RelaxSettings {
  double torque = 1e-6;                    // bound on max |m x H|, in the units of the scene
  std::int64_t evaluations = 100000;       // of the field, at most
  std::optional<io::Triple> applied = {};  // instead of field.applied
  bool keep_saddles = false;               // accept any state without torque
  std::function<bool()> interrupted = {};  // called about twenty times a second
};

/// A type-erased run of a scene, for other languages. Calls from several threads take turns, even
/// if they are for different runs; steps() and time() never wait. Kokkos starts with the first run
/// of a process, unless the program has started it, and ends with the process.
///
/// N calls of advance(1) give bitwise the same results as advance(N), and as `cayspin run`.
class SceneRun {
 public:
  /// Opens a run. The functions of the calling program in scene.field.own take and return numbers
  /// in the scene's units. Throws io::SceneError for an invalid scene, and UsageError for invalid
  /// settings: a space that is not compiled in, less than one thread, or a restart that does not
  /// fit the scene.
  static std::unique_ptr<SceneRun> open(io::Scene const& scene, RunSettings const& settings);

  virtual ~SceneRun() = default;
  SceneRun(SceneRun const&) = delete;
  SceneRun& operator=(SceneRun const&) = delete;

  io::Scene const& scene() const { return scene_; }
  /// Returns the current scene in the form that open() takes: with the calling program's fields in
  /// the scene's units.
  io::Scene typed_scene() const;
  Precision precision() const { return precision_; }
  std::string const& space() const { return space_; }
  int threads() const { return threads_; }  // 1 on devices

  /// Return the steps taken, and the time after them. Times, energies and fields are in the scene's
  /// units.
  std::int64_t steps() const { return number_; }
  double time() const { return time_at(number_); }
  double time_at(std::int64_t step) const { return plan().times.at(step) * scene_.units.time; }
  /// Returns the last step of the scene, if it has an end.
  std::int64_t last_step() const { return scene_.begin.step + scene_.integrator.steps; }
  /// Returns how often the generator, or in searches the field, was evaluated at all sites.
  std::int64_t evaluations() const { return evaluations_; }
  /// Return the accepted and the rejected steps of an adaptive method.
  std::int64_t own_steps() const { return own_steps_; }
  std::int64_t rejected_steps() const { return rejected_; }
  double step_seconds() const { return step_seconds_; }  // time spent stepping only

  /// Returns true if the run needs more than its spins to continue exactly, that is, with bitwise
  /// identical results.
  bool remembers() const;

  /// Returns the warning of `cayspin run` about a dt that is too large. Throws it as io::SceneError
  /// if the scene sets refuse_unstable.
  std::optional<std::string> warning() const;
  /// Returns how the scene differs from that of the file from which the run continues, in one line.
  std::optional<std::string> const& restart_warning() const { return restart_warning_; }

  /// Returns the step at time t. Throws UsageError when t is not a whole number of steps.
  std::int64_t step_at(double t) const;

  /// Throws what advance(count) would throw before its first step.
  void require_reachable(std::int64_t count) const { require_reachable(count, number_); }
  /// Throws what advance(count) would throw before its first step, if the run were at step `step`.
  void require_reachable(std::int64_t count, std::int64_t step) const;

  /// Takes `count` more steps, or fewer if the run ends early. Throws UsageError for a negative
  /// `count`, for a scene without [integrator], for steps beyond number 2^53, and when an adaptive
  /// method would go beyond the scene's end; NumbersFailed when the numbers become invalid; and any
  /// exception of a field of the program. If a step fails, steps() and the spins are those before
  /// it (of an adaptive method, up to 1000 steps before); if a check by the guard fails, those that
  /// it checked.
  Advanced advance(std::int64_t count, Looks const& looks = {});

  /// Result of advance_all for one run.
  struct Outcome {
    Advanced advanced = Advanced::whole;
    std::exception_ptr error = {};  // what advance would have thrown
  };
  /// Which runs go side by side on a host, one to a thread.
  enum class SideBySide { small, all };
  /// Advances runs in the same space to step `target`, except those that are already there. If one
  /// is interrupted, or throws anything but NumbersFailed, the others are interrupted too, and
  /// those that have not begun do not begin.
  static std::vector<Outcome> advance_all(std::span<SceneRun* const> runs, std::int64_t target,
                                          Looks const& looks, SideBySide side = SideBySide::small);

  /// Result of relax_all for one run.
  struct Relaxed {
    Minimum minimum = {};
    std::exception_ptr error = {};  // what relax would have thrown
  };
  /// Calls relax() of each of these runs, small ones side by side. If one is interrupted, or
  /// throws anything but NumbersFailed, all that have not finished end as interrupted, even those
  /// that have not begun.
  static std::vector<Relaxed> relax_all(std::span<SceneRun* const> runs,
                                        RelaxSettings const& settings);

  /// Continues from the spins of one column in a run of ReplicaColumns, and from the step of that
  /// run.
  void continue_from_column(SceneRun const& columns, std::int64_t column);
  /// A run of `count` columns, and a run of a single replica, whose spins and field are overwritten
  /// by sampling. The values of the columns are those from `first` on in `values`.
  struct ColumnsToSample {
    SceneRun const* columns;
    SceneRun* one;
    std::int64_t first, count;
    io::Columns const* values;
  };
  /// Returns a sample of each column of these runs. Small replicas are sampled side by side.
  static std::vector<std::vector<Sample>> sample_columns(std::span<ColumnsToSample const> all);

  /// Continues with changed keys, given as for `cayspin run --set`, from the current state. Steps
  /// and time continue, and the end of [integrator] counts from here. Multistep methods restart.
  /// Throws io::SceneError, also for keys that cannot change, and then changes nothing. A new
  /// field.applied replaces a function of the program.
  void change(std::vector<std::string> const& overrides, io::Given const& given = {});

  /// Moves the spins to an equilibrium of the current field. Time and steps do not change.
  /// Multistep methods restart. The result is in the scene's units. Throws UsageError for invalid
  /// settings, io::SceneError for rigid bodies, torques and temperatures, NumbersFailed for a field
  /// that is not finite, and any exception of a field of the program.
  Minimum relax(RelaxSettings const& settings = {});
  /// Throws UsageError for a torque or evaluations that relax() does not accept, io::SceneError for
  /// a scene that has no equilibrium.
  void require_relaxable(RelaxSettings const& settings) const;

  /// Returns the normal modes about the spins, which must be at equilibrium, in the current field.
  /// Throws UsageError for invalid options, io::SceneError also for spins with neither precession
  /// nor damping, and what relax() throws, except that torques are accepted.
  FoundModes modes(ModesOptions const& options = {});
  /// Returns the lowest eigenvalues of the Hessian at the spins, in the same way. Torques are
  /// refused.
  FoundCurvatures curvatures(ModesOptions const& options = {});
  /// Returns the spin waves with these wave vectors, in cycles per cell, in the same way. Torques
  /// are refused. Throws also what require_bands and find_bands throw.
  FoundBands bands(std::vector<std::array<double, 3>> const& wave_vectors,
                   std::function<Next()> const& poll = {});

  /// Returns the spins, on hosts without a copy. If the memory is still lent when the run
  /// continues, it stays unchanged: the run copies the spins to other memory, and goes on there.
  LentVectors spins();
  /// Replaces the spins, normalised in double like any start. Multistep methods restart. Throws
  /// UsageError for a zero or non-finite spin, or another shape.
  void set_spins(io::HostVectors const& from);

  /// Continues after step `step` from unit vectors, sites x 3, which are not normalised again. The
  /// three components of a site are adjacent, and the index along x varies fastest from site to
  /// site. Multistep methods restart.
  void continue_from(std::int64_t step, std::vector<double> const& spins);

  /// Stores everything that another run needs to continue exactly from here (RunSettings::restart).
  /// Replaces an existing file; throws std::runtime_error if the file cannot be written.
  void save(std::filesystem::path const& checkpoint);

  /// Stores what save() stores, or restores it; the latter needs a preceding continue_from() with
  /// the step and the spins that were stored.
  void exchange_with(Checkpoint& checkpoint);

  /// Returns the current energy, norm defect and magnetization.
  Sample sample();
  /// Returns the sample if the guard accepts the current state, otherwise throws NumbersFailed.
  Sample judged_sample();
  /// Returns the further numbers of a sample, in the order of more_scalars().
  std::vector<double> more_of_sample();
  /// Returns by how many cells the lattice has moved to follow its object.
  virtual std::int64_t shift() const = 0;
  /// Returns name and energy of each term of the scene; for rigid bodies "rotation".
  std::vector<std::pair<std::string, double>> energies();
  /// Returns the current effective field. Throws UsageError for rigid bodies.
  LentVectors field();

 protected:
  SceneRun(io::Scene const& scene, Plan const& plan, Precision precision, std::string space);

  double reduced_time() const { return plan().times.at(number_); }

  virtual Advanced advance_to(std::int64_t target, Looks const& looks) = 0;
  virtual Minimum find_rest(io::Field const& field, MinimizeOptions const& options) = 0;
  virtual FoundModes modes_of_field(ModesOptions const& options) = 0;
  virtual FoundCurvatures curvatures_of_field(ModesOptions const& options) = 0;
  virtual FoundBands bands_of_field(std::vector<std::array<double, 3>> const& wave_vectors,
                                    std::function<Next()> const& poll) = 0;
  virtual LentVectors lend_spins() = 0;
  /// Rebuilds everything but the spins.
  virtual void rebuild(io::Scene const& scene, Plan const& plan) = 0;
  virtual void replace_spins(std::vector<double> const& start) = 0;
  virtual void take_column(SceneRun const& columns, std::int64_t column) = 0;
  /// Takes over the field of one column, for samples only: the run must not advance any more.
  virtual void sample_in(io::Columns const& values, std::size_t column) = 0;
  virtual void exchange(Checkpoint& checkpoint) = 0;
  virtual void go_on_from(std::int64_t shift) = 0;
  virtual Sample look() = 0;
  /// Returns what is wrong with a sample of the current state, if anything.
  virtual std::optional<std::string> failure_of(Sample const& now) const = 0;
  virtual std::vector<double> more() = 0;
  virtual std::vector<std::pair<std::string, double>> term_energies() = 0;
  virtual LentVectors evaluated_field() = 0;

  io::Scene scene_;
  std::optional<Plan> held_plan_;  // always set; optional because a Plan cannot be assigned
  Plan const& plan() const { return *held_plan_; }
  std::optional<std::string> restart_warning_;
  // Other threads read these while the run advances.
  std::atomic<std::int64_t> number_ = 0, evaluations_ = 0, own_steps_ = 0, rejected_ = 0;
  std::atomic<double> step_seconds_ = 0;
  int threads_ = 1;

 private:
  /// Calls work(number) for each run.
  static void for_each_run(std::span<SceneRun* const> runs, SideBySide side,
                           std::function<void(std::size_t)> const& work);
  Minimum relaxed(RelaxSettings const& settings);
  Sample sampled(bool judges = false);

  Precision precision_;
  std::string space_;
  io::OwnField typed_own_;  // in the scene's units
};

/// Returns the vectors packed as (nz, ny, nx, 3).
template <class Real>
std::vector<Real> packed(io::HostVectors const& vectors);

}  // namespace cayspin::simulation
