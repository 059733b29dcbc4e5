// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/lattice.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_2::detail {

/// Number of ghost layers that a stepper declares; 0 if it does not run on parts of a lattice.
template <class Stepper>
inline constexpr int ghosts_of = 0;
template <class Stepper>
  requires requires { Stepper::ghosts; }
inline constexpr int ghosts_of<Stepper> = Stepper::ghosts;

/// Base class of steppers. Each step or batch starts with begin_step, which checks its arguments at
/// compile time and at run time, and opens a profiling region.
template <class Spins>
class StepperBase {
 public:
  using spins_type = Spins;
  using Real = typename Spins::value_type;

  // Not copyable: a copy would share the memory of the stepper's fields, but have its own counters.
  StepperBase(StepperBase const&) = delete;
  StepperBase& operator=(StepperBase const&) = delete;
  // A moved-from stepper has no lattice, so that it refuses all spins.
  StepperBase(StepperBase&& other)
      : lattice_(std::exchange(other.lattice_, no_lattice)), region_(other.region_) {}
  StepperBase& operator=(StepperBase&& other) {
    lattice_ = std::exchange(other.lattice_, no_lattice);
    region_ = other.region_;
    return *this;
  }

  /// For cayspin::integrate: visits no field, because by default a step does not swap the memory of
  /// the spins.
  template <class Visit>
  void visit_exchanged(Visit const&) {}

  /// Throws std::invalid_argument when `spins` is not on the lattice given at construction.
  void check_spins(Spins const& spins, char const* call = "") const {
    if (!(spins.lattice() == lattice_))
      throw std::invalid_argument(region_ + call + ": the spins are not of the stepper's lattice");
  }

 protected:
  /// `ghosts`: ghost layers that a step needs at each inner end of a part of a lattice; 0 if the
  /// stepper does not run on parts.
  StepperBase(std::string const& name, Lattice const& lattice, int ghosts = 0)
      : lattice_(lattice), region_("cayspin::" + name) {
    lattice.validate();
    require_ghosts(region_, lattice, ghosts);
  }

  CAYSPIN_DETAIL_NOINLINE std::string label(char const* stage) const { return region_ + stage; }
  /// Returns the stepper's label followed by "::stage_1", "::stage_2", ..
  template <std::size_t Stages>
  std::array<std::string, Stages> stage_labels() const {
    std::array<std::string, Stages> labels;
    for (std::size_t i = 0; i < Stages; ++i) labels[i] = stage_label(i + 1);
    return labels;
  }

  /// Checks the spins, and returns a profiling region, which ends when the returned object is
  /// destroyed. `call`: name of the member function, for messages.
  template <class Exec>
  [[nodiscard]] Kokkos::Profiling::ScopedRegion begin_step(Exec const&, Spins const& spins,
                                                           char const* call = "::step") const {
    check_access<Exec, typename Spins::memory_space>();
    check_spins(spins, call);
    return Kokkos::Profiling::ScopedRegion(region_);
  }

  /// Throws std::invalid_argument when `spins` is an outdated handle: a step has swapped memory,
  /// and that of `spins` now belongs to the stepper, as `own`.
  void require_other_memory(Spins const& spins, Spins const& own) const {
    if (spins.array().data == own.array().data) [[unlikely]]
      throw std::invalid_argument(
          label("::step: the spins are the stepper's own memory, since a step exchanged it; take "
                "the field that the step was given"));
  }
  void require_steps(std::int64_t count) const {
    if (count < 1) throw std::invalid_argument(label("::batch: the number of steps is below 1"));
  }

  ~StepperBase() = default;

  Lattice lattice_;

 private:
  static constexpr Lattice no_lattice{{0, 0, 0}};

  CAYSPIN_DETAIL_NOINLINE std::string stage_label(std::size_t number) const {
    return label("::stage_") + std::to_string(number);
  }

  std::string region_;
};

}  // namespace cayspin::inline v0_2::detail
