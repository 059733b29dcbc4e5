// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/minimum.hpp>
#include <cayspin/minimizer/trial.hpp>
#include <cayspin/path/found.hpp>
#include <cayspin/path/great_circles.hpp>
#include <cayspin/path/saddle.hpp>
#include <cayspin/path/string.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

// Saddles that a path with few images misses: between two fixed images without others between them,
// nothing shows a maximum of the energy.
namespace cayspin::inline v0_2::detail {

/// Returns the energies of the two minima to which the energy falls from the saddle at an image of
/// a path, or nothing if the search for one of them fails. Overwrites `search` and `work`. `climb`:
/// sets the search's vector to the one along which the energy falls, and returns false if it fails.
/// `relax`: minimizes the energy.
template <class Exec, class Spins, class Climb, class Relax>
std::optional<std::array<double, 2>> minima_beside(Exec const& exec, PathString<Spins> const& path,
                                                   std::size_t image, SaddleSearch<Spins>& search,
                                                   Spins& work, Climb const& climb,
                                                   Relax const& relax) {
  using Real = typename Spins::value_type;
  constexpr double away = 0.1;  // rad
  auto const &spins = search.spins(), &vector = search.vector();
  Kokkos::deep_copy(exec, spins.allocation(), path.spins(image).allocation());
  find_direction(exec, spins, path.spins(image - 1), path.spins(image + 1), spins, 1, 1, vector);
  if (!climb()) return std::nullopt;
  double const turn = away / largest_length(exec, vector);
  std::array<double, 2> energies{};
  for (std::size_t side = 0; side < 2; ++side) {
    for_each_site<Real>(exec, "cayspin::path::descend", spins.layout(),
                        TurnTowards<Real>{spins.array(), vector.array(), work.output(false),
                                          static_cast<Real>(side == 0 ? turn : -turn)});
    auto const found = relax(work);
    if (found.end != MinimizeEnd::converged) return std::nullopt;
    energies[side] = found.energy.value;
  }
  return energies;
}

/// Returns true if a saddle is missing between neighbouring fixed images of a path: between two
/// minima, or between a minimum and a saddle from which the energy does not fall to that minimum.
/// Minima are compared by energy, because a symmetry may turn or shift them. `round_off`: of
/// energies. The other arguments are those of minima_beside.
template <class Exec, class Spins, class Climb, class Relax>
bool misses_saddle(Exec const& exec, PathString<Spins> const& path,
                   std::vector<PathSaddle> const& saddles, SaddleSearch<Spins>& search, Spins& work,
                   double round_off, Climb const& climb, Relax const& relax) {
  auto const is_saddle = [&](std::size_t image) {
    return path.is_fixed(image) && std::ranges::any_of(saddles, [&](PathSaddle const& known) {
             return known.energy == path.energy(image);
           });
  };
  auto const is_minimum = [&](std::size_t image) {
    return path.is_fixed(image) && !is_saddle(image);
  };
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
    if (is_minimum(k) && is_minimum(k + 1)) return true;
  for (std::size_t k = 1; k + 1 < path.size(); ++k) {
    if (!is_saddle(k) || !(is_minimum(k - 1) || is_minimum(k + 1))) continue;
    auto const reached = minima_beside(exec, path, k, search, work, climb, relax);
    if (!reached) return false;
    auto const leads_to = [&](std::size_t side, std::size_t beside) {
      double const energy = path.energy(beside);
      double const small = std::max(1e-3 * std::abs(path.energy(k) - energy), 2 * round_off);
      return !is_minimum(beside) || std::abs((*reached)[side] - energy) <= small;
    };
    bool const is_between = leads_to(0, k - 1) && leads_to(1, k + 1);
    bool const is_between_turned = leads_to(1, k - 1) && leads_to(0, k + 1);
    if (!is_between && !is_between_turned) return true;
  }
  return false;
}

}  // namespace cayspin::inline v0_2::detail
