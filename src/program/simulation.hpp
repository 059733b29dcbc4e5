// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_generator.hpp"

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

template <class... Spaces>
using SimulationsOn = std::variant<Simulation<double, Spaces>*..., Simulation<float, Spaces>*...>;

/// Calls visit.template operator()<Space>() for every space compiled in.
template <class... Spaces>
struct SpaceList {
  using AnySimulation = SimulationsOn<Spaces...>;
  template <class Visitor>
  static void for_each(Visitor&& visit) {
    (visit.template operator()<Spaces>(), ...);
  }
};

using EnabledSpaces = SpaceList<Kokkos::DefaultHostExecutionSpace
#if defined(KOKKOS_ENABLE_SERIAL) && \
    (defined(KOKKOS_ENABLE_OPENMP) || defined(KOKKOS_ENABLE_THREADS))
                                ,
                                Kokkos::Serial
#endif
#if defined(KOKKOS_ENABLE_CUDA) || defined(KOKKOS_ENABLE_HIP) || defined(KOKKOS_ENABLE_SYCL)
                                ,
                                Kokkos::DefaultExecutionSpace
#endif
                                >;

using AnySimulation = EnabledSpaces::AnySimulation;

}  // namespace cayspin::program
