// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/scalars.hpp>
#include <cayspin/step.hpp>

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2 {

/// Energy, norm defect, magnetization and largest rate of the spins at one step.
struct Sample {
  std::int64_t step = 0;
  double time = 0;
  Energy energy;
  double norm_defect = 0;
  Vec3<double> magnetization{0, 0, 0};
  double largest_rate = 0;  // stays 0 if no generator was given for it
};

namespace detail {

struct NoGenerator {};

/// Functor that computes all values of a Sample in one pass over the spins.
template <class Source, class Generator, class Real>
struct SampleOfSites {
  static constexpr bool with_rate = !std::is_same_v<Generator, NoGenerator>;
  static constexpr int sums = 5, count = with_rate ? 8 : 7;
  Source source;
  Generator generator;
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, spins);
    Vec3<Value> const m = stencil.center();
    energy_at(source, stencil, values);
    values[2] = m.x;
    values[3] = m.y;
    values[4] = m.z;
    off_the_sphere(m, values + sums);
    if constexpr (with_rate) values[7] = squared_torque(generator, stencil);
  }
};

}  // namespace detail

/// Returns a Sample of `spins`, in one pass. `source` gives the energy (an EffectiveField, a field
/// term or a generator); the optional `generator` gives the largest rate. Each of the two costs one
/// evaluation of its field; if that is expensive (HostField), sample less often.
template <class Exec, class Source, class Real, class MemorySpace,
          class Generator = detail::NoGenerator>
Sample sample(Exec const& exec, Source const& source, Step const& step,
              SpinField<Real, MemorySpace> const& spins, Generator const& generator = {}) {
  detail::check_access<Exec, MemorySpace>();
  auto energies = detail::prepare_term(source, exec, spins, step.time);
  auto rates = detail::prepare_term(generator, exec, spins, step.time);
  using Look = detail::SampleOfSites<decltype(energies), decltype(rates), Real>;
  auto const found = detail::reduce_sites<detail::SumsThenMaxima<Look::sums>, Look::count>(
      exec, "cayspin::sample", spins.layout(),
      Look{std::move(energies), std::move(rates), spins.array()});
  auto const sites = static_cast<double>(whole(spins.lattice()).sites());
  Sample sample{step.number, step.time, {found[0], found[1]}};
  sample.magnetization = {found[2] / sites, found[3] / sites, found[4] / sites};
  sample.norm_defect = detail::norm_defect_of(found[5], found[6]);
  if constexpr (Look::with_rate) sample.largest_rate = std::sqrt(found[7]);
  return sample;
}

/// An observer that stores a Sample for each call; wrap it in Every to call it less often. `source`
/// gives the energy, as for sample().
template <class Source>
class Record {
 public:
  Record(Source source, std::vector<Sample>& samples)
      : source_(std::move(source)), samples_(samples) {}

  template <class Exec, class Spins>
  void operator()(Exec const& exec, Step const& step, Spins const& spins) {
    samples_.push_back(sample(exec, source_, step, spins));
  }

 private:
  Source source_;
  std::vector<Sample>& samples_;
};

}  // namespace cayspin::inline v0_2
