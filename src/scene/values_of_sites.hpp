// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string_view>

namespace cayspin::inline v0_2::io::detail {

/// Calls on_numbers(SiteNumbers, key) or on_vectors(SiteVectors, key) for each value of a scene
/// that can be site-dependent, whether or not it is set.
template <class OnNumbers, class OnVectors>
void for_each_value_of_sites(Scene const& scene, OnNumbers const& on_numbers,
                             OnVectors const& on_vectors) {
  auto const& lattice = scene.lattice;
  auto const& field = scene.field;
  on_numbers(lattice.regions, "lattice.regions");
  on_numbers(lattice.moments_of_sites, "lattice.moments");
  on_numbers(lattice.gyromagnetic_of_sites, "lattice.gyromagnetic");
  on_numbers(lattice.occupied, "lattice.occupied");
  on_numbers(lattice.frozen, "lattice.frozen");
  on_numbers(scene.system.dampings, "system.damping");
  on_numbers(field.exchange_factors, "field.exchange");
  on_numbers(field.exchange_at_faces, "field.exchange");
  on_numbers(field.dmi_factors, "field.dmi");
  on_vectors(field.dmi_normals, "field.dmi");
  for (auto const& term : field.anisotropies) {
    on_numbers(term.factors, "field.anisotropy");
    on_numbers(term.factors2, "field.anisotropy");
    on_vectors(term.axes, "field.anisotropy");
  }
  for (auto const& term : field.crystal_anisotropies) {
    on_numbers(term.factors, "field.anisotropy");
    on_numbers(term.factors2, "field.anisotropy");
    for (auto const& axes : term.axes_of_sites) on_vectors(axes, "field.anisotropy");
  }
  for (auto const& source : field.sources) on_vectors(source.profile, "field.sources");
  if (auto const& of = field.torque.slonczewski) {
    on_numbers(of->damping_like_of_sites, "torque.slonczewski.damping_like");
    on_numbers(of->field_like_of_sites, "torque.slonczewski.field_like");
    on_vectors(of->polarizations, "torque.slonczewski.polarization");
  }
  if (scene.thermal) on_numbers(scene.thermal->of_sites, "thermal.temperature");
}

}  // namespace cayspin::inline v0_2::io::detail
