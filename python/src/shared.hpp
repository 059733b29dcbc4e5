// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/precision.hpp"

#include <string>

namespace cayspin::python {

/// Returns true with Python's exception set, which the caller raises.
bool interrupted();
/// Throws the exception that interrupted() has left, also where the work ended otherwise.
void rethrow_interruption();

/// Throws UsageError for another word than double and single.
simulation::Precision precision_of(std::string const& name);

}  // namespace cayspin::python
