// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Reads the demagnetising field of cells, or the dipolar field of sites.
#include "sections.hpp"

#include <cayspin/demagnetization/images.hpp>
#include <cayspin/demagnetization/tensor.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cayspin::inline v0_2::io::detail {
namespace {

// Sets the default: infinitely many images along each periodic axis with several cells. With three
// such axes, the sum is defined only for dipoles, so the field of cells is refused.
void set_usual_images(Item const& item, Lattice const& lattice, Demagnetization& demag) {
  auto& images = demag.periodic_images;
  auto const basis = static_cast<std::int64_t>(lattice.basis.size());
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const cells = lattice.shape[axis] / (axis == 2 ? basis : 1);
    if (lattice.boundary[axis] != BoundaryKind::periodic || cells == 1) continue;
    images[axis] = infinitely_many_images;
    auto const [x, y, z] = lattice.cell[axis];
    double const length =
        static_cast<double>(cells) *
        std::hypot(x * lattice.spacing[0], y * lattice.spacing[1], z * lattice.spacing[2]);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  auto const otherwise = fmt::format("{} = {{ periodic_images = [nx, ny, nz] }}", demag.key);
  if (std::ranges::count(images, 0) == 0 && !demag.dipoles)
    item.fail(
        "the field of a lattice that is periodic along x, y and z depends on the shape of "
        "the whole",
        otherwise + ", or an open axis");
  if (longest > largest_period_ratio * shortest)
    item.fail(
        fmt::format("the lengths of the periodic axes differ by {:.3g} : 1", longest / shortest),
        "up to 1e4 : 1, or " + otherwise);
}

// By default the factors are 0: there are no magnetic poles on the distant surface of the body.
void read_demagnetizing_factors(Table const& table, Demagnetization& demag) {
  auto const item = table.find("demagnetizing_factors");
  if (!item) return;
  constexpr std::string_view accepted = "three numbers, 0 to 1";
  demag.demagnetizing_factors = three(*item, accepted, [&](Item const& each) {
    return number(each, {accepted, 0, 1});
  });
  if (std::ranges::count(demag.periodic_images, infinitely_many_images) < 3)
    item->fail(
        "applies only to a lattice that is periodic along x, y and z, without periodic_images",
        "no such key");
}

// Reads `true` or `false`, or a table. In a crystal, demag is the field of dipoles.
std::optional<Demagnetization> read_whole_demag(Item const& item, Scene& scene, bool of_dipoles) {
  Demagnetization demag;
  if (of_dipoles) demag.key = "dipoles";
  if (of_dipoles || is_crystal(scene.lattice)) demag.dipoles = crystal(scene.lattice);
  auto const [shortest, longest] = std::ranges::minmax(scene.lattice.spacing);
  auto const check_cell = [&, shortest = shortest, longest = longest] {
    if (!demag.dipoles && longest > largest_edge_ratio * shortest)
      item.fail(fmt::format("the edges of a cell differ by {:.3g} : 1", longest / shortest),
                "edges of up to 1e9 : 1");
  };
  if (item.node->is_boolean()) {
    if (!boolean(item)) return std::nullopt;
    check_cell();
    set_usual_images(item, scene.lattice, demag);
    return demag;
  }
  if (!item.node->is_table())
    item.wrong_type(demag.dipoles
                        ? "true, or { strength, periodic_images, demagnetizing_factors, multirate }"
                        : "true, or { strength, periodic_images, multirate }");
  check_cell();
  Table const table(item, scene);
  auto keys = names_of_keys<Demagnetization>();
  if (demag.dipoles) keys.push_back("demagnetizing_factors");
  table.accept_only(keys);
  read_keys(table, demag);
  if (auto const images = table.find("periodic_images")) {
    constexpr std::string_view of_images = "three numbers of images, 0 to 1000";
    demag.periodic_images = three(*images, of_images, [&](Item const& each) {
      auto const count = integer(each, {of_images, 0});
      if (count > 1000) each.fail(fmt::format("{} images are too many", count), of_images);
      return static_cast<int>(count);
    });
  } else {
    set_usual_images(item, scene.lattice, demag);
  }
  if (demag.dipoles) read_demagnetizing_factors(table, demag);
  return demag;
}

}  // namespace

void read_demag(Table const& table, Scene& scene, Field& field) {
  for (bool const of_dipoles : {false, true}) {
    auto const item = table.find(of_dipoles ? "dipoles" : "demag");
    if (!item) continue;
    auto demag = read_whole_demag(*item, scene, of_dipoles);
    if (!demag) continue;
    if (field.demag)
      item->fail("stands beside field.demag, which has the same field", "one of the two");
    if (field.slab_demag)
      item->fail("is the whole demagnetising field, and slab_demag a part of it", "one of the two");
    field.demag = std::move(demag);
  }
}

}  // namespace cayspin::inline v0_2::io::detail
