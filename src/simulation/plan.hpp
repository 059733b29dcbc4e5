// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "precision.hpp"
#include "time_features.hpp"
#include "variant.hpp"

#include <cayspin/lattice.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace cayspin::simulation {

/// Bytes that a run needs, known before it allocates.
struct Memory {
  std::int64_t spins = 0;  // the state
  std::int64_t work = 0;   // of the method
  std::int64_t field = 0;  // of terms and inertia stored per site
  std::int64_t files = 0;  // to read the start, or to write frames and checkpoints

  std::int64_t simulation() const { return spins + work + field; }
  std::int64_t total() const { return simulation() + files; }
};

/// Everything known about a scene before it runs.
struct Plan {
  Lattice lattice;
  Variant const& variant;
  MethodOptions options;
  Times times;
  double stable_dt;  // infinity without a limit, 0 if errors grow at every dt
  // Bound on a spin's turn in `substep`, in radians; without exchange and couplings if stable_dt is
  // finite or the method is stiff.
  double turn;
  Memory memory;
  std::int64_t frames;
  double file_bytes;                             // may exceed the range of an integer
  std::shared_ptr<TimeFeatures const> features;  // of fields and torques that depend on t
  double substep = 0;     // interval between evaluations of the cheap terms: dt or shorter
  double noise_turn = 0;  // largest root mean square angle by which noise turns a spin in a step

  static constexpr double most_noise = 0.5;  // radians per step
};

/// Returns the number of frames, or of samples, in `steps` steps: one at the start, one at the end,
/// and one after every `every` steps.
inline std::int64_t frames_of(std::int64_t steps, std::int64_t every) {
  return steps / every + (steps % every != 0) + 1;
}

/// Plans a run of a scene. Throws io::SceneError, for example for an invalid lattice. `features`:
/// the scene's time features, if they are already known.
Plan make_plan(io::Scene const& scene, Precision precision,
               std::shared_ptr<TimeFeatures const> features = nullptr);

/// Returns why dt is too large, if it is: it is above the stable dt, turns spins by more than 2
/// radians in a substep (3 if a stable dt is known), has substeps longer than a feature of a field,
/// or lets noise turn spins by more than most_noise. Returns nothing for adaptive methods and for
/// runs without steps.
std::optional<std::string> dt_warning(Plan const& plan, io::Units const& units);
/// Returns why dt is too large as a line that names the scene's key. If the scene sets
/// refuse_unstable, throws that line as io::SceneError.
std::optional<std::string> dt_warning(io::Scene const& scene, Plan const& plan);
/// Like dt_warning(scene, plan), but for a run, which has no end if integrator.steps is 0.
std::optional<std::string> dt_warning_of_run(io::Scene const& scene, Plan plan);

/// Returns true if there is memory for the run.
bool fits(Plan const& plan);

/// Reduces the plan to that of one of several ranks: to its part of the lattice, and the memory for
/// this part. The first rank also holds `planes_at_once` planes of the whole lattice.
void keep_part(Plan& plan, io::Scene const& scene, Precision precision, Lattice const& local,
               std::int64_t planes_at_once);

/// Throws io::SceneError if the run needs more memory than is available to one of `ranks` ranks on
/// this machine.
void require_memory(io::Scene const& scene, Plan const& plan, int ranks = 1);

}  // namespace cayspin::simulation
