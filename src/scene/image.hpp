// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

// Images as site-dependent numbers. Failures to read an image throw std::runtime_error with one
// line that starts with the file.
namespace cayspin::inline v0_2::io::detail {

/// Grey values from 0 (black) to 255 (white), row by row from the top.
struct Image {
  std::int64_t width = 0, height = 0;
  std::vector<unsigned char> grey;

  /// Returns the pixel at the centre of a cell. The image covers the lattice, with its top row at
  /// the largest y.
  unsigned char at_cell(std::array<std::int64_t, 3> const& shape, std::int64_t i,
                        std::int64_t j) const {
    auto const column = (2 * i + 1) * width / (2 * shape[0]);
    auto const row = (2 * (shape[1] - j) - 1) * height / (2 * shape[1]);
    return grey[static_cast<std::size_t>(row * width + column)];
  }
};

/// Reads only the header of a PNG file.
void check_image(std::filesystem::path const& path);

/// Reads a PNG file. Colours are converted to grey, on a white background.
Image read_image(std::filesystem::path const& path);

/// Reads { image = "NAME.png", levels = [..] }. Only lattice.occupied may omit `levels`.
void read_image_keys(Table const& table, SiteNumbers& numbers);

/// For each site of a box, returns how many of the levels the grey value at the site reaches.
/// Without levels, returns 1 where the image is dark (below 128), and 0 elsewhere.
std::vector<double> numbers_of_image(SiteNumbers const& numbers, Lattice const& lattice,
                                     SiteBox const& box);

}  // namespace cayspin::inline v0_2::io::detail
