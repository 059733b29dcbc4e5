// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/solver/cell_grid.hpp>
#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// A grid of a multigrid hierarchy, and its memory.
template <class Real, int RightComponents, class MemorySpace>
struct MultigridLevel {
  using Right = SiteField<Real, RightComponents, MemorySpace>;
  using Field = SiteField<Real, 3, MemorySpace>;

  /// Replaces `lattice` and `axes` by those of the next level, which coarsens the axes whose
  /// strength (J divided by the squared width of the cells) is at least half the largest strength.
  MultigridLevel(std::string const& name, Lattice& lattice, std::array<double, 3> const& couplings,
                 std::vector<CellAxis>& axes, bool smooths_only_after)
      : layout(RowLayout::of<Real>(lattice)),
        right(name + "::right", lattice),
        one(name + "::one", lattice),
        other(name + "::other", lattice) {
    std::array<double, 3> strengths{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      tables[axis] = {name, axes[axis], couplings[axis]};
      grid.axis[axis] = tables[axis].arrays();
      grid.extent[axis] = static_cast<std::int32_t>(lattice.shape[axis]);
      grid.periodic[axis] = layout.periodic[axis];
      strengths[axis] = 0.5 * couplings[axis] * axes[axis].largest_sum();
      largest += 4 * strengths[axis];
    }
    double const strongest = *std::max_element(strengths.begin(), strengths.end());
    least = largest;
    // Coarsens x last, because it costs most.
    for (int const number : {2, 1, 0}) {
      auto const axis = static_cast<std::size_t>(number);
      if (strengths[axis] == 0 || strengths[axis] < 0.5 * strongest) continue;
      if (!coarsened.empty()) {
        between.emplace_back(name + "::between", lattice);
        rights_between.emplace_back(name + "::right_between", lattice);
      }
      coarsened.push_back(number);
      // Where a coarse cell holds three cells, the coarse grid also loses longer waves.
      double const lowest = !smooths_only_after ? 1.5 : axes[axis].cells() % 2 == 1 ? 0.6 : 1.2;
      least = std::min(least, lowest * strengths[axis]);
      axes[axis] = axes[axis].coarser();
      lattice.shape[axis] = static_cast<std::int64_t>(axes[axis].cells());
    }
  }

  RowLayout layout;
  CellGrid<Real> grid{};
  std::array<CellAxisTables<Real, MemorySpace>, 3> tables;
  double least = 0, largest = 0;  // range of frequencies of K to smooth
  std::vector<int> coarsened;     // axes, in the order of coarsening
  Right right;
  Field one, other;
  std::vector<Right> rights_between;  // right-hand sides with only some axes coarsened
  std::vector<Field> between;
};

}  // namespace cayspin::inline v0_2::detail
