// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"
#include "io/method.hpp"
#include "io/words.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

namespace cayspin::inline v0_2::io {

/// The table [integrator]: the method, its choices and its steps.
struct Integrator {
  Method const* method = nullptr;
  Generator generator = Generator::standard;
  Isotropy isotropy = Isotropy::zero;
  double sigma = 0;  ///< isotropy constant: sigma * m is added to the generator A
  double isotropy_cap = std::numeric_limits<double>::infinity();  ///< bound on |dt * sigma|
  Rotation rotation = Rotation::cayley;
  double dt = 0;                    ///< the step; if adaptive, the time between observations
  std::int64_t steps = 0;           ///< computed from `end` when the scene gives that
  std::int64_t substeps = 1;        ///< steps of the method in each dt, for an expensive field
  std::optional<double> tolerance;  ///< only for adaptive methods
  std::optional<double> error;      ///< for method "auto": largest error allowed
  /// Bounds on the internal steps of an adaptive method.
  double min_dt = 0, max_dt = std::numeric_limits<double>::infinity();
  bool compensated = false;      ///< adds the rounding error of the spins to the next step
  bool energy_guard = true;      ///< stops a run whose energy rises although it should only fall
  bool energy_control = false;   ///< keeps the energy constant in a run without damping
  bool refuse_unstable = false;  ///< an unstable dt is an error, not a warning
  std::optional<double> until_torque;

  static constexpr auto keys() {
    return std::to_array<Key<Integrator>>(
        {{"method"},
         {"generator"},
         {"isotropy"},
         {"isotropy_cap"},
         {"rotation"},
         {"dt"},
         {"end"},
         {"steps"},
         {"substeps", &Integrator::substeps, {"a whole number >= 1", 1}},
         {"tolerance"},
         {"min_dt", &Integrator::min_dt, not_negative},
         {"max_dt", &Integrator::max_dt, positive},
         {"error"},
         {"compensated", &Integrator::compensated},
         {"energy_guard", &Integrator::energy_guard},
         {"energy_control", &Integrator::energy_control},
         {"refuse_unstable", &Integrator::refuse_unstable},
         {"until_torque", &Integrator::until_torque, positive}});
  }
};

}  // namespace cayspin::inline v0_2::io
