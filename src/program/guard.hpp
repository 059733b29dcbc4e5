// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/observer/record.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace cayspin::program {

/// Watches the numbers of a run: all must be finite, and an energy that can only fall must not rise
/// by more than round-off, 64 epsilon times the sum of its terms' absolute values.
class Guard {
 public:
  /// `epsilon`: of the run's precision. `period`: steps between looks.
  Guard(bool energy_must_fall, double epsilon, std::int64_t period)
      : energy_must_fall_(energy_must_fall), epsilon_(epsilon), period_(period) {}

  bool due(Step const& step) const { return step.number % period_ == 0; }

  /// What is wrong with a state, if anything: one line with step and time.
  std::optional<std::string> judge(Step const& step, Energy const& energy, double norm_defect);

  double first_energy() const { return first_->energy; }

 private:
  struct Look {
    std::int64_t step;
    double energy;
  };
  bool energy_must_fall_;
  double epsilon_;
  std::int64_t period_;
  std::optional<Look> first_, last_;
};

}  // namespace cayspin::program
