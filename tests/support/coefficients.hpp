// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "backends.hpp"

#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <random>
#include <vector>

namespace cayspin::test {

/// Returns a ScalarField with the numbers value(site).
template <class Spins, class Value>
auto numbers_on(Lattice const& lattice, Value const& value) {
  std::vector<double> numbers;
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    numbers.push_back(static_cast<double>(value(site)));
  ScalarField<typename Spins::value_type, typename Spins::memory_space> const field("numbers",
                                                                                    lattice);
  copy_from_host(numbers, field);
  return field;
}

/// Returns random numbers between `least` and `most`, which depend only on the seed, not on the
/// platform. If `zeros` is not 0, every `zeros`-th is zero.
template <class Spins>
auto random_numbers_on(Lattice const& lattice, double least, double most, unsigned seed,
                       int zeros = 0) {
  std::mt19937 engine(seed);
  return numbers_on<Spins>(lattice, [&](std::int64_t site) {
    double const number = least + (most - least) * (engine() * 0x1p-32);
    return zeros != 0 && (site + seed) % zeros == 0 ? 0.0 : number;
  });
}

}  // namespace cayspin::test
