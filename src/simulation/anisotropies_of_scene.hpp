// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "terms_of_scene.hpp"

#include <cayspin/field/cubic_anisotropy.hpp>

// Site-dependent anisotropies of FieldInPass. Included by compile_field_in_pass.hpp.
namespace cayspin::simulation {

template <class Spins>
SiteArray<typename Spins::value_type, 1> FieldInPass<Spins>::Terms::keep_constants(
    std::vector<double> const& constants, double of_energy) {
  none_.magnitude += of_energy * largest_of_parts(lattice_, constants);
  constants_of_axes_.push_back(scalar_field_of<Real, Memory>("anisotropy", lattice_, constants));
  return constants_of_axes_.back().array();
}

template <class Spins>
SiteArray<typename Spins::value_type, 3> FieldInPass<Spins>::Terms::keep_axes(
    std::vector<double> const& axes) {
  auto const& kept = axes_of_sites_.emplace_back("FieldInPass::axes", lattice_);
  copy_from_host(axes, kept);
  cayspin::detail::update_ghosts(typename Memory::execution_space(), lattice_, kept);
  return kept.array();
}

// Returns a term's constant at each site. If the term belongs to one site of the cell, the constant
// is 0 at the others.
template <class Spins>
std::vector<double> FieldInPass<Spins>::Terms::constants_of_site(io::Scene const& scene,
                                                                 io::SiteBox const& box,
                                                                 double constant,
                                                                 io::SiteNumbers const& numbers,
                                                                 int site_of_term) const {
  auto values = numbers.there()
                    ? io::numbers_of_sites(scene, numbers, "field.anisotropy", box)
                    : std::vector<double>(static_cast<std::size_t>(lattice_.sites()), constant);
  for (std::size_t site = 0; site < values.size(); ++site)
    if (site_of_term >= 0 && site_of_cell(lattice_, site) != static_cast<std::size_t>(site_of_term))
      values[site] = 0;
  return values;
}

template <class Spins>
void FieldInPass<Spins>::Terms::add_axes(io::Scene const& scene, io::SiteBox const& box,
                                         std::vector<double> const& moments) {
  std::vector<AnisotropyOfSites<Real>> axes;
  for (auto const& term : scene.field.anisotropies) {
    if (term.is_plain()) continue;
    auto const of_sites = [&](double constant, io::SiteNumbers const& numbers) {
      return constants_of_site(scene, box, constant, numbers, term.site);
    };
    auto& one = axes.emplace_back(keep_constants(of_sites(term.constant, term.factors), 0.5),
                                  vector(term.axis));
    if (term.constant2 != 0 || term.factors2.there())
      one.second = keep_constants(of_sites(term.constant2, term.factors2), 0.25);
    if (term.axes.there())
      one.axes = keep_axes(io::directions_of_sites(scene, term.axes, "field.anisotropy", box));
  }
  anisotropies_in_time_ = static_cast<std::int32_t>(axes.size());
  if (auto const slab = slab_of_moments(scene)) {  // E = mu0 * strength * (moment * m.n)^2 / 2
    std::vector<double> constants(moments.size());
    std::ranges::transform(moments, constants.begin(), [&](double moment) {
      return -scene.field.mu0 * slab->strength * moment * moment;
    });
    axes.emplace_back(keep_constants(constants, 0.5), vector(slab->normal));
  }
  anisotropies_ = cayspin::detail::table_of<Memory>("cayspin::FieldInPass::anisotropies", axes);
}

template <class Spins>
void FieldInPass<Spins>::Terms::add_crystal_axes(io::Scene const& scene, io::SiteBox const& box) {
  std::vector<CrystalAnisotropyOfSites<Real>> crystals;
  for (auto const& term : scene.field.crystal_anisotropies) {
    if (term.is_plain()) continue;
    auto const of_sites = [&](double constant, io::SiteNumbers const& numbers) {
      return constants_of_site(scene, box, constant, numbers, term.site);
    };
    auto& one = crystals.emplace_back();
    one.hexagonal = term.hexagonal;
    one.constants = keep_constants(of_sites(term.constant, term.factors), 1);
    if (term.constant2 != 0 || term.factors2.there())
      one.second = keep_constants(of_sites(term.constant2, term.factors2), 1.0 / 27);
    auto const axes = io::crystal_axes(scene, term, box);
    bool const differ = term.axes_of_sites[0].there() || term.axes_of_sites[1].there();
    for (std::size_t i = 0; i < 2; ++i)
      if (differ)
        one.axes_of_sites[i] = keep_axes(axes[i]);
      else
        one.axes[i] = {axes[i][0], axes[i][1], axes[i][2]};
  }
  crystals_ = cayspin::detail::table_of<Memory>("cayspin::FieldInPass::crystals", crystals);
}

}  // namespace cayspin::simulation
