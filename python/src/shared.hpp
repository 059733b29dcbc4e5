// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/precision.hpp"

#include <nanobind/nanobind.h>

#include <memory>
#include <string>

namespace cayspin::python {

/// Returns true if a signal such as Ctrl-C has set a Python exception, which the caller must raise.
bool interrupted();
/// Throws the Python exception that an earlier call of interrupted() has left, if there is one.
void rethrow_interruption();

/// Throws UsageError unless the name is "double" or "single".
simulation::Precision precision_of(std::string const& name);

/// Returns a pointer whose deleter releases the GIL: freeing a Kokkos View waits for all kernels,
/// and those of another thread may wait for the GIL.
template <class Run>
std::shared_ptr<Run> shared(std::unique_ptr<Run> run) {
  return {run.release(), [](Run* held) {
            nanobind::gil_scoped_release const released;
            delete held;
          }};
}

}  // namespace cayspin::python
