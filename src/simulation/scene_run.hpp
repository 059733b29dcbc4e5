// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/own_field.hpp"
#include "io/scene.hpp"
#include "plan.hpp"

#include <cayspin/checkpoint.hpp>
#include <cayspin/minimizer/minimum.hpp>
#include <cayspin/observer/record.hpp>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation {

struct RunSettings {
  Precision precision = Precision::double_precision;
  std::optional<std::string> space = {};  // default: Kokkos' default
  std::optional<int> threads = {};        // of host spaces; only the first run of a process has it
  std::optional<std::filesystem::path> restart = {};  // a checkpoint or trajectory to go on from
};

/// Vectors of all sites in host memory, which stays there and unchanged as long as `owner` does.
struct LentVectors {
  io::HostVectors vectors;
  std::shared_ptr<void const> owner;
};

/// When a run looks at its numbers, and why it may end early.
struct Looks {
  std::int64_t period = 100;               // steps from one look of the guard to the next
  bool until_torque = false;               // ends where the scene's until_torque says so
  std::function<bool()> interrupted = {};  // asked between steps, about twenty times a second
};

enum class Advanced { whole, interrupted, at_rest };

/// How far a state of rest is looked for.
struct RelaxSettings {
  double torque = 1e-6;                    // bound on max |m x H|, in the units of the scene
  std::int64_t evaluations = 100000;       // of the field, at most
  std::optional<io::Triple> applied = {};  // in place of field.applied
  bool keep_saddles = false;               // a state without torque is enough
  std::function<bool()> interrupted = {};  // asked about twenty times a second
};

/// A run of a scene, its types erased: what other languages hold. Calls of several threads, also on
/// several runs, take turns; those that count steps and time do not wait. Kokkos starts with the
/// first run of a process, unless the program has started it, and ends with the process.
///
/// N calls of advance(1) give the bits of one advance(N), and those of `cayspin run`.
class SceneRun {
 public:
  /// The fields of the program, scene.field.own, are in the scene's units, too.
  /// Throws io::SceneError, or UsageError for a space that is not compiled in.
  static std::unique_ptr<SceneRun> open(io::Scene const& scene, RunSettings const& settings);

  virtual ~SceneRun() = default;
  SceneRun(SceneRun const&) = delete;
  SceneRun& operator=(SceneRun const&) = delete;

  io::Scene const& scene() const { return scene_; }
  Precision precision() const { return precision_; }
  std::string const& space() const { return space_; }
  int threads() const { return threads_; }  // 1 on devices

  /// Steps taken, and the time after them. Times, energies and fields are in the scene's units.
  std::int64_t steps() const { return number_; }
  double time() const { return reduced_time() * scene_.units.time; }
  std::int64_t evaluations() const { return evaluations_; }  // of the generator over all sites
  /// Steps that an adaptive method took, and those that it threw away.
  std::int64_t own_steps() const { return own_steps_; }
  std::int64_t rejected_steps() const { return rejected_; }
  double step_seconds() const { return step_seconds_; }  // stepping alone

  /// Does it need more than its spins to go on with the same bits?
  bool remembers() const;

  /// What `cayspin run` warns of: a dt that is too large. Throws it as io::SceneError where the
  /// scene refuses to be unstable.
  std::optional<std::string> warning() const;
  /// What of the scene differs from that of the file that the run goes on from, in one line.
  std::optional<std::string> const& restart_warning() const { return restart_warning_; }

  /// The step at time t. Throws UsageError when t is no whole number of steps.
  std::int64_t step_at(double t) const;

  /// Throws what advance(count) throws before its first step.
  void require_reachable(std::int64_t count) const;

  /// Takes `count` more steps, less when it ends early. Throws UsageError when an adaptive method
  /// would go beyond the scene's end, NumbersFailed when the numbers do, and what a field of the
  /// program throws. steps() and the spins are then those before the step that failed.
  Advanced advance(std::int64_t count, Looks const& looks = {});

  /// Moves the spins to a state of rest of the field now. Time and steps stay. Methods that
  /// remember steps begin again. The result is in the scene's units. Throws UsageError for settings
  /// that cannot be, io::SceneError for rigid bodies and temperatures, NumbersFailed for a field
  /// that is not finite, and what a field of the program throws.
  Minimum relax(RelaxSettings const& settings = {});

  /// The spins. Memory that is still lent when the run goes on is left as it is: the run moves to
  /// other memory, by one copy.
  LentVectors spins();
  /// Normalised in double like any start. Methods that remember steps begin again. Throws
  /// UsageError for a zero or non-finite spin, or another shape.
  void set_spins(io::HostVectors const& from);

  /// Stores all that another run needs to go on with the same bits, by RunSettings::restart.
  /// Throws std::runtime_error when the file cannot be; one that exists is replaced.
  void save(std::filesystem::path const& checkpoint);

  /// Energy, norm defect and magnetization now.
  Sample sample();
  /// The energy of each term of the scene, which it names; of rigid bodies "rotation".
  std::vector<std::pair<std::string, double>> energies();
  /// The effective field now. Throws UsageError for rigid bodies.
  LentVectors field();

 protected:
  SceneRun(io::Scene const& scene, Plan const& plan, Precision precision, std::string space);

  double reduced_time() const { return plan_.times.at(number_); }

  virtual Advanced advance_to(std::int64_t target, Looks const& looks) = 0;
  virtual Minimum find_rest(io::Field const& field, MinimizeOptions const& options) = 0;
  virtual LentVectors lend_spins() = 0;
  virtual void replace_spins(std::vector<double> const& start) = 0;
  virtual void exchange(Checkpoint& checkpoint) = 0;
  virtual Sample look() = 0;
  virtual std::vector<std::pair<std::string, double>> term_energies() = 0;
  virtual LentVectors evaluated_field() = 0;

  io::Scene scene_;
  Plan plan_;
  std::optional<std::string> restart_warning_;
  // Other threads read them while the run goes on.
  std::atomic<std::int64_t> number_ = 0, evaluations_ = 0, own_steps_ = 0, rejected_ = 0;
  std::atomic<double> step_seconds_ = 0;
  int threads_ = 1;

 private:
  Precision precision_;
  std::string space_;
};

/// Vectors packed as (nz, ny, nx, 3).
template <class Real>
std::vector<Real> packed(io::HostVectors const& vectors);

}  // namespace cayspin::simulation
