// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/io/scene.hpp>
#include <cayspin/stepper/step_control.hpp>

#include <span>
#include <vector>

namespace cayspin::program {

/// The scene's choices within a method.
struct MethodOptions {
  io::Rotation rotation = io::Rotation::cayley;
  double sigma = 0, cap = 0;  // of isotropies that have one
  StepOptions steps;          // of adaptive methods
};

/// What tells integrators apart that are compiled for themselves. isotropy: zero also stands for a
/// constant; tangent: the generator of that name; rigid_body: for energy, which has its formulas
/// there and projects elsewhere, and for series, which are local there; compensated: with
/// compensated sums.
struct MethodKey {
  io::Method method;
  io::Isotropy isotropy = io::Isotropy::zero;
  bool tangent = false, rigid_body = false, compensated = false;

  friend bool operator==(MethodKey const&, MethodKey const&) = default;
};

/// What the program knows about one integrator. A new one is a source file that defines such an
/// entry, and a line in method_table.cpp.
struct MethodEntry {
  MethodKey key;
  int order;
  int evaluations;   // of the generator, per step; 0 where it iterates or chooses its steps
  int work_fields;   // spin fields of work memory, where stages go one by one
  bool exponential;  // rotations that it may take: Cayley alone, or both

  /// Of work memory, for the scene's lattice; by_time_alone: its field needs no spins beforehand.
  std::int64_t (*work_bytes)(Lattice const& lattice, bool by_time_alone, bool twice);
  /// cayspin::largest_stable_step of the method; infinity where no bound is known.
  double (*stable_step)(double field_bound, double damping, bool precession,
                        MethodOptions const& options);
  /// Allocates the stepper and integrates.
  Summary (*advance)(AnySimulation simulation, MethodOptions const& options);
};

std::span<MethodEntry const> method_entries();
MethodEntry const& find_method(io::Scene const& scene);

using MethodEntries = std::vector<MethodEntry>;
MethodEntries euler_entries();
MethodEntries corrected_euler_entries();
MethodEntries heun_entries();
MethodEntries rkmk4_entries();
MethodEntries rkmk5_entries();
MethodEntries rkmk8_entries();
MethodEntries adams_bashforth_entries();
MethodEntries implicit_entries();
MethodEntries series4_entries();
MethodEntries commutator_free_entries();
MethodEntries field_extrapolation_entries();
MethodEntries red_black_entries();
MethodEntries tsitouras_entries();
MethodEntries dormand_prince_entries();
MethodEntries bogacki_shampine_entries();
MethodEntries tangent_entries();
MethodEntries classical_entries();
MethodEntries projected_entries();

}  // namespace cayspin::program
