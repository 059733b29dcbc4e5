// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_field_now.hpp"

#include <cayspin/spin_field.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace cayspin::inline v0_1::io {
struct Scene;
}

namespace cayspin::simulation {

/// What a field is evaluated for: to turn spins, with the damping of each site in it, as
/// H + damping m x H or its second part alone; for itself; or as -dE/dm, for an energy that falls.
enum class FieldFor { generator, itself, energy };

/// The field of a scene whose terms are those of few scenes: couplings, sublattices, currents,
/// vacancies. One pass evaluates all terms into memory before each stage, or on a host along each
/// row as a Runge-Kutta stage comes to it, and the kernels of the methods load what it wrote; so
/// there is one such kernel, and not one for each method.
/// Compiled in field_in_pass.cpp, for the spaces of space.hpp. A handle.
template <class Spins>
class FieldInPass {
  using Real = typename Spins::value_type;
  using Memory = typename Spins::memory_space;

 public:
  FieldInPass(io::Scene const& scene, Lattice const& lattice);

  /// `usual`: the scene's other terms.
  template <class Exec>
  SceneFieldNow<Real> evaluate(Exec const& exec, SceneFieldNow<Real> const& usual,
                               Spins const& spins, double t, FieldFor purpose) const;

  /// The same without energies for a host loop over rows, which then evaluates H as it goes.
  template <class Exec>
  SceneFieldNow<Real> along_rows(Exec const& exec, SceneFieldNow<Real> const& usual,
                                 Spins const& spins, double t, FieldFor purpose) const;

  /// Is H affine in the spins?
  bool is_affine() const;

  /// Without any term.
  SceneFieldNow<Real> nothing() const;

  /// The mean of m weighted by moments, over the sites that have a spin.
  template <class Exec>
  Vec3<double> magnetization(Exec const& exec, Spins const& spins) const;

  /// max | |m| - 1 | over these sites.
  template <class Exec>
  double norm_defect(Exec const& exec, Spins const& spins) const;

  /// Of each site of a cell: its gyromagnetic ratio over its moment.
  std::vector<double> const& noise_of_sites() const;
  /// 0 where a spin is frozen; none where all move.
  std::optional<ScalarField<Real, Memory>> const& moves() const;

 private:
  class Terms;
  std::shared_ptr<Terms const> terms_;
};

}  // namespace cayspin::simulation
