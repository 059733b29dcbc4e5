// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/dipolar_field.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace cayspin::test {

using Numbers = std::array<std::int64_t, 3>;
using Images = std::array<int, 3>;
inline constexpr int all = infinitely_many_images;

struct Sample {
  Crystal crystal;
  Numbers cells;
  std::array<double, 3> spacing = {1, 1, 1};

  Lattice lattice() const {
    auto made = crystal.lattice(cells);
    made.spacing = spacing;
    return made;
  }
  Crystal::Point place(std::int64_t site) const {
    auto const basis = static_cast<std::int64_t>(crystal.basis.size());
    std::int64_t const plane = site / (cells[0] * cells[1]);
    auto r = crystal.position({site % cells[0], site / cells[0] % cells[1], plane / basis},
                              static_cast<std::size_t>(plane % basis));
    for (std::size_t axis = 0; axis < 3; ++axis) r[axis] *= spacing[axis];
    return r;
  }
  double volume() const { return spacing[0] * spacing[1] * spacing[2]; }
};

inline std::array<Crystal::Point, 3> const oblique{
    {{1, 0.1, 0}, {0.4, 0.9, 0.2}, {-0.3, 0.2, 1.1}}};
inline std::vector<Sample> const open_crystals = {
    {Crystal::bcc(), {5, 4, 3}},
    {Crystal::fcc(), {3, 4, 2}, {1, 1.5, 0.7}},
    {Crystal::honeycomb(), {6, 5, 1}},
    {{oblique, {{0, 0, 0}}}, {4, 5, 3}},
    {{oblique, {{0, 0, 0}, {0.3, 0.6, 0.2}}}, {3, 3, 4}, {2, 2, 2}},
    {{oblique, {{0, 0, 0}, {0.5, 0.1, 0}, {0.2, 0.5, 0.4}, {0.7, 0.8, 1.4}}}, {3, 2, 3}},
    {{oblique, {{0, 0, 0}, {0.5, 0.1, 0}, {0.2, 0.5, 0.4}}}, {1, 1, 1}},
    {Crystal::pyrochlore(), {2, 1, 2}},
};

}  // namespace cayspin::test
