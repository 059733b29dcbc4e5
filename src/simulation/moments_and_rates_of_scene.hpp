// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "terms_of_scene.hpp"

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/ghosts.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

// Moments and vacancies of FieldInPass, and how fast its spins turn in H. Included by
// compile_field_in_pass.hpp.
namespace cayspin::simulation {

template <class Spins>
void FieldInPass<Spins>::Terms::add_moments_of_sites(std::vector<double> const& moments) {
  std::vector<double> per_moments(moments.size()), is_vacant(moments.size());
  for (std::size_t site = 0; site < moments.size(); ++site) {
    per_moments[site] = moments[site] > 0 ? 1 / moments[site] : 0;
    is_vacant[site] = moments[site] > 0 ? 0 : 1;
  }
  per_moments_ = scalar_field_of<Real, Memory>("per_moments", lattice_, per_moments);
  has_vacancies_ = largest_of_parts(lattice_, is_vacant) > 0;
  largest_moment_ = largest_of_parts(lattice_, moments);
}

// Exchange that is compiled into stages treats a vacancy, which is the zero vector, as a neighbour
// m' and adds c * (m' - m), where c is the strength of the bond. To correct this, stores for each
// site the sum of c over the vacancies beside it.
template <class Spins>
void FieldInPass<Spins>::Terms::add_vacancies(io::Scene const& scene) {
  auto const field = io::without_numbers_of_sites(scene.field);
  if (!field.exchange) return;
  missing_.emplace("FieldInPass::missing", lattice_);
  FindMissing<Real> find{moments_.array(), missing_->output(false), {0, 0, 0}};
  double const seen = cell_[0].gyromagnetic * cell_[0].per_moment * field.exchange->constant;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice_.has_neighbors(static_cast<int>(axis)))
      find.bonds[axis] = seen / (lattice_.spacing[axis] * lattice_.spacing[axis]);
  typename Memory::execution_space const exec;
  cayspin::detail::for_each_site<Real>(exec, "cayspin::FieldInPass::find_missing",
                                       missing_->layout(), find, missing_->layout().own);
  cayspin::detail::update_ghosts(exec, lattice_, *missing_);
  exec.fence("cayspin::FieldInPass: missing neighbours found");
}

// Stores the dampings of sites, and the factors by which A of each site is multiplied. `moves`: 0
// for a frozen spin, otherwise 1.
template <class Spins>
void FieldInPass<Spins>::Terms::add_rates(io::Scene const& scene, io::SiteBox const& box,
                                          std::vector<double> moves) {
  if (scene.system.dampings.there()) {
    auto const dampings = io::numbers_of_sites(scene, scene.system.dampings, "system.damping", box);
    dampings_ = scalar_field_of<Real, Memory>("dampings", lattice_, dampings);
    if (scene.system.gilbert_of_sites) {
      for (std::size_t site = 0; site < moves.size(); ++site)
        moves[site] /= 1 + dampings[site] * dampings[site];
    }
  }
  auto ratios = io::gyromagnetic_of_sites(scene, box);
  if (!ratios.empty()) std::ranges::transform(moves, ratios, moves.begin(), std::multiplies<>());
  if (!ratios.empty() || scene.system.gilbert_of_sites)
    rates_ = scalar_field_of<Real, Memory>("rates", lattice_, moves);
  // Slonczewski strengths in T are fields, which turn spins by the site's material.gamma. Other
  // torques do not depend on gamma, so they are divided by the ratio by which all of A is
  // multiplied.
  bool const are_fields =
      scene.material && scene.material->gamma_factors.there() && scene.field.torque.slonczewski;
  if (!ratios.empty() && io::has_torque(scene.field) && !are_fields) {
    for (double& ratio : ratios) ratio = 1 / ratio;
    per_gyromagnetic_ = scalar_field_of<Real, Memory>("per_gyromagnetic", lattice_, ratios);
  }
}

}  // namespace cayspin::simulation
