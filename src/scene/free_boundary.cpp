// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "free_boundary.hpp"

#include "io/free_sides.hpp"
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace cayspin::inline v0_2::io::detail {
namespace {

constexpr std::string_view of_free_sides = "free sides along ";

std::string text_of(std::size_t axis) { return fmt::format("{}{}", of_free_sides, "xyz"[axis]); }

/// Returns the DMI vector of the bonds along an axis, divided by D, up to its sign.
Triple bond_vector(Field const& field, std::size_t axis) {
  Triple along{};
  along[axis] = 1;
  if (field.dmi) return cayspin::detail::vector_product(field.dmi->normal, along);
  return field.d2d_dmi && axis == 2 ? Triple{} : along;
}

double square(Triple const& v) { return cayspin::detail::scalar_product(v, v); }

/// Returns site-dependent numbers if there are any, otherwise `constant` for each site.
std::vector<double> constants(Scene const& scene, SiteNumbers const& numbers, double constant,
                              std::string_view key, SiteBox const& box) {
  if (numbers.there()) return numbers_of_sites(scene, numbers, key, box);
  auto const& [nx, ny, nz] = box.extent;
  return std::vector<double>(static_cast<std::size_t>(nx * ny * nz), constant);
}

bool has_spin(Lattice const& lattice, std::vector<unsigned char> const& occupied,
              std::array<std::int64_t, 3> const& site) {
  auto const at = (site[2] * lattice.shape[1] + site[1]) * lattice.shape[0] + site[0];
  return occupied.empty() || occupied[static_cast<std::size_t>(at)];
}

/// Returns how many of a site's two neighbours along an axis are missing.
int open_sides(Lattice const& lattice, std::vector<unsigned char> const& occupied,
               std::array<std::int64_t, 3> const& site, std::size_t axis) {
  auto const extent = lattice.shape[axis];
  int open = 0;
  for (int const side : {-1, 1}) {
    auto neighbour = site;
    neighbour[axis] += side;
    if (neighbour[axis] < 0 || neighbour[axis] >= extent) {
      if (lattice.boundary[axis] == BoundaryKind::open) {
        ++open;
        continue;
      }
      neighbour[axis] = (neighbour[axis] + extent) % extent;
    }
    open += !has_spin(lattice, occupied, neighbour);
  }
  return open;
}

}  // namespace

bool has_free_boundary(Table const& root) {
  auto const& scene = root.scene();
  std::optional<Item> item;
  auto const find_in = [&](std::optional<Item> const& table) {
    if (table && table->node->is_table()) item = Table(*table, root.scene()).find("free_boundary");
  };
  if (scene.units.si) {
    find_in(root.find("material"));
  } else if (auto const field = root.find("field"); field && field->node->is_table()) {
    find_in(Table(*field, root.scene()).find("dmi"));
  }
  if (!item || !boolean(*item)) return false;
  if (scene.material && scene.material->atomistic)
    item->fail("belongs to a continuum", "material.Ms, or no such key");
  if (!scene.field.has_dmi())
    item->fail("stands without DMI", "material.D, D_bulk or D2d, or no such key");
  if (scene.field.dmi_normals.there())
    item->fail("does not go with normals that differ from site to site",
               "one normal, or no such key");
  return true;
}

void add_free_boundaries(Scene& scene) {
  auto& field = scene.field;
  std::string_view const key =
      scene.units.si ? "material.free_boundary" : "field.dmi.free_boundary";
  if (!field.exchange || (!field.exchange_factors.there() && !(field.exchange->constant > 0)))
    refuse(scene, key, "needs exchange above 0, which turns the spins at a free boundary",
           scene.units.si ? "material.A beside it, or false" : "field.exchange, or false");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const d = normalise(bond_vector(field, axis));
    if (!d || scene.lattice.shape[axis] < 2) continue;
    Anisotropy term{1, *d, -1, {}};
    term.factors.expression = text_of(axis);
    term.factors.key = key;
    field.anisotropies.push_back(term);
  }
}

std::optional<std::vector<double>> numbers_at_free_sides(Scene const& scene,
                                                         SiteNumbers const& numbers,
                                                         SiteBox const& box) {
  std::size_t axis = 0;
  while (axis < 3 && numbers.expression != text_of(axis)) ++axis;
  if (axis == 3) return std::nullopt;
  auto const& field = scene.field;
  auto const D = constants(scene, field.dmi_factors,
                           field.dmi        ? field.dmi->interfacial
                           : field.bulk_dmi ? field.bulk_dmi->constant
                                            : field.d2d_dmi->constant,
                           "field.dmi", box);
  auto const A =
      constants(scene, field.exchange_factors, field.exchange->constant, "field.exchange", box);
  auto const there = occupied(scene, {{0, 0, 0}, scene.lattice.shape});
  double const across = square(bond_vector(field, axis));
  std::vector<double> values(D.size());
  auto const& [nx, ny, nz] = box.extent;
  std::size_t at = 0;
  for (std::int64_t k = 0; k < nz; ++k)
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i, ++at) {
        std::array const site{box.begin[0] + i, box.begin[1] + j, box.begin[2] + k};
        if (!has_spin(scene.lattice, there, site)) continue;
        int const sides = open_sides(scene.lattice, there, site, axis);
        if (sides == 0 || D[at] == 0) continue;
        if (!(A[at] > 0))
          refuse(scene, numbers.key, fmt::format("meets an exchange constant of {}", A[at]),
                 "exchange above 0 where there is DMI");
        values[at] = -sides * across * D[at] * D[at] / A[at];
      }
  return values;
}

}  // namespace cayspin::inline v0_2::io::detail

namespace cayspin::inline v0_2::io {

bool is_of_free_sides(SiteNumbers const& numbers) {
  return numbers.expression.starts_with(detail::of_free_sides);
}

}  // namespace cayspin::inline v0_2::io
