// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/ranks.hpp"

#include <memory>

namespace cayspin::program {

/// Returns the ranks that the program was launched as: one, unless it is built with MPI and a
/// launcher such as mpiexec started more.
std::unique_ptr<simulation::Ranks> launched_ranks();

/// Prevents processes that this one starts from becoming ranks.
void start_others_alone();

}  // namespace cayspin::program
