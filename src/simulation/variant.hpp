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

/// Numbers that a scene gives to its method.
struct MethodOptions {
  io::Rotation rotation = io::Rotation::cayley;
  double sigma = 0, cap = 0;  // of isotropies that have one
  StepOptions steps = {};     // of adaptive methods
};

/// A stepper for one simulation, which must outlive the stepper. The stepper keeps the memory of
/// its method.
class OpenMethod {
 public:
  virtual ~OpenMethod() = default;
  /// Integrates over the simulation's times, and calls the simulation's observer.
  virtual Summary advance() = 0;
  /// Stores or restores the memory of the method.
  virtual void serialize(Checkpoint& checkpoint) = 0;
};

/// One compiled integrator: a method with one choice of each option that changes the type of its
/// stepper, except that it contains the steppers of all `rotations`.
struct Variant {
  io::Method const* method;
  io::Isotropy isotropy = io::Isotropy::zero;  // zero also stands for a constant
  bool in_chart = false;                       // generator "tangent"
  bool compensated = false;
  bool of_rigid_bodies = false;            // if they have a separate stepper
  io::SetOf<io::Rotation> rotations = {};  // empty: a baseline

  int order = 0;
  std::optional<int> evaluations = {};  // of the generator per step, if constant
  bool remembers = false;               // earlier steps
  int ghosts = 0;       // rows of ghosts around a part of a lattice; 0: only whole lattices
  int work_fields = 0;  // spin fields of work memory, if stages run one by one

  /// Returns the bytes of work memory. `by_time_only`: the scene's field can be prepared from t,
  /// without the spins.
  std::int64_t (*work_bytes)(Lattice const& lattice, bool by_time_only, Precision precision) = {};
  /// cayspin::largest_stable_step of the stepper; infinity if no bound is known.
  double (*stable_step)(double field_bound, double damping, bool precession,
                        MethodOptions const& options) = {};
  /// Allocates the stepper.
  std::unique_ptr<OpenMethod> (*open)(AnySimulation simulation, MethodOptions const& options) = {};
};

/// Returns all variants, method by method in the order of the list.
std::span<Variant const> variants();

/// Returns the variants of one shard. Compiled in source files generated from method_shard.cpp.in.
template <int Shard>
std::vector<Variant> method_shard();

Variant const& find_variant(io::Scene const& scene);

}  // namespace cayspin::simulation
