// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

/// Returns random spins (sites, 3), uniform on the sphere, from the same random numbers on every
/// machine. They are generated once for each number of sites.
inline std::vector<double> const& random_spins(std::int64_t sites) {
  static std::map<std::int64_t, std::vector<double>> made;
  auto& spins = made[sites];
  if (!spins.empty()) return spins;
  spins.resize(static_cast<std::size_t>(sites) * 3);
  std::uint64_t state = 1;
  auto const uniform = [&state] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  for (std::size_t i = 0; i < spins.size(); i += 3) {
    double const z = 2 * uniform() - 1, phi = 6.283185307179586 * uniform();
    double const r = std::sqrt(1 - z * z);
    spins[i] = r * std::cos(phi), spins[i + 1] = r * std::sin(phi), spins[i + 2] = z;
  }
  return spins;
}
