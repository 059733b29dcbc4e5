// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/ranks.hpp"

#include <memory>

namespace cayspin::program {

/// Returns the ranks with which the program was launched. There is one rank unless the program is
/// built with MPI, and a launcher such as mpiexec has started more.
std::unique_ptr<simulation::Ranks> launched_ranks();

/// Prevents processes that this one starts from becoming ranks.
void start_others_alone();

}  // namespace cayspin::program
