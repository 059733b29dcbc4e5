// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace cayspin::inline v0_2::io::detail {
namespace {

// Limit of cayspin::Lattice::validate.
constexpr std::int64_t most_extent = std::numeric_limits<std::int32_t>::max() / 4;

// Reads one entry per axis of the shape, or one value for every axis. read(item, accepted) returns
// one value.
template <class Value, class Read>
void read_per_axis(Item const& item, std::size_t axes, std::array<Value, 3>& values, Read read,
                   std::string_view one) {
  auto const accepted =
      fmt::format("{}, or a list with one per axis of lattice.shape ({})", one, axes);
  if (!item.node->is_array()) {
    values.fill(read(item, accepted));
    return;
  }
  auto const items = entries(item, axes, axes, accepted);
  for (std::size_t axis = 0; axis < axes; ++axis) values[axis] = read(items[axis], one);
}

constexpr std::string_view keys_of_spins[] = {"spacing", "boundary", "crystal",      "cell",
                                              "basis",   "moments",  "gyromagnetic", "occupied",
                                              "frozen",  "regions",  "follow"};

}  // namespace

Lattice read_lattice(Table const& root, SystemKind kind) {
  auto const table = root.table("lattice", "a table [lattice]");
  bool const bodies = kind == SystemKind::rigid_body;
  std::vector<std::string_view> keys{"shape"};
  keys.insert(keys.end(), std::begin(keys_of_spins), std::end(keys_of_spins));
  table.accept_only(keys);
  std::string_view const accepted = bodies ? "[count]" : "[nx], [nx, ny] or [nx, ny, nz]";

  auto const shape = table.required("shape", accepted);
  auto const extents = entries(shape, 1, bodies ? 1 : 3, accepted);
  Lattice lattice;
  std::int64_t room = std::numeric_limits<std::int64_t>::max() / std::int64_t{3 * sizeof(double)};
  for (std::size_t axis = 0; axis < extents.size(); ++axis) {
    auto const extent = integer(extents[axis], {"a whole number >= 1", 1});
    if (extent > most_extent)
      extents[axis].fail(fmt::format("{} is too large", extent),
                         fmt::format("a whole number from 1 to {}", most_extent));
    if (extent > room) shape.fail("more sites than memory can address", "a smaller shape");
    room /= extent;
    lattice.shape[axis] = extent;
  }
  for (auto const name : keys_of_spins) {
    if (auto const item = table.find(name); item && bodies) {
      item->fail("has no meaning for independent rigid bodies", "no such key");
    }
  }
  if (root.scene().units.si && !bodies) {
    // All three edges are needed, whatever the shape: units depend on the volume of a cell.
    constexpr std::string_view cell = "the size of a cell in m: one number, or three";
    auto const item = table.required("spacing", cell);
    if (item.node->is_array())
      lattice.spacing = three(item, cell, positive_number);
    else
      lattice.spacing.fill(positive_number(item));
  } else if (auto const item = table.find("spacing")) {
    auto const read = [](Item const& entry, std::string_view accepted_here) {
      auto limits = positive;
      limits.accepted = accepted_here;
      return number(entry, limits);
    };
    read_per_axis(*item, extents.size(), lattice.spacing, read, positive.accepted);
  }
  if (auto const item = table.find("boundary")) {
    auto const read = [](Item const& entry, std::string_view accepted_here) {
      return word<BoundaryKind>(entry, accepted_here);
    };
    read_per_axis(*item, extents.size(), lattice.boundary, read, all_words<BoundaryKind>());
  }
  if (bodies) return lattice;
  read_crystal(root, table, lattice);
  auto const sites = static_cast<std::int64_t>(lattice.basis.size());
  if (sites > room || lattice.shape[2] * sites > most_extent)
    shape.fail(fmt::format("more sites than memory can address, with {} in a cell", sites),
               "a smaller shape");
  lattice.shape[2] *= sites;
  return lattice;
}

}  // namespace cayspin::inline v0_2::io::detail
