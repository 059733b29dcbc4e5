// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/ranks.hpp"

#include <memory>

namespace cayspin::program {

/// The ranks that the program was launched as. One, unless it is built with MPI and a launcher such
/// as mpiexec started more.
std::unique_ptr<simulation::Ranks> launched_ranks();

/// Processes that this one starts are no ranks.
void start_others_alone();

}  // namespace cayspin::program
