// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "limits_of_terms.hpp"
#include "terms_of_scene.hpp"

#include <cayspin/field/site_dependent_exchange.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

// Bonds between regions, for FieldInPass. Included by compile_field_in_pass.hpp.
namespace cayspin::simulation {

// A sweep of InterlayerOfSites updates the spins on both sides of a face in turn. Each of the two
// updates multiplies the error by at most r / (1 - r), where r is the strength of the bond divided
// by that of the exchange in half a cell.
template <class Spins>
void FieldInPass<Spins>::Terms::add_exchange_at_faces(io::Scene const& scene,
                                                      io::SiteBox const& box) {
  auto const& numbers = scene.field.exchange_at_faces;
  if (!numbers.there()) return;
  auto const constants = io::numbers_of_sites(scene, numbers, "field.exchange", box);
  exchange_at_faces_ = scalar_field_of<Real, Memory>("exchange_at_faces", lattice_, constants);
  double strongest = 0, spacing = longest_of_distant_;
  for (auto const& bond : scene.field.interlayers)
    strongest = std::max(strongest, std::abs(bond.bilinear) + 4 * std::abs(bond.biquadratic));
  for (int axis = 0; axis < 3; ++axis)
    if (interlayers_[axis].bilinear)
      spacing = std::max(spacing, lattice_.spacing[static_cast<std::size_t>(axis)]);
  std::vector<double> per_exchange(constants.size());
  for (std::size_t site = 0; site < constants.size(); ++site)
    per_exchange[site] = constants[site] > 0 ? 1 / constants[site] : 0;
  // The three maxima may belong to different faces, so this bound may exceed most_at_faces, to
  // which the plan limits the ratio at each face.
  double const bound = largest_of_parts(lattice_, per_exchange) * strongest * spacing / 2;
  double const ratio = std::min(bound, most_at_faces);
  double const epsilon = std::numeric_limits<Real>::epsilon();
  double const steps = std::log(epsilon) / std::log(ratio / (1 - ratio));
  sweeps_of_faces_ = ratio > 0 ? 1 + static_cast<std::int32_t>(std::ceil(steps / 2)) : 1;
}

// The arrays filled here store, at each site, the bond to the next site along an axis. If the
// lattice is divided, the bond stored at a part's last site leads to a site of another part.
template <class Spins>
void FieldInPass<Spins>::Terms::add_bonds_between(io::Scene const& scene, io::SiteBox const& box) {
  auto const& field = scene.field;
  if (field.exchange_between.empty() && field.interlayers.empty()) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!lattice_.has_neighbors(static_cast<int>(axis))) continue;
    auto const pairs = io::regions_of_bonds(scene, box, axis);
    auto const sum_of = [&](auto const& list, auto constant, double otherwise) {
      std::vector<double> values(pairs.size(), otherwise);
      for (std::size_t bond = 0; bond < pairs.size(); ++bond)
        for (auto const& one : list)
          if (std::ranges::is_permutation(one.regions, pairs[bond])) values[bond] = one.*constant;
      return values;
    };
    if (!field.exchange_between.empty())
      exchange_of_sites_->scale_bonds(
          static_cast<int>(axis), sum_of(field.exchange_between, &io::ExchangeBetween::factor, 1));
    std::vector<io::Interlayer> near;
    std::ranges::copy_if(field.interlayers, std::back_inserter(near),
                         [](auto const& bond) { return bond.range == 0; });
    if (near.empty()) continue;
    auto bilinear = sum_of(near, &io::Interlayer::bilinear, 0);
    auto biquadratic = sum_of(near, &io::Interlayer::biquadratic, 0);
    for (auto* const constants : {&bilinear, &biquadratic})
      for (double& constant : *constants) constant /= lattice_.spacing[axis];
    double const strongest =
        largest_of_parts(lattice_, bilinear) + largest_of_parts(lattice_, biquadratic);
    if (strongest == 0) continue;  // no faces along this axis
    none_.magnitude += strongest;
    interlayers_[axis] = {scalar_field_of<Real, Memory>("interlayer", lattice_, bilinear),
                          scalar_field_of<Real, Memory>("interlayer", lattice_, biquadratic)};
  }
}

// Each distant bond is stored at both of its ends, with equal constants.
template <class Spins>
void FieldInPass<Spins>::Terms::add_distant_bonds(io::Scene const& scene, io::SiteBox const& box) {
  std::vector<DistantBonds<Real>> all;
  auto const keep = [&](std::vector<double> const& values) {
    return numbers_of_distant_
        .emplace_back(scalar_field_of<Real, Memory>("interlayer", lattice_, values))
        .array();
  };
  std::set<std::int64_t> ranges;
  for (auto const& bond : scene.field.interlayers)
    if (bond.range > 0) ranges.insert(bond.range);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::int64_t const range : ranges)
      for (std::int64_t const reach : {range + 1, -range - 1}) {
        if (range + 1 >= scene.lattice.shape[axis]) continue;
        for (auto const ghosts : {lattice_.ghosts[axis].before, lattice_.ghosts[axis].after})
          if (ghosts != 0 && ghosts < range + 1)
            throw std::invalid_argument(
                fmt::format("field.interlayer: a bond of range {} needs {} ghosts at each inner "
                            "end, and the part has {}",
                            range, range + 1, ghosts));
        auto const pairs = io::regions_across(scene, box, axis, reach);
        std::vector<double> bilinear(pairs.size()), biquadratic(pairs.size());
        double const spacing = lattice_.spacing[axis];
        for (std::size_t site = 0; site < pairs.size(); ++site)
          for (auto const& bond : scene.field.interlayers)
            if (bond.range == range && std::ranges::is_permutation(bond.regions, pairs[site])) {
              bilinear[site] = bond.bilinear / spacing;
              biquadratic[site] = bond.biquadratic / spacing;
            }
        double const strongest =
            largest_of_parts(lattice_, bilinear) + largest_of_parts(lattice_, biquadratic);
        if (strongest == 0) continue;
        none_.magnitude += strongest / 2;
        longest_of_distant_ = std::max(longest_of_distant_, spacing);
        DistantBonds<Real> bonds{{}, keep(bilinear), keep(biquadratic)};
        bonds.offset[axis] = static_cast<std::int32_t>(reach);
        bonds.per_square = 2 / (spacing * spacing);
        if (auto const& numbers = scene.field.exchange_at_faces; numbers.there())
          bonds.exchange =
              keep(io::numbers_across(scene, numbers, "field.exchange", box, axis, reach));
        all.push_back(bonds);
      }
  distant_bonds_ = cayspin::detail::table_of<Memory>("cayspin::FieldInPass::distant_bonds", all);
}

}  // namespace cayspin::simulation
