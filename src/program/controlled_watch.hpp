// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "watch.hpp"

#include <cayspin/observer/energy_control.hpp>

namespace cayspin::program {

/// A watch, and behind it the control that holds the run's energy.
template <class Real, class Space>
class ControlledWatch : public Observer<Space, SpinField<Real, typename Space::memory_space>> {
  using Spins = SpinField<Real, typename Space::memory_space>;

 public:
  ControlledWatch(Watch<Real, Space>& watch, SceneGenerator<Spins> const& generator,
                  Spins const& spins)
      : watch_(watch), control_(generator, spins) {}

  bool due(Step const&) const override { return true; }

  Next operator()(Space const& exec, Step const& step, Spins const& spins) override {
    auto const next = watch_.due(step) ? watch_(exec, step, spins) : Next::proceed;
    if (next == Next::proceed && !step.last) control_(exec, step, spins);
    return next;
  }

  std::int64_t evaluations() const { return control_.evaluations_done(); }

 private:
  Watch<Real, Space>& watch_;
  EnergyControl<Spins, SceneGenerator<Spins>> control_;
};

}  // namespace cayspin::program
