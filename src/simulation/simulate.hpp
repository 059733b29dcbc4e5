// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"
#include "io/scene.hpp"
#include "kokkos_settings.hpp"
#include "precision.hpp"
#include "scene_generator.hpp"
#include "space.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/spin_field.hpp>

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace cayspin::simulation {

class OpenMethod;

/// Called while a simulation advances.
template <class Exec, class Spins>
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual bool due(Step const& step) const = 0;
  virtual Next operator()(Exec const& exec, Step const& step, Spins const& spins) = 0;
};

/// Result of a simulation.
struct Ending {
  Summary summary = {};
  std::optional<std::string> failure = {};  // why its numbers failed, if they did
};

/// A scene in memory, in one precision and execution space, with everything that a method needs.
template <class Real, class Space>
struct Simulation {
  using Exec = Space;
  using Spins = SpinField<Real, typename Space::memory_space>;

  Exec exec;
  Spins spins;
  SceneGenerator<Spins> generator;
  Times times;
  io::Units units;  // for messages
  RunObserver<Exec, Spins>* observer = nullptr;

  /// `start`: unit vectors, sites x 3.
  Simulation(Lattice const& lattice, Times const& times_of_run, std::vector<double> const& start,
             SceneGenerator<Spins> generator_of_scene)
      : spins("spins", lattice), generator(std::move(generator_of_scene)), times(times_of_run) {
    copy_from_host(start, spins);
  }
  Simulation(io::Scene const& scene, Lattice const& lattice, Times const& times_of_run,
             std::vector<double> const& start)
      : Simulation(lattice, times_of_run, start, SceneGenerator<Spins>(scene, lattice)) {
    units = scene.units;
  }

  /// Runs to the end of the times, or until a failure or a stop by `observed_by`.
  Ending advance(OpenMethod& method, RunObserver<Exec, Spins>& observed_by);
};

/// Lists the spaces compiled in. The first parameter is ignored, so that a macro can write the
/// others with commas before them.
template <class, class... Spaces>
struct SpaceList {
  using AnySimulation = std::variant<Simulation<double, Spaces>*..., Simulation<float, Spaces>*...>;

  /// Calls visit.template operator()<Space>() for each space.
  template <class Visitor>
  static void for_each(Visitor&& visit) {
    (visit.template operator()<Spaces>(), ...);
  }
};

#define CAYSPIN_LISTED(Space, Unused) , Space
using EnabledSpaces = SpaceList<void CAYSPIN_FOR_EACH_SPACE(CAYSPIN_LISTED, )>;
#undef CAYSPIN_LISTED

using AnySimulation = EnabledSpaces::AnySimulation;

/// Calls work.template operator()<Real, Space>() for the precision and the space of that name.
template <class Work>
auto in_space(std::string const& space, Precision precision, Work const& work) {
  std::optional<decltype(work.template operator()<double, Kokkos::DefaultExecutionSpace>())> result;
  EnabledSpaces::for_each([&]<class Space>() {
    if (!has_name<Space>(space)) return;
    if (precision == Precision::double_precision)
      result.emplace(work.template operator()<double, Space>());
    else
      result.emplace(work.template operator()<float, Space>());
  });
  return std::move(*result);
}

}  // namespace cayspin::simulation
