// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <cayspin/lattice.hpp>

std::int64_t SITES() { return cayspin::Lattice::chain(7).sites(); }
