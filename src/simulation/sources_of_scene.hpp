// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "terms_of_scene.hpp"

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/table.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <ranges>
#include <utility>
#include <vector>

// The sources of a scene's applied field, for FieldInPass. Included by compile_field_in_pass.hpp.
namespace cayspin::simulation {

// Sums the profiles of sources with equal time factors.
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
  constexpr auto most = SourcesNow<Real>::most;
  if (sources_.size() <= most) return;
  std::vector<SiteArray<Real, 3>> others;
  for (auto const& source : std::views::drop(sources_, most))
    others.push_back(source.profile.array());
  other_profiles_ =
      cayspin::detail::table_of<Memory>("cayspin::FieldInPass::source_profiles", others);
  other_factors_ = {"cayspin::FieldInPass::source_factors", 2 * along_rows_.size(), others.size()};
}

template <class Spins>
template <class Exec>
auto FieldInPass<Spins>::Terms::sources_at(Exec const& exec, double t) const -> SourcesNow<Real> {
  SourcesNow<Real> now;
  std::vector<double> others;
  for (auto const& [profile, time, largest] : sources_) {
    double const factor = time(t).x;
    now.largest += largest * std::abs(factor);
    if (static_cast<std::size_t>(now.count) == now.most) {
      others.push_back(factor);
      continue;
    }
    now.profiles[now.count] = profile.array();
    now.factors[now.count++] = factor;
  }
  if (others.empty()) return now;
  last_factors_ = (last_factors_ + 1) % other_factors_.extent(0);
  auto const row = Kokkos::subview(other_factors_, last_factors_, Kokkos::ALL);
  if constexpr (cayspin::detail::is_host_execution<Exec>) {
    std::ranges::copy(others, row.data());
  } else {
    Kokkos::deep_copy(exec, row,
                      Kokkos::View<double const*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(
                          others.data(), others.size()));
    exec.fence("cayspin::FieldInPass::source_factors");
  }
  now.other_profiles = other_profiles_.data();
  now.other_factors = row.data();
  now.others = static_cast<std::int32_t>(others.size());
  return now;
}

}  // namespace cayspin::simulation
