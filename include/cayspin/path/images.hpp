// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// Throws std::invalid_argument for images that cannot become a path: fewer than three, on
/// different lattices, or in memory of another image or of `saddle`.
template <class Spins>
void require_images(std::string const& who, std::vector<Spins> const& images, Spins const& saddle) {
  if (images.size() < 3) throw std::invalid_argument(who + ": a path has at least 3 images");
  for (auto const& image : images) require_lattice(who.c_str(), saddle.lattice(), image.lattice());
  std::vector<void const*> memory{saddle.allocation().data()};
  for (auto const& image : images) memory.push_back(image.allocation().data());
  std::ranges::sort(memory);
  if (std::ranges::adjacent_find(memory) != memory.end())
    throw std::invalid_argument(
        who +
        ": images or the saddle share memory; accepted: fields that were constructed one by "
        "one, because copies of a field share its memory");
}

}  // namespace cayspin::inline v0_2::detail
