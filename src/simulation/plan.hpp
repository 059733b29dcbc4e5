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

/// Bytes that a run takes, known before it allocates.
struct Memory {
  std::int64_t spins = 0;  // the state
  std::int64_t work = 0;   // the method's
  std::int64_t field = 0;  // of terms and inertia that are stored per site
  std::int64_t files = 0;  // the start as it is read, and frames on their way to the file

  std::int64_t simulation() const { return spins + work + field; }
  std::int64_t total() const { return simulation() + files; }
};

/// What a scene amounts to: everything that is known before it runs.
struct Plan {
  Lattice lattice;
  Variant const& variant;
  MethodOptions options;
  Times times;
  double stable_dt;  // infinity where there is no limit, 0 when every dt amplifies
  double turn;       // the most that a spin can turn in a step, in radians; some without exchange
  Memory memory;
  std::int64_t frames;
  double file_bytes;                             // may be more than an integer holds
  std::shared_ptr<TimeFeatures const> features;  // of what depends on t
  double substep = 0;     // the time between evaluations of what is not dear: dt or shorter
  double noise_turn = 0;  // root mean square of the angle by which noise turns a spin in a step

  static constexpr double most_noise = 0.5;  // radians a step
};

/// Throws io::SceneError, among others for a lattice that cannot be. `features`: where those of the
/// scene are known already.
Plan make_plan(io::Scene const& scene, Precision precision,
               std::shared_ptr<TimeFeatures const> features = nullptr);

/// Why dt is too large, if it is: above the stable one; or so that a step turns spins by more than
/// 2 radians, or 3 where a stable dt is known; or longer than a feature of a field.
std::optional<std::string> dt_warning(Plan const& plan, io::Units const& units);
/// The same as a line about the scene, which is thrown as io::SceneError where the scene refuses to
/// be unstable.
std::optional<std::string> dt_warning(io::Scene const& scene, Plan const& plan);

/// Is there memory for the run?
bool fits(Plan const& plan);

/// Makes it the plan of one of several ranks: with its part of the lattice, and memory for that.
/// The first takes so many planes of the others at once.
void keep_part(Plan& plan, io::Scene const& scene, Precision precision, Lattice const& local,
               std::int64_t planes_at_once);

/// Throws io::SceneError when the run needs more memory than there is for one of so many ranks on
/// this machine.
void require_memory(io::Scene const& scene, Plan const& plan, int ranks = 1);

}  // namespace cayspin::simulation
