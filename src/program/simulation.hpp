// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_generator.hpp"
#include "space.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/spin_field.hpp>

#include <variant>

namespace cayspin::program {

/// What looks on while a simulation advances.
template <class Exec, class Spins>
class Observer {
 public:
  virtual ~Observer() = default;
  virtual bool due(Step const& step) const = 0;
  virtual Next operator()(Exec const& exec, Step const& step, Spins const& spins) = 0;
};

/// Everything that a method needs to run a scene, in one precision and execution space.
template <class Real, class Space>
struct Simulation {
  using Exec = Space;
  using Spins = SpinField<Real, typename Space::memory_space>;
  Exec exec;
  Spins spins;
  SceneGenerator<Spins> generator;
  Times times;
  Observer<Exec, Spins>* observer = nullptr;
};

/// The spaces compiled in, behind a first type that is none.
template <class, class... Spaces>
struct SpaceList {
  using AnySimulation = std::variant<Simulation<double, Spaces>*..., Simulation<float, Spaces>*...>;

  /// Calls visit.template operator()<Space>() for each.
  template <class Visitor>
  static void for_each(Visitor&& visit) {
    (visit.template operator()<Spaces>(), ...);
  }
};

#define CAYSPIN_LISTED(Space, Unused) , Space
using EnabledSpaces = SpaceList<void CAYSPIN_FOR_EACH_SPACE(CAYSPIN_LISTED, )>;
#undef CAYSPIN_LISTED

using AnySimulation = EnabledSpaces::AnySimulation;

}  // namespace cayspin::program
