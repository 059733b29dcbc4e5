// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The single rank of a program without MPI.
#include "launched_ranks.hpp"
#include "simulation/one_rank.hpp"

namespace cayspin::program {

std::unique_ptr<simulation::Ranks> launched_ranks() {
  return std::make_unique<simulation::OneRank>();
}

void start_others_alone() {}

}  // namespace cayspin::program
