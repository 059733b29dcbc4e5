// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "terms_of_scene.hpp"

#include <cayspin/detail/ghosts.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

// The torques of a scene's currents, for FieldInPass. Included by compile_field_in_pass.hpp.
namespace cayspin::simulation {

template <class Spins>
void FieldInPass<Spins>::Terms::add_torques(io::Scene const& scene, io::SiteBox const& box) {
  auto const& [zhang_li, slonczewski] = scene.field.torque;
  if (zhang_li) {
    torques_.velocity.emplace(zhang_li->velocity, "torque.zhang_li.velocity", scene.units);
    torques_.nonadiabaticity = zhang_li->nonadiabaticity;
    torques_.velocity_per_moment = zhang_li->per_moment;
  }
  if (!slonczewski) return;
  constexpr char const* key = "torque.slonczewski";
  torques_.strengths.emplace(
      std::array<io::AppliedComponent, 3>{slonczewski->damping_like, slonczewski->field_like, 0.0},
      key, scene.units);
  if (!slonczewski->polarizations.there())
    torques_.polarization = vector(slonczewski->polarization);
  torques_.lambda = slonczewski->lambda;
  torques_.needs_site_term = !slonczewski->is_plain();
  auto const keep = [&](io::SiteNumbers const& numbers, bool per_moment,
                        std::optional<ScalarField<Real, Memory>>& in) {
    if (!numbers.there() && !per_moment) return;
    std::vector<double> strengths;
    if (numbers.there()) strengths = io::numbers_of_sites(scene, numbers, key, box);
    if (per_moment) {
      auto const moments = io::moments_of_sites(scene, box);
      strengths.resize(moments.size(), 1);
      for (std::size_t site = 0; site < moments.size(); ++site)
        strengths[site] = moments[site] > 0 ? strengths[site] / moments[site] : 0;
    }
    in = scalar_field_of<Real, Memory>("strengths", lattice_, strengths);
  };
  keep(slonczewski->damping_like_of_sites, slonczewski->damping_like_per_moment,
       torques_.damping_like);
  keep(slonczewski->field_like_of_sites, slonczewski->field_like_per_moment, torques_.field_like);
  if (!slonczewski->polarizations.there()) return;
  auto& polarizations = torques_.polarizations.emplace("FieldInPass::polarizations", lattice_);
  copy_from_host(io::directions_of_sites(scene, slonczewski->polarizations,
                                         "torque.slonczewski.polarization", box),
                 polarizations);
  cayspin::detail::update_ghosts(typename Memory::execution_space(), lattice_, polarizations);
}

template <class Spins>
auto FieldInPass<Spins>::Terms::slonczewski_of_sites(Vec3<double> const& strengths) const
    -> SlonczewskiOfSites<Real> {
  SlonczewskiOfSites<Real> now{.damping_like = strengths.x,
                               .field_like = strengths.y,
                               .polarization = torques_.polarization,
                               .square = torques_.lambda * torques_.lambda};
  if (torques_.damping_like) now.damping_like_of_sites = torques_.damping_like->array();
  if (torques_.field_like) now.field_like_of_sites = torques_.field_like->array();
  if (torques_.polarizations) now.polarizations = torques_.polarizations->array();
  return now;
}

}  // namespace cayspin::simulation
