// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::inline v0_2::io {

/// A box of sites: its first site (i, j, k), and the number of sites along each axis.
struct SiteBox {
  std::array<std::int64_t, 3> begin{0, 0, 0}, extent{0, 0, 0};
};

/// Returns the part of a box in `planes` planes along z, starting at plane number `first`; z of the
/// result counts from `first`.
inline SiteBox in_planes(SiteBox const& box, std::int64_t first, std::int64_t planes) {
  SiteBox part = box;
  std::int64_t const begin = std::max(box.begin[2], first);
  std::int64_t const end = std::min(box.begin[2] + box.extent[2], first + planes);
  part.begin[2] = begin - first;
  part.extent[2] = std::max<std::int64_t>(0, end - begin);
  return part;
}

/// Appends to `chosen` the numbers of a box's sites. They are taken from `of_planes`, which holds
/// `of_site` numbers for each site of consecutive planes; z of the box counts from the first of
/// these. `shape`: (nx, ny, nz) of the lattice.
template <class Number>
void append_numbers_in(SiteBox const& box, std::array<std::int64_t, 3> const& shape,
                       std::int64_t of_site, std::vector<Number> const& of_planes,
                       std::vector<Number>& chosen) {
  for (std::int64_t z = 0; z < box.extent[2]; ++z)
    for (std::int64_t y = 0; y < box.extent[1]; ++y) {
      std::int64_t const site =
          ((box.begin[2] + z) * shape[1] + box.begin[1] + y) * shape[0] + box.begin[0];
      auto const from = of_planes.begin() + site * of_site;
      chosen.insert(chosen.end(), from, from + box.extent[0] * of_site);
    }
}

/// Returns the numbers of a box's sites. They are taken from `of_all`, which holds `of_site`
/// numbers for each site of the lattice.
template <class Number>
std::vector<Number> numbers_in(SiteBox const& box, std::array<std::int64_t, 3> const& shape,
                               std::int64_t of_site, std::vector<Number> const& of_all) {
  std::vector<Number> chosen;
  auto const& [nx, ny, nz] = box.extent;
  chosen.reserve(static_cast<std::size_t>(nx * ny * nz * of_site));
  append_numbers_in(box, shape, of_site, of_all, chosen);
  return chosen;
}

/// Reads `of_site` numbers for each site of the lattice, `at_once` planes at a time, and returns
/// those of a box. read(first, planes) returns the numbers of `planes` planes, from plane `first`
/// on.
template <class Read>
std::vector<double> read_by_planes(SiteBox const& box, std::array<std::int64_t, 3> const& shape,
                                   std::int64_t of_site, std::int64_t at_once, Read const& read) {
  std::vector<double> chosen;
  auto const& [nx, ny, nz] = box.extent;
  chosen.reserve(static_cast<std::size_t>(nx * ny * nz * of_site));
  for (std::int64_t first = 0; first < shape[2]; first += at_once) {
    auto const planes = std::min(at_once, shape[2] - first);
    append_numbers_in(in_planes(box, first, planes), shape, of_site, read(first, planes), chosen);
  }
  return chosen;
}

/// Returns how many planes along z of a lattice (nx, ny, nz) fit into 16 MiB, at least one.
inline std::int64_t planes_to_read(std::array<std::int64_t, 3> const& shape,
                                   std::int64_t bytes_of_site) {
  constexpr std::int64_t at_once = 16 << 20;
  return std::max<std::int64_t>(1, at_once / (bytes_of_site * shape[0] * shape[1]));
}

/// Calls work(box) for all planes of a lattice, some planes at a time.
template <class Work>
void for_each_box_of_planes(std::array<std::int64_t, 3> const& shape, std::int64_t bytes_of_site,
                            Work const& work) {
  auto const at_once = planes_to_read(shape, bytes_of_site);
  for (std::int64_t first = 0; first < shape[2]; first += at_once)
    work(SiteBox{{0, 0, first}, {shape[0], shape[1], std::min(at_once, shape[2] - first)}});
}

}  // namespace cayspin::inline v0_2::io
