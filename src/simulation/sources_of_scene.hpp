// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "terms_of_scene.hpp"

#include <cayspin/detail/ghosts.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

// The sources of a scene's applied field, for FieldInPass. Included by compile_field_in_pass.hpp.
namespace cayspin::simulation {

// Sums the profiles of sources with equal time factors. The plan has already refused scenes with
// too many different factors.
template <class Spins>
void FieldInPass<Spins>::Terms::add_sources(io::Scene const& scene, io::SiteBox const& box) {
  std::vector<std::pair<io::AppliedComponent, std::vector<double>>> profiles;
  for (auto const& [profile, time] : scene.field.sources) {
    auto vectors = io::vectors_of_sites(scene, profile, "field.sources", box);
    for (double& number : vectors) number *= scene.field.mu0;
    auto const same = std::ranges::find(profiles, time, [](auto const& one) { return one.first; });
    if (same == profiles.end())
      profiles.emplace_back(time, std::move(vectors));
    else
      std::ranges::transform(vectors, same->second, same->second.begin(), std::plus<>());
  }
  for (auto const& [time, vectors] : profiles) {
    std::vector<double> lengths(vectors.size() / 3);
    for (std::size_t site = 0; site < lengths.size(); ++site)
      lengths[site] = std::hypot(vectors[3 * site], vectors[3 * site + 1], vectors[3 * site + 2]);
    SiteField<Real, 3, Memory> profile("FieldInPass::source", lattice_);
    copy_from_host(vectors, profile);
    cayspin::detail::update_ghosts(typename Memory::execution_space(), lattice_, profile);
    sources_.push_back({profile, AppliedField({time, 0.0, 0.0}, "field.sources", scene.units),
                        largest_of_parts(lattice_, lengths)});
  }
}

template <class Spins>
auto FieldInPass<Spins>::Terms::sources_at(double t) const -> SourcesNow<Real> {
  SourcesNow<Real> now;
  for (auto const& [profile, time, largest] : sources_) {
    now.profiles[now.count] = profile.array();
    now.factors[now.count++] = time(t).x;
  }
  return now;
}

template <class Spins>
double FieldInPass<Spins>::Terms::applied_magnitude(Vec3<double> const& applied,
                                                    SourcesNow<Real> const& sources) const {
  double magnitude = std::sqrt(dot(applied, applied));
  for (std::size_t i = 0; i < sources_.size(); ++i)
    magnitude += sources_[i].largest * std::abs(sources.factors[i]);
  return largest_moment_ * magnitude;
}

}  // namespace cayspin::simulation
