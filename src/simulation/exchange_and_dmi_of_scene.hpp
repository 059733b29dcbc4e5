// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "terms_of_scene.hpp"

#include <cayspin/field/site_dependent_exchange.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string_view>

// Site-dependent exchange and DMI of FieldInPass. Included by compile_field_in_pass.hpp.
namespace cayspin::simulation {

template <class Spins>
void FieldInPass<Spins>::Terms::add_exchange_of_sites(io::Scene const& scene,
                                                      io::SiteBox const& box) {
  auto const& field = scene.field;
  if (!field.exchange_factors.there()) return;
  auto const constants = io::numbers_of_sites(scene, field.exchange_factors, "field.exchange", box);
  double factor = 1;
  for (auto const& between : field.exchange_between)
    factor = std::max(factor, std::abs(between.factor));
  none_.magnitude +=
      factor * field.exchange->energy_magnitude(lattice_) * largest_of_parts(lattice_, constants);
  try {
    exchange_of_sites_.emplace(scalar_field_of<Real, Memory>("exchange", lattice_, constants));
  } catch (std::invalid_argument const& error) {
    std::string_view const message = error.what();
    throw io::scene_error(scene, field.exchange_factors.key_or("field.exchange"),
                          message.substr(message.find(": ") + 2));
  }
}

// A DMI with site-dependent normals becomes a sum of three DMI terms, with the normals x, y and z.
template <class Spins>
void FieldInPass<Spins>::Terms::add_dmi_of_sites(io::Scene const& scene, io::SiteBox const& box) {
  constexpr std::string_view key = "field.dmi";
  auto const& field = scene.field;
  if (!field.dmi_factors.there()) return;
  auto const constants = io::numbers_of_sites(scene, field.dmi_factors, key, box);
  double const largest = largest_of_parts(lattice_, constants);
  none_.magnitude +=
      (field.dmi_normals.there() ? 3 : 1) *
      io::sum_over_axes(lattice_, [&](std::size_t, double spacing) { return largest / spacing; });
  auto const add = [&](std::vector<double> const& of_sites, auto const& vector_along) {
    auto& dmi =
        dmis_of_sites_.emplace_back(scalar_field_of<Real, Memory>("dmi", lattice_, of_sites));
    for (int axis = 0; axis < 3; ++axis) {
      if (!lattice_.has_neighbors(axis)) continue;
      Vec3<double> const e{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
      auto const a = static_cast<std::size_t>(axis);
      dmi.vectors[a] = (1 / lattice_.spacing[a]) * vector_along(e);
    }
  };
  using Vector = Vec3<double>;
  if (field.bulk_dmi) {
    add(constants, [](Vector const& e) { return -1.0 * e; });
  } else if (field.d2d_dmi) {
    add(constants, [](Vector const& e) { return Vector{e.x, -e.y, 0}; });
  } else if (!field.dmi_normals.there()) {
    add(constants, [&](Vector const& e) { return cross(vector(field.dmi->normal), e); });
  } else {
    auto const normals = io::directions_of_sites(scene, field.dmi_normals, key, box);
    for (std::size_t c = 0; c < 3; ++c) {
      auto along = constants;
      for (std::size_t site = 0; site < along.size(); ++site) along[site] *= normals[3 * site + c];
      Vector const n{c == 0 ? 1.0 : 0.0, c == 1 ? 1.0 : 0.0, c == 2 ? 1.0 : 0.0};
      add(along, [&](Vector const& e) { return cross(n, e); });
    }
  }
}

}  // namespace cayspin::simulation
