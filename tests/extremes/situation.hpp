// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::extremes {

/// What may become of a run.
enum class Fate {
  exact,     // the exact solution, to round-off
  bounded,   // on the sphere, off the solution by what the method's order lets it be
  warned,    // the program says beforehand that dt is too large; on the sphere, or stopped
  drifts,    // |m| is not kept
  refused,   // before the first step
  detected,  // stopped with status 3
};
std::string to_string(Fate fate);

/// Uniform spins at an angle to a field of strength `field` along z; rigid bodies have the inverse
/// inertia field diag(1, 1, 2), which turns them about z too.
struct Setting {
  double field = 1, damping = 0, dt = 1. / 128;  // a power of two, as no precision rounds it
  std::int64_t steps = 6;
  std::array<std::int64_t, 3> shape{1, 1, 1};
  bool along_field = false;
  double switched_on_at = 0;               // > 0: the field is 0 before
  double start_length = 1;                 // of the first spin, after the program's own normalising
  std::int64_t fault_at = -1;              // step after which a spin is made NaN
  std::int64_t normalized = 0;             // steps between Newton steps; 0: none
  double tolerance = 1e-4, min_dt = 0;     // of adaptive methods, which look at the spins every dt
  std::optional<double> temperature = {};  // none: no [thermal]
  std::optional<double> dear = {};         // strength of a slab's field, named dear
  std::int64_t substeps = 1;
  double exchange = 1, torque = 1e-6;  // the latter: relax's bound
  std::string initial = {};            // instead of spins at an angle
};

/// What the end is compared with.
/// One spin: a lattice of one. No noise: each bit of the run without [thermal].
enum class Against { nothing, solution, one_spin, no_noise, start };

/// One column of a table.
struct Situation {
  std::string name;
  Setting in_double, in_single;
  Against against = Against::nothing;
  std::int64_t detected_by = 6;  // step at which a failure has to be seen
};

/// What a table says together.
struct Section {
  std::string title;
  std::string promise;                  // an empty line and one paragraph
  std::vector<Fate> kept, broken = {};  // fates of methods that keep |m|, and of classical_*
  std::vector<Situation> situations = {};

  /// One of the same setting in both precisions.
  void add(std::string name, Setting const& setting, Against against = Against::nothing,
           std::int64_t detected_by = 6) {
    situations.push_back({std::move(name), setting, setting, against, detected_by});
  }
  /// Spins without a field that a precision holds as a normal number.
  void add_denormal();
};

std::vector<Section> sections();

/// For the adaptive methods.
Section adaptive_steps();

/// For both.
Section temperatures();
Section dear_fields();

/// For relaxation().
Section states_of_rest();

/// 1e8 steps, for the simplest methods.
Section longest_runs();

}  // namespace cayspin::extremes
