// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "more_of_sample.hpp"

#include "ranks.hpp"
#include "space.hpp"

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/stencil.hpp>

#include <algorithm>
#include <cstddef>

namespace cayspin::simulation {

inline constexpr int regions_at_once = 4;

/// Functor that sums the weights (moments) in each region of a group: the regions from `first` to
/// first + regions_at_once - 1.
template <class Real>
struct WeightsOfRegions {
  cayspin::SiteArray<Real, 1> regions, moments;  // moments without data: all 1
  double first;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Value const weight = moments.data ? Value(site.load(moments)) : Value(1.0);
    Value const region = site.load(regions);
    for (int i = 0; i < regions_at_once; ++i) values[i] = of_region(region, i, weight);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value of_region(Value const& region, int i,
                                              Value const& number) const {
    return cayspin::detail::select<Value>(region == Value(first + i), number, Value(0.0));
  }
};

/// Functor that sums the weighted spins and the energy in each region of the group that starts at
/// region of.first.
template <class Source, class Real>
struct SumsOfRegions {
  WeightsOfRegions<Real> of;
  Source source;
  cayspin::SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, spins);
    Vec3<Value> m = stencil.center();
    if (of.moments.data) m = Value(site.load(of.moments)) * m;
    Value const energy = source.energy_density(stencil), region = site.load(of.regions);
    for (int i = 0; i < regions_at_once; ++i) {
      values[4 * i] = of.of_region(region, i, m.x);
      values[4 * i + 1] = of.of_region(region, i, m.y);
      values[4 * i + 2] = of.of_region(region, i, m.z);
      values[4 * i + 3] = of.of_region(region, i, energy);
    }
  }
};

namespace {

// Calls work(first) for each group, where `first` is the group's first region.
template <class Work>
void for_each_some(std::size_t count, Work const& work) {
  for (std::size_t first = 0; first < count; first += regions_at_once) work(first);
}

}  // namespace

template <class Spins>
TermEnergies<Spins>::TermEnergies(io::Scene const& scene, Lattice const& lattice) {
  if (scene.system.kind == io::SystemKind::rigid_body) {
    names_ = {"rotation"};
    terms_.emplace_back(scene, lattice);
    return;
  }
  for (auto const& [name, alone] : single_terms(scene)) {
    names_.push_back(name);
    terms_.emplace_back(alone, lattice);
  }
}

template <class Spins>
template <class Exec>
std::vector<double> TermEnergies<Spins>::operator()(Exec const& exec, Step const& step,
                                                    Spins const& spins) const {
  std::vector<double> energies;
  for (auto const& term : terms_)
    energies.push_back(cayspin::energy(exec, term, spins, step.time).value);
  return energies;
}

template <class Spins>
RegionSums<Spins>::RegionSums(io::Scene const& scene, Lattice const& lattice)
    : count_(static_cast<std::size_t>(io::region_count(scene))),
      regions_("RegionSums::regions", lattice) {
  auto const box = own_sites(lattice);
  copy_from_host(io::regions(scene, box), regions_);
  if (auto const moments = io::all_moments(scene, box); !moments.empty()) {
    moments_.emplace("RegionSums::moments", lattice);
    copy_from_host(moments, *moments_);
  }
  WeightsOfRegions<Real> weights{regions_.array(), {}, 0};
  if (moments_) weights.moments = moments_->array();
  typename Spins::memory_space::execution_space const exec;
  for_each_some(count_, [&](std::size_t first) {
    weights.first = static_cast<double>(first);
    auto const sums = cayspin::detail::reduce_sites<cayspin::detail::Sum, regions_at_once>(
        exec, "cayspin::RegionSums::weights", regions_.layout(), weights);
    weights_.insert(weights_.end(), sums.begin(), sums.end());
  });
}

template <class Spins>
template <class Exec, class Source>
std::vector<double> RegionSums<Spins>::operator()(Exec const& exec, Source const& source,
                                                  Step const& step, Spins const& spins) const {
  auto const prepared = cayspin::detail::prepare_term(source, exec, spins, step.time);
  SumsOfRegions<std::remove_const_t<decltype(prepared)>, Real> look{
      {regions_.array(), {}, 0}, prepared, spins.array()};
  if (moments_) look.of.moments = moments_->array();
  std::vector<double> numbers(4 * count_);
  for_each_some(count_, [&](std::size_t first) {
    look.of.first = static_cast<double>(first);
    auto const sums = cayspin::detail::reduce_sites<cayspin::detail::Sum, 4 * regions_at_once>(
        exec, "cayspin::RegionSums", spins.layout(), look);
    for (std::size_t i = 0; first + i < std::min(count_, first + regions_at_once); ++i) {
      auto const region = first + i;
      for (std::size_t c = 0; c < 3; ++c)
        numbers[3 * region + c] = weights_[region] > 0 ? sums[4 * i + c] / weights_[region] : 0;
      numbers[3 * count_ + region] = sums[4 * i + 3];
    }
  });
  return numbers;
}

#define CAYSPIN_INSTANTIATE(Space, Real)                                                       \
  template class TermEnergies<SpinField<Real, Space::memory_space>>;                           \
  template std::vector<double> TermEnergies<SpinField<Real, Space::memory_space>>::operator()( \
      Space const&, Step const&, SpinField<Real, Space::memory_space> const&) const;           \
  template class RegionSums<SpinField<Real, Space::memory_space>>;                             \
  template std::vector<double> RegionSums<SpinField<Real, Space::memory_space>>::operator()(   \
      Space const&, SceneGenerator<SpinField<Real, Space::memory_space>> const&, Step const&,  \
      SpinField<Real, Space::memory_space> const&) const;                                      \
  template std::vector<double> RegionSums<SpinField<Real, Space::memory_space>>::operator()(   \
      Space const&, SceneField<SpinField<Real, Space::memory_space>> const&, Step const&,      \
      SpinField<Real, Space::memory_space> const&) const;
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, double)
CAYSPIN_FOR_EACH_SPACE(CAYSPIN_INSTANTIATE, float)
#undef CAYSPIN_INSTANTIATE

}  // namespace cayspin::simulation
