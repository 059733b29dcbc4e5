// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/io/words.hpp>

#include <span>

namespace cayspin::program {

/// The scene's choices within a method.
struct MethodOptions {
  io::Rotation rotation = io::Rotation::cayley;
  double sigma = 0;
};

/// What the program knows about one integrator. A new one is a source file that defines such an
/// entry, and a line in methods.cpp.
struct MethodEntry {
  io::Method method;
  int order;
  int evaluations;  // of the generator, per step
  int work_fields;  // spin fields of work memory

  /// cayspin::largest_stable_step of the method.
  double (*stable_step)(double field_bound, double damping, bool precession,
                        MethodOptions const& options);
  /// Allocates the stepper and integrates.
  Summary (*advance)(AnySimulation simulation, MethodOptions const& options);
};

std::span<MethodEntry const> method_entries();
MethodEntry const& find_method(io::Method method);

MethodEntry euler_entry();
MethodEntry rkmk4_entry();
MethodEntry rkmk4_as_printed_entry();
MethodEntry classical_euler_entry();
MethodEntry classical_heun_entry();
MethodEntry classical_rk4_entry();
MethodEntry projected_euler_entry();
MethodEntry projected_heun_entry();
MethodEntry projected_rk4_entry();

}  // namespace cayspin::program
