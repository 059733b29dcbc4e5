// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::extremes {

/// Possible results of a run.
enum class Fate {
  exact,     // the exact solution, to round-off
  bounded,   // on the sphere, with an error of the method's order
  warned,    // the program warns that dt is too large; on the sphere, or stopped
  drifts,    // |m| is not conserved
  refused,   // before the first step
  detected,  // stopped with status 3
};
std::string to_string(Fate fate);

/// Uniform spins at an angle to a field of strength `field` along z; rigid bodies have the inverse
/// inertia field * diag(1, 1, 2), which also turns them about z.
struct Setting {
  double field = 1, damping = 0, dt = 1. / 128;  // dt: exact in both precisions
  std::int64_t steps = 6;
  std::array<std::int64_t, 3> shape{1, 1, 1};
  bool along_field = false;
  double switched_on_at = 0;               // > 0: the field is 0 before this time
  double start_length = 1;                 // of the first spin, set after the normalisation
  std::int64_t fault_at = -1;              // step after which a spin is made NaN
  std::int64_t normalized = 0;             // steps between Newton steps to |m| = 1; 0: none
  double tolerance = 1e-4, min_dt = 0;     // of adaptive methods, which are observed every dt
  std::optional<double> temperature = {};  // empty: no [thermal]
  std::optional<double> multirate = {};    // strength of a slab's field as a SlowField
  std::int64_t substeps = 1;
  double exchange = 1, torque = 1e-6;  // torque: the bound of relax
  std::string initial = {};            // instead of spins at an angle
};

/// Reference for the end of a run. solution: the exact one. one_spin: the run of a lattice of one
/// site. no_noise: the run without [thermal], whose end has to be bitwise identical. start: the
/// initial spins.
enum class Against { nothing, solution, one_spin, no_noise, start };

/// A column of a table.
struct Situation {
  std::string name;
  Setting in_double, in_single;
  Against against = Against::nothing;
  std::int64_t detected_by = 6;  // step by which a failure must be detected
};

/// The situations of a table.
struct Section {
  std::string title;
  std::string promise;                  // an empty line and one paragraph
  std::vector<Fate> kept, broken = {};  // promised fates of methods that keep |m|; of others
  std::vector<Situation> situations = {};

  /// Adds a situation with this setting in both precisions.
  void add(std::string name, Setting const& setting, Against against = Against::nothing,
           std::int64_t detected_by = 6) {
    situations.push_back({std::move(name), setting, setting, against, detected_by});
  }
  /// Adds the situation `denormal`: a field below the smallest normal number of each precision.
  void add_denormal();
};

std::vector<Section> sections();

/// Returns the situations for methods with adaptive steps.
Section adaptive_steps();

/// Return the situations for those methods with constant steps that accept a temperature or an
/// expensive field.
Section temperatures();
Section expensive_fields();

/// Returns the situations for relaxation().
Section equilibria();

/// Returns the situations with 1e8 steps, for the simplest methods.
Section longest_runs();

}  // namespace cayspin::extremes
