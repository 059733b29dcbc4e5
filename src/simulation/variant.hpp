// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/method.hpp"
#include "simulate.hpp"

#include <cayspin/checkpoint.hpp>
#include <cayspin/stepper/step_control.hpp>

#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace cayspin::simulation {

/// The numbers that a scene gives to its method.
struct MethodOptions {
  io::Rotation rotation = io::Rotation::cayley;
  double sigma = 0, cap = 0;  // of isotropies that have one
  StepOptions steps = {};     // of adaptive methods
};

/// A stepper at work on one simulation, which outlives it. It remembers what its method does.
class OpenMethod {
 public:
  virtual ~OpenMethod() = default;
  /// Integrates over the simulation's times, under its observer.
  virtual Summary advance() = 0;
  /// Stores or restores what it remembers.
  virtual void exchange_memory(Checkpoint& checkpoint) = 0;
};

/// One compiled integrator: a method with what changes its stepper's type.
struct Variant {
  io::Method const* method;
  io::Isotropy isotropy = io::Isotropy::zero;  // zero also stands for a constant
  bool in_chart = false;                       // generator "tangent"
  bool compensated = false;
  bool of_rigid_bodies = false;            // where these have a stepper of their own
  io::SetOf<io::Rotation> rotations = {};  // none: a baseline

  int order = 0;
  std::optional<int> evaluations = {};  // of the generator, per step, where that is a fixed number
  bool remembers = false;               // steps before the present one
  int ghosts = 0;                       // on a part of a lattice; 0: not on parts
  int work_fields = 0;                  // spin fields of work memory, where stages go one by one

  /// Bytes of work memory. by_time_alone: the scene's field needs no spins to be made ready.
  std::int64_t (*work_bytes)(Lattice const& lattice, bool by_time_alone, Precision precision) = {};
  /// cayspin::largest_stable_step of the stepper; infinity where no bound is known.
  double (*stable_step)(double field_bound, double damping, bool precession,
                        MethodOptions const& options) = {};
  /// Allocates the stepper.
  std::unique_ptr<OpenMethod> (*open)(AnySimulation simulation, MethodOptions const& options) = {};
};

/// All of them, method by method in the order of the list.
std::span<Variant const> variants();

/// Compiled in source files of its own, made from method_shard.cpp.in.
template <int Shard>
std::vector<Variant> method_shard();

Variant const& find_variant(io::Scene const& scene);

}  // namespace cayspin::simulation
