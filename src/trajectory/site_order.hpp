// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Returns states in the order of files: in each state, the sites 0 of all cells of a crystal, then
/// all sites 1, and so on. The states follow each other in `spins`, each packed as (nz, ny, nx, 3)
/// in the order of the header's shape.
template <class Real>
std::vector<Real> by_sites(std::vector<Real> const& spins, TrajectoryHeader const& header) {
  if (header.cell_sites == 1) return spins;
  auto const plane = static_cast<std::size_t>(3 * header.shape[0] * header.shape[1]);
  auto const planes = static_cast<std::size_t>(header.shape[2]);
  auto const sites = static_cast<std::size_t>(header.cell_sites);
  std::vector<Real> sorted;
  sorted.reserve(spins.size());
  for (std::size_t state = 0; state < spins.size(); state += plane * planes)
    for (std::size_t site = 0; site < sites; ++site)
      for (std::size_t k = site; k < planes; k += sites) {
        auto const from = spins.begin() + static_cast<std::ptrdiff_t>(state + k * plane);
        sorted.insert(sorted.end(), from, from + static_cast<std::ptrdiff_t>(plane));
      }
  return sorted;
}

/// The inverse of by_sites.
template <class Real>
std::vector<Real> by_planes(std::vector<Real> const& spins, TrajectoryHeader const& header) {
  if (header.cell_sites == 1) return spins;
  auto const plane = static_cast<std::size_t>(3 * header.shape[0] * header.shape[1]);
  auto const planes = static_cast<std::size_t>(header.shape[2]);
  auto const sites = static_cast<std::size_t>(header.cell_sites);
  std::vector<Real> sorted(spins.size());
  auto from = spins.begin();
  for (std::size_t state = 0; state < spins.size(); state += plane * planes)
    for (std::size_t site = 0; site < sites; ++site)
      for (std::size_t k = site; k < planes; k += sites) {
        auto const next = from + static_cast<std::ptrdiff_t>(plane);
        std::copy(from, next, sorted.begin() + static_cast<std::ptrdiff_t>(state + k * plane));
        from = next;
      }
  return sorted;
}

}  // namespace cayspin::inline v0_2::io
