// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_generator.hpp"
#include "single_terms.hpp"

#include <cayspin/spin_field.hpp>
#include <cayspin/step.hpp>

#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation {

/// Energy of each term of a scene; rigid bodies have only the term "rotation".
template <class Spins>
class TermEnergies {
 public:
  TermEnergies(io::Scene const& scene, Lattice const& lattice);

  /// Returns energies in reduced units, in the order of names().
  template <class Exec>
  std::vector<double> operator()(Exec const& exec, Step const& step, Spins const& spins) const;

  std::vector<std::string> const& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  std::vector<SceneGenerator<Spins>> terms_;
};

/// Magnetization and energy of each region of a lattice.
template <class Spins>
class RegionSums {
  using Real = typename Spins::value_type;
  using Numbers = ScalarField<Real, typename Spins::memory_space>;

 public:
  RegionSums(io::Scene const& scene, Lattice const& lattice);

  /// Returns the magnetizations of all regions, followed by their energies. A region without a spin
  /// has a magnetization of zero. `source`: the generator or field from which the energies are
  /// computed.
  template <class Exec, class Source>
  std::vector<double> operator()(Exec const& exec, Source const& source, Step const& step,
                                 Spins const& spins) const;

 private:
  std::size_t count_;
  Numbers regions_;
  std::optional<Numbers> moments_;  // empty if all are 1
  std::vector<double> weights_;     // of each region: the sum of its moments
};

/// The numbers named by more_scalars(), except the shift, in the units of the scene.
template <class Spins>
class MoreOfSample {
 public:
  MoreOfSample(io::Scene const& scene, Lattice const& lattice) : energy_unit_(scene.units.energy) {
    if (scene.output.regions) regions_.emplace(scene, lattice);
    if (scene.output.terms) terms_.emplace(scene, lattice);
  }

  /// `source`: the generator of the scene, or its field.
  template <class Exec, class Source>
  std::vector<double> operator()(Exec const& exec, Source const& source, Step const& step,
                                 Spins const& spins) const {
    std::vector<double> numbers;
    if (regions_) numbers = (*regions_)(exec, source, step, spins);
    for (std::size_t i = numbers.size() / 4 * 3; i < numbers.size(); ++i)
      numbers[i] *= energy_unit_;
    if (terms_)
      for (double const energy : (*terms_)(exec, step, spins))
        numbers.push_back(energy * energy_unit_);
    return numbers;
  }

 private:
  double energy_unit_;
  std::optional<RegionSums<Spins>> regions_;
  std::optional<TermEnergies<Spins>> terms_;
};

}  // namespace cayspin::simulation
