// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/observer/record.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace cayspin::program {

/// Watches the numbers of a run: all must be finite; a length that is kept must be 1 to 64 epsilon
/// at the start, and later to 64 epsilon a step, of which there may be a million between two looks,
/// but at most to 0.01; an energy that can only fall must not rise by more than round-off, 64
/// epsilon times the sum of its terms' absolute values.
class Guard {
 public:
  /// `epsilon`: of the run's precision. `period`: steps between looks.
  Guard(bool energy_must_fall, bool keeps_norm, double epsilon, std::int64_t period)
      : energy_must_fall_(energy_must_fall),
        keeps_norm_(keeps_norm),
        epsilon_(epsilon),
        period_(period) {}

  bool due(Step const& step) const { return step.number % period_ == 0; }

  /// What is wrong with a state, if anything: one line with step and time.
  std::optional<std::string> judge(Step const& step, Energy const& energy, double norm_defect);

  double first_energy() const { return first_->energy; }

 private:
  struct Look {
    std::int64_t step;
    double energy;
  };
  bool energy_must_fall_, keeps_norm_;
  double epsilon_;
  std::int64_t period_;
  std::optional<Look> first_, last_;
};

}  // namespace cayspin::program
