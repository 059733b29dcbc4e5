// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/given.hpp"
#include "io/key.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2::io {

/// One number for each site: from an expression as in [initial], an HDF5 or OVF file, the pixels of
/// an image, one number for each of the lattice's regions, or passed by a program.
struct SiteNumbers {
  std::string expression;
  std::filesystem::path file;
  std::vector<double> per_region;
  GivenNumbers given;
  double unit = 1;  ///< multiplies each number, which may be typed in SI
  std::string key;  ///< if set, the key that gives the numbers, for messages
  std::filesystem::path image = {};
  std::vector<int> levels = {};  ///< a pixel's number is how many of these grey values it reaches

  bool there() const {
    return !expression.empty() || !file.empty() || !image.empty() || !per_region.empty() || given;
  }
  std::string_view key_or(std::string_view other) const {
    return key.empty() ? other : std::string_view(key);
  }
};

/// One vector for each site: from components that are numbers or site-dependent, from the dataset
/// /values (.., 3) of an HDF5 file, from an OVF file, or one vector for each of the lattice's
/// regions.
struct SiteVectors {
  Triple uniform = {};
  std::array<SiteNumbers, 3> components = {};  ///< each, if set, replaces its number in `uniform`
  std::filesystem::path file;
  std::vector<Triple> per_region;
  double unit = 1;  ///< multiplies each number
  std::string key;  ///< if set, the key that gives the vectors, for messages

  bool there() const {
    return !file.empty() || !per_region.empty() || uniform != Triple{} ||
           std::ranges::any_of(components, &SiteNumbers::there);
  }
  std::string_view key_or(std::string_view other) const {
    return key.empty() ? other : std::string_view(key);
  }
};

}  // namespace cayspin::inline v0_2::io
