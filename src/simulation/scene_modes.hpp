// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "found_modes.hpp"
#include "plan.hpp"
#include "scene_field.hpp"

#include <cayspin/minimizer/minimum.hpp>

#include <array>
#include <vector>

namespace cayspin::simulation {

/// Returns the scene without [torque], for functions that need an energy.
io::Scene without_torque(io::Scene scene);

/// Throws io::SceneError for spins that have neither precession nor damping.
void require_motion(io::Scene const& scene);

/// Plans a search for modes that follows a search for the equilibrium. Throws like
/// make_plan_to_relax, except that torques are accepted, for up to most_sites_with_torques sites.
/// Throws io::SceneError also for spins that have neither precession nor damping.
Plan make_plan_of_modes(io::Scene const& scene, Precision precision, ModesOptions const& options,
                        bool with_hessian);

/// Finds a state of rest of a scene with torques, starting at `spins`, and stores it in `spins`. If
/// `at_rest` is true, only checks the start. Sets only the torque, the evaluations and the end of
/// the result.
template <class Real, class Space>
Minimum find_rest_with_torques(Space const& exec, io::Scene const& scene,
                               SpinField<Real, typename Space::memory_space> const& spins,
                               ModesOptions const& options, double torque, bool at_rest);

/// Finds the normal modes of a scene at an equilibrium. `field`: made for FieldFor::energy; not
/// used for scenes with torques.
template <class Real, class Space>
FoundModes find_modes(Space const& exec, io::Scene const& scene,
                      SceneField<SpinField<Real, typename Space::memory_space>> const& field,
                      SpinField<Real, typename Space::memory_space> const& spins,
                      ModesOptions const& options);

template <class Real, class Space>
FoundCurvatures find_curvatures(
    Space const& exec, io::Scene const& scene,
    SceneField<SpinField<Real, typename Space::memory_space>> const& field,
    SpinField<Real, typename Space::memory_space> const& spins, ModesOptions const& options);

/// Adds to `value_errors` the error that is due to the torque left at the spins, and counts the one
/// evaluation of the field that this takes.
template <class Real, class Space>
void add_errors_of_torque(Space const& exec, io::Scene const& scene,
                          SceneField<SpinField<Real, typename Space::memory_space>> const& field,
                          SpinField<Real, typename Space::memory_space> const& spins, double time,
                          FoundCurvatures& curvatures);

/// Limit for --wave-vector: for larger cells, the eigenvalues take minutes.
constexpr std::int64_t most_sites_of_a_cell = 1024;

/// Throws io::SceneError if a scene has no precession and no damping, no periodic axis, more than
/// most_sites_of_a_cell sites in a cell (which extends over the whole lattice along open axes), or
/// bonds that are too long for its lattice. Throws UsageError for wave vectors with a component
/// along an open axis and, with demag or dipoles, for waves that do not fit the lattice a whole
/// number of times. Wave vectors are in cycles per cell.
void require_bands(io::Scene const& scene, std::vector<std::array<double, 3>> const& wave_vectors);

/// Returns the bytes that find_bands takes in addition to those of a search for an equilibrium.
std::int64_t memory_of_bands(io::Scene const& scene);

/// Finds the spin waves of these wave vectors. Throws UsageError where bloch_modes throws
/// std::invalid_argument.
template <class Real, class Space>
FoundBands find_bands(Space const& exec, io::Scene const& scene,
                      SceneField<SpinField<Real, typename Space::memory_space>> const& field,
                      SpinField<Real, typename Space::memory_space> const& spins,
                      std::vector<std::array<double, 3>> const& wave_vectors, double time,
                      std::function<Next()> const& poll);

}  // namespace cayspin::simulation
